#include "drivers/spnav_server/spnav_session.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <string>
#include <vector>

namespace limn::test {
namespace {

using spnav::Message;

constexpr std::int32_t kHello = spnav::kTag | spnav::kChangeVersion;

template <class T>
std::span<const std::uint8_t> bytes_of(const T& value) {
  return {reinterpret_cast<const std::uint8_t*>(&value), sizeof value};
}

bool write(SpnavSession& session, const Message& message, const SpnavDevice* device = nullptr) {
  return session.receive(bytes_of(message), device);
}

SpnavMotion motion_of(std::int32_t x, std::uint32_t period = 8) { return {{x}, period}; }

/// All that waits, words that are 0 at the end left out.
std::vector<std::vector<std::int32_t>> taken(SpnavSession& session) {
  std::vector<std::vector<std::int32_t>> all;
  while (!session.output().empty()) {
    const auto bytes = session.output();
    std::vector<std::int32_t> words(bytes.size() / sizeof(std::int32_t));
    std::memcpy(words.data(), bytes.data(), bytes.size());
    while (words.size() > 1 && words.back() == 0) words.pop_back();
    all.push_back(words);
    session.sent(bytes.size());
  }
  return all;
}

/// A session that speaks version 1, its greeting taken.
SpnavSession greeted() {
  SpnavSession session;
  EXPECT_TRUE(session.receive(bytes_of(kHello | 1), nullptr));
  EXPECT_THAT(taken(session), testing::ElementsAre(testing::ElementsAre(kHello | 1)));
  session.start();
  return session;
}

using testing::ElementsAre;

TEST(SpnavSession, TellsAClientOfTheFirstVersion) {
  SpnavSession session;
  EXPECT_FALSE(session.has_spoken());
  session.start();
  session.motion({{1, 2, 3, 4, 5, 6}, 8});
  session.button(3, true);
  session.button(3, false);
  EXPECT_THAT(taken(session), ElementsAre(ElementsAre(0, 1, 2, 3, 4, 5, 6, 8), ElementsAre(1, 3),
                                          ElementsAre(2, 3)));
}

TEST(SpnavSession, AgreesOnTheHighestVersionItKnows) {
  SpnavSession session;
  EXPECT_TRUE(session.receive(bytes_of(kHello | 9), nullptr));
  EXPECT_TRUE(session.has_spoken());
  EXPECT_THAT(taken(session), ElementsAre(ElementsAre(kHello | 1)));
  SpnavSession first;
  EXPECT_TRUE(first.receive(bytes_of(kHello), nullptr));
  EXPECT_THAT(taken(first), ElementsAre(ElementsAre(kHello)));
}

TEST(SpnavSession, HoldsEventsBackUntilItStarts) {
  SpnavSession session;
  session.motion(motion_of(1));
  session.motion(motion_of(2));
  session.button(0, true);
  EXPECT_TRUE(session.receive(bytes_of(kHello | 1), nullptr));
  EXPECT_THAT(taken(session), ElementsAre(ElementsAre(kHello | 1)));
  session.start();
  EXPECT_THAT(taken(session), ElementsAre(ElementsAre(1), ElementsAre(0, 2, 0, 0, 0, 0, 0, 16)));
}

TEST(SpnavSession, TakesRequestsInAnyPieces) {
  SpnavSession session = greeted();
  const Message request{spnav::kTag | spnav::kDeviceAxes};
  const SpnavDevice device;
  for (const std::uint8_t byte : bytes_of(request)) {
    EXPECT_TRUE(session.output().empty());
    EXPECT_TRUE(session.receive({&byte, 1}, &device));
  }
  EXPECT_THAT(taken(session), ElementsAre(ElementsAre(spnav::kTag | spnav::kDeviceAxes, 6)));
}

TEST(SpnavSession, AnswersForTheDevice) {
  SpnavSession session = greeted();
  const SpnavDevice device{5, "SpaceNavigator with a name of 33", "/dev/hidraw0", 0x046D, 0xC626,
                           2};
  for (const auto request : {spnav::kDeviceUsbId, spnav::kDeviceButtons, spnav::kDeviceType,
                             spnav::kDeviceName, spnav::kDevicePath}) {
    EXPECT_TRUE(write(session, {spnav::kTag | request}, &device));
  }
  const auto answers = taken(session);
  ASSERT_EQ(answers.size(), 6U);
  EXPECT_THAT(answers[0], ElementsAre(spnav::kTag | spnav::kDeviceUsbId, 0x046D, 0xC626));
  EXPECT_THAT(answers[1], ElementsAre(spnav::kTag | spnav::kDeviceButtons, 2));
  EXPECT_THAT(answers[2], ElementsAre(spnav::kTag | spnav::kDeviceType, 0x206));
  EXPECT_EQ(answers[3].at(7), 32) << "bytes left";
  EXPECT_EQ(std::memcmp(&answers[3][1], "SpaceNavigator with a na", 24), 0);
  EXPECT_EQ(answers[4].at(7), 8 | 0x10000) << "a later piece";
  EXPECT_EQ(std::memcmp(&answers[4][1], "me of 33", 8), 0);
  EXPECT_EQ(answers[5].at(7), 12);
}

TEST(SpnavSession, RefusesWhatItCannotAnswer) {
  SpnavSession session = greeted();
  constexpr std::int32_t kSetLed = 0x3012;
  for (const std::int32_t request :
       {std::int32_t{spnav::kDeviceName}, std::int32_t{spnav::kDeviceUsbId},
        std::int32_t{spnav::kDeviceAxes}, kSetLed, std::int32_t{spnav::kChangeVersion}}) {
    EXPECT_TRUE(write(session, {spnav::kTag | request, 1}));
    const auto answers = taken(session);
    ASSERT_EQ(answers.size(), 1U) << request;
    EXPECT_EQ(answers[0].at(0), spnav::kTag | request);
    EXPECT_EQ(answers[0].at(7), -1) << request;
  }
}

TEST(SpnavSession, EndsWithAClientThatSendsNoRequests) {
  SpnavSession session = greeted();
  EXPECT_FALSE(write(session, {0, 1, 2, 3}));
}

TEST(SpnavSession, LeavesNamesUnanswered) {
  SpnavSession session = greeted();
  EXPECT_TRUE(write(session, {spnav::kTag | spnav::kSetName, 0x41, 0, 0, 0, 0, 0, 1}));
  EXPECT_TRUE(write(session, {spnav::kSetName, 0x41, 0, 0, 0, 0, 0, 1})) << "as libspnav 1.0 does";
  EXPECT_TRUE(session.output().empty());
}

TEST(SpnavSession, ScalesByTheClientsSensitivity) {
  SpnavSession session = greeted();
  const auto set = [&session](float value) {
    EXPECT_TRUE(
        write(session, {spnav::kTag | spnav::kSetSensitivity, std::bit_cast<std::int32_t>(value)}));
    return taken(session).at(0);
  };
  EXPECT_EQ(set(0.5F).size(), 2U);
  session.motion(motion_of(-101));
  EXPECT_THAT(taken(session), ElementsAre(ElementsAre(0, -50, 0, 0, 0, 0, 0, 8)));
  // 1.0 and 0.1 as libspnav 1.0 sends them: the lower halves of these doubles.
  EXPECT_EQ(set(0.0F).at(7), -1);
  EXPECT_EQ(set(std::bit_cast<float>(0x9999999AU)).at(7), -1);
  EXPECT_EQ(set(std::numeric_limits<float>::quiet_NaN()).at(7), -1);
  EXPECT_TRUE(write(session, {spnav::kTag | spnav::kGetSensitivity}));
  EXPECT_EQ(taken(session).at(0).at(1), std::bit_cast<std::int32_t>(0.5F));

  SpnavSession first;
  first.start();
  EXPECT_TRUE(first.receive(bytes_of(2.0F), nullptr));
  first.motion(motion_of(100));
  EXPECT_THAT(taken(first), ElementsAre(ElementsAre(0, 200, 0, 0, 0, 0, 0, 8)));
}

TEST(SpnavSession, TellsWhatTheMaskHas) {
  SpnavSession session = greeted();
  const SpnavDevice device{2, "SpaceMouse", "", 0x256F, 0xC635, 2};
  session.device(device, true);
  EXPECT_THAT(taken(session), ElementsAre(ElementsAre(3, 0, 2, 0x20F, 0x256F, 0xC635)));
  EXPECT_TRUE(write(session, {spnav::kTag | spnav::kSetEventMask, spnav::kButtons}));
  EXPECT_TRUE(write(session, {spnav::kTag | spnav::kGetEventMask}));
  EXPECT_EQ(taken(session).at(1).at(1), spnav::kButtons);
  session.device(device, false);
  session.motion(motion_of(1));
  session.button(1, true);
  EXPECT_THAT(taken(session), ElementsAre(ElementsAre(1, 1)));
}

TEST(SpnavSession, TellsTheEndOfAMotionThoughTheMaskHasNoneAnyMore) {
  SpnavSession session = greeted();
  session.motion(motion_of(7));
  EXPECT_EQ(taken(session).size(), 1U);
  EXPECT_TRUE(write(session, {spnav::kTag | spnav::kSetEventMask, spnav::kButtons}));
  EXPECT_EQ(taken(session).size(), 1U);
  session.motion(motion_of(8));
  session.motion(motion_of(0));
  session.motion(motion_of(0));
  EXPECT_THAT(taken(session), ElementsAre(ElementsAre(0, 0, 0, 0, 0, 0, 0, 8)));
}

TEST(SpnavSession, TellsReleasesThoughTheMaskHasNoButtonsAnyMore) {
  SpnavSession session = greeted();
  session.button(3, true);
  EXPECT_THAT(taken(session), ElementsAre(ElementsAre(1, 3)));
  EXPECT_TRUE(write(session, {spnav::kTag | spnav::kSetEventMask, spnav::kMotions}));
  EXPECT_EQ(taken(session).size(), 1U);
  session.button(4, true);
  session.button(3, false);
  EXPECT_THAT(taken(session), ElementsAre(ElementsAre(2, 3)));
  session.button(4, false);
  EXPECT_TRUE(session.output().empty()) << "what was not pressed is not released";
}

TEST(SpnavSession, TellsNoReleaseOfWhatWasPressedBeforeTheMaskHadButtons) {
  SpnavSession session = greeted();
  EXPECT_TRUE(write(session, {spnav::kTag | spnav::kSetEventMask, spnav::kMotions}));
  EXPECT_EQ(taken(session).size(), 1U);
  session.button(3, true);
  session.button(3, false);
  EXPECT_TRUE(write(session, {spnav::kTag | spnav::kSetEventMask, spnav::kButtons}));
  EXPECT_EQ(taken(session).size(), 1U);
  session.button(5, true);
  EXPECT_THAT(taken(session), ElementsAre(ElementsAre(1, 5)));
}

TEST(SpnavSession, GivesASlowClientTheNewestMotion) {
  SpnavSession session = greeted();
  for (int i = 1; i <= 1000; ++i) session.motion(motion_of(i));
  session.button(0, true);
  for (int i = 1001; i <= 2000; ++i) session.motion(motion_of(i));
  session.button(0, false);
  session.motion(motion_of(0));
  EXPECT_THAT(taken(session), ElementsAre(ElementsAre(0, 1000, 0, 0, 0, 0, 0, 8000),  //
                                          ElementsAre(1),                             //
                                          ElementsAre(0, 2000, 0, 0, 0, 0, 0, 8000),  //
                                          ElementsAre(2), ElementsAre(0, 0, 0, 0, 0, 0, 0, 8)));
}

TEST(SpnavSession, LeavesABegunMessageAsItIs) {
  SpnavSession session = greeted();
  session.motion(motion_of(1));
  session.sent(5);
  session.motion(motion_of(2));
  session.motion(motion_of(3));
  EXPECT_TRUE(write(session, {spnav::kTag | spnav::kGetEventMask}));
  std::vector<std::uint8_t> all;
  while (!session.output().empty()) {
    all.push_back(session.output()[0]);
    session.sent(1);
  }
  ASSERT_EQ(all.size(), 27U + 32U + 32U);
  Message last{};
  std::memcpy(last.data(), &all[27 + 32], sizeof last);
  EXPECT_EQ(last, (Message{0, 3, 0, 0, 0, 0, 0, 16}));
}

TEST(SpnavSession, KeepsHowButtonsStandWhenTheyAreTooMany) {
  SpnavSession session = greeted();
  session.button(9, true);
  for (int i = 0; i < 1000; ++i) {
    session.button(0, i % 2 == 0);
    session.motion(motion_of(i + 1));
  }
  session.button(9, false);
  session.button(4, true);
  session.motion(motion_of(0));
  bool pressed[10] = {};
  std::int32_t x = -1;
  std::size_t count = 0;
  for (const auto& words : taken(session)) {
    ++count;
    if (words[0] == spnav::kMotion) x = words.size() > 1 ? words[1] : 0;
    const std::int32_t number = words.size() > 1 ? words[1] : 0;
    if (words[0] == spnav::kPress) pressed[number] = true;
    if (words[0] == spnav::kRelease) pressed[number] = false;
  }
  EXPECT_LE(count, SpnavSession::kMostEvents + 4);
  EXPECT_FALSE(pressed[0]);
  EXPECT_FALSE(pressed[9]);
  EXPECT_TRUE(pressed[4]);
  EXPECT_EQ(x, 0);
}

TEST(SpnavSession, TakesNoMoreRequestsThanItMayAnswer) {
  SpnavSession session = greeted();
  std::size_t requests = 0;
  while (session.takes_requests() && requests < 1000) {
    EXPECT_TRUE(write(session, {spnav::kTag | spnav::kGetEventMask}));
    ++requests;
  }
  EXPECT_EQ(requests, SpnavSession::kMostAnswers);
  EXPECT_EQ(taken(session).size(), requests);
  EXPECT_TRUE(session.takes_requests());
}

}  // namespace
}  // namespace limn::test
