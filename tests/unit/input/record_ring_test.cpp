#include "input/base/record_ring.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <thread>

namespace limn::test {
namespace {

bool push(RecordRing& ring, const std::string& text) {
  const auto room = ring.reserve(text.size());
  if (room.empty()) return false;
  std::memcpy(room.data(), text.data(), text.size());
  ring.commit();
  return true;
}

std::string pop(RecordRing& ring) {
  const auto record = ring.front();
  if (record.empty()) return "(none)";
  std::string text(reinterpret_cast<const char*>(record.data()), record.size());
  ring.pop();
  return text;
}

TEST(RecordRing, GivesRecordsBackInOrder) {
  RecordRing ring(64);
  EXPECT_EQ(ring.capacity(), 64u);
  EXPECT_EQ(pop(ring), "(none)");
  EXPECT_TRUE(push(ring, "first"));
  EXPECT_TRUE(push(ring, "second, longer"));
  EXPECT_EQ(pop(ring), "first");
  EXPECT_EQ(pop(ring), "second, longer");
  EXPECT_EQ(pop(ring), "(none)");
}

TEST(RecordRing, RefusesWhenFullAndTakesAgainAfterwards) {
  RecordRing ring(64);  // four records of 8 + 8 bytes
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(push(ring, "12345678"));
  EXPECT_FALSE(push(ring, "x"));
  EXPECT_EQ(pop(ring), "12345678");
  EXPECT_TRUE(push(ring, "x"));
  EXPECT_FALSE(push(ring, "x"));
}

TEST(RecordRing, RefusesWhatNeverFits) {
  RecordRing ring(64);
  EXPECT_TRUE(ring.reserve(57).empty());
  EXPECT_TRUE(ring.reserve(~std::size_t{0}).empty());
  EXPECT_FALSE(ring.reserve(56).empty());
}

TEST(RecordRing, KeepsARecordInOnePieceAtTheEnd) {
  RecordRing ring(64);
  ASSERT_TRUE(push(ring, std::string(32, 'a')));  // 40 bytes
  EXPECT_EQ(pop(ring), std::string(32, 'a'));
  EXPECT_TRUE(push(ring, std::string(24, 'b'))) << "24 bytes to the end: goes to the beginning";
  EXPECT_FALSE(push(ring, "c")) << "what was skipped is in use until the consumer passes it";
  EXPECT_EQ(pop(ring), std::string(24, 'b'));
  EXPECT_TRUE(push(ring, "c"));
  EXPECT_EQ(pop(ring), "c");
}

TEST(RecordRing, AnotherThreadSeesEveryByte) {
  constexpr int kRecords = 200'000;
  RecordRing ring(4096);
  std::thread producer([&ring] {
    for (int i = 0; i < kRecords;) {
      const auto size = static_cast<std::size_t>(1 + i * 7 % 200);
      const auto room = ring.reserve(size);
      if (room.empty()) {
        std::this_thread::yield();
        continue;
      }
      std::memset(room.data(), i & 0xFF, size);
      ring.commit();
      ++i;
    }
  });
  int wrong = 0;
  for (int i = 0; i < kRecords;) {
    const auto record = ring.front();
    if (record.empty()) {
      std::this_thread::yield();
      continue;
    }
    wrong += record.size() != static_cast<std::size_t>(1 + i * 7 % 200) ? 1 : 0;
    for (const std::byte b : record) wrong += b != static_cast<std::byte>(i & 0xFF) ? 1 : 0;
    ring.pop();
    ++i;
  }
  producer.join();
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace limn::test
