// What tablets must be asked before they report as their rows say, and what they answer.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "drivers/devices/pen_initialization.hpp"
#include "tests/support/recordings.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/usb_capture.hpp"
#include "tests/unit/drivers/devices_support.hpp"

namespace limn {
namespace {

using test::ReportBytes;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::uint16_t kHuion = 0x256C;
constexpr std::uint16_t kUgee = 0x28BD;

/// String descriptors of a tablet, by index; the others stall.
using Strings = std::map<int, ReportBytes>;

ReportBytes text_descriptor(const std::string& text) {
  ReportBytes bytes = {static_cast<std::uint8_t>(2 + 2 * text.size()), 3};
  for (const char c : text) {
    bytes.push_back(static_cast<std::uint8_t>(c));
    bytes.push_back(0);
  }
  return bytes;
}

struct Initialised {
  std::vector<int> strings;  ///< read, in order
  std::vector<const PenInitStep*> steps;
  PenInitializer initializer;
};

Initialised initialise(std::uint16_t vendor, std::uint16_t product, const Strings& strings) {
  const PenInitialization* sequence = find_pen_initialization(vendor, product);
  EXPECT_NE(sequence, nullptr);
  Initialised out{{}, {}, PenInitializer(*sequence)};
  while (const PenInitStep* step = out.initializer.next()) {
    EXPECT_EQ(out.initializer.next(), step) << "until it is done";
    out.steps.push_back(step);
    if (step->action != PenInitAction::kReadString) {
      out.initializer.done();
      continue;
    }
    out.strings.push_back(step->string_index);
    const auto found = strings.find(step->string_index);
    out.initializer.done(found == strings.end() ? ReportBytes{} : found->second);
  }
  return out;
}

// Recorded: probe of Huion New 1060 Plus.
const ReportBytes kV1Answer = {0x0E, 0x03, 0x40, 0x9C, 0xA8, 0x61, 0x03,
                               0x00, 0xFF, 0x1F, 0xA0, 0x0F, 0x08, 0x00};
const ReportBytes kV2Answer = {0x12, 0x03, 0x70, 0xC6, 0x00, 0x06, 0x7C, 0x00, 0xFF,
                               0x1F, 0xD8, 0x13, 0x03, 0x0C, 0x10, 0x00, 0x01, 0x00};

TEST(PenParametersV1, ReadsRangesAndResolution) {
  const auto parameters = pen_parameters_v1(kV1Answer);
  ASSERT_TRUE(parameters);
  EXPECT_EQ(parameters->family, PenFamily::kUcLogicV1);
  EXPECT_EQ(parameters->x_max, 40000);
  EXPECT_EQ(parameters->y_max, 25000);
  EXPECT_EQ(parameters->pressure_max, 8191);
  EXPECT_DOUBLE_EQ(parameters->counts_per_mm, 4000 / 25.4);
}

TEST(PenParametersV2, Has24BitsForARange) {
  ReportBytes answer = kV2Answer;
  answer[4] = 1;
  const auto parameters = pen_parameters_v2(answer);
  ASSERT_TRUE(parameters);
  EXPECT_EQ(parameters->family, PenFamily::kUcLogicV2);
  EXPECT_EQ(parameters->x_max, 50800 + 65536);
  EXPECT_EQ(parameters->y_max, 31750);
  EXPECT_EQ(parameters->pressure_max, 8191);
  EXPECT_DOUBLE_EQ(parameters->counts_per_mm, 200);
}

TEST(PenParameters, TextIsNone) {
  for (const char* text : {"Tablet", "V1.0 and more", "HUION Animation Technology"}) {
    const auto v1 = pen_parameters_v1(text_descriptor(text));
    const auto v2 = pen_parameters_v2(text_descriptor(text));
    ASSERT_FALSE(v1);
    ASSERT_FALSE(v2);
    EXPECT_EQ(v1.error().code, ErrorCode::kSyntax);
    EXPECT_EQ(v2.error().code, ErrorCode::kSyntax);
  }
  EXPECT_THAT(pen_parameters_v2(text_descriptor("HUION Animation")).error().what,
              HasSubstr("a text"));
}

TEST(PenParameters, DamageIsAnError) {
  EXPECT_FALSE(pen_parameters_v1({}));
  EXPECT_FALSE(pen_parameters_v2({}));
  ReportBytes wrong_type = kV1Answer;
  wrong_type[1] = 2;
  EXPECT_EQ(pen_parameters_v1(wrong_type).error().code, ErrorCode::kSyntax);
  for (std::size_t size = 0; size < 12; ++size) {
    EXPECT_FALSE(pen_parameters_v1(std::span(kV1Answer).first(size)));
  }
  EXPECT_TRUE(pen_parameters_v1(std::span(kV1Answer).first(12))) << "the rest is not needed";
  EXPECT_FALSE(pen_parameters_v2(std::span(kV2Answer).first(17)));
  ReportBytes declared_short = kV2Answer;
  declared_short[0] = 12;
  EXPECT_FALSE(pen_parameters_v2(declared_short));
  for (const std::size_t at : {2U, 4U, 8U, 10U}) {  // x, y, pressure, resolution
    ReportBytes zero = kV1Answer;
    zero[at] = zero[at + 1] = 0;
    EXPECT_EQ(pen_parameters_v1(zero).error().code, ErrorCode::kOutOfRange) << at;
  }
  ReportBytes tiny = kV1Answer;
  tiny[10] = tiny[11] = 0xFF;  // 65535 lines an inch
  EXPECT_EQ(pen_parameters_v1(tiny).error().code, ErrorCode::kOutOfRange);
  ReportBytes huge = kV2Answer;
  huge[4] = 0xFF;
  EXPECT_EQ(pen_parameters_v2(huge).error().code, ErrorCode::kOutOfRange);
}

TEST(TextOfStringDescriptor, IsAscii) {
  EXPECT_EQ(text_of_string_descriptor(text_descriptor("HK On")), "HK On");
  EXPECT_EQ(text_of_string_descriptor(ReportBytes{6, 3, 0x41, 0, 0x42, 0x26}), "A?");
  EXPECT_EQ(text_of_string_descriptor(ReportBytes{6, 2, 0x41, 0, 0x42, 0}), "");
  EXPECT_EQ(text_of_string_descriptor(ReportBytes{5, 3, 0x41, 0, 0x42}), "A");
}

TEST(PenInitializer, HuionsV2IsTakenWhereTheTabletHasIt) {
  const auto done =
      initialise(kHuion, 0x006E,
                 {{100, kV1Answer}, {200, kV2Answer}, {201, text_descriptor("HUION_T174_170519")}});
  EXPECT_THAT(done.strings, ElementsAre(201, 200));
  EXPECT_EQ(done.initializer.firmware(), "HUION_T174_170519");
  ASSERT_NE(done.initializer.parameters(), nullptr);
  EXPECT_EQ(done.initializer.parameters()->family, PenFamily::kUcLogicV2);
}

TEST(PenInitializer, HuionsV1IsTakenElse) {
  const auto done = initialise(kHuion, 0x006E, {{100, kV1Answer}, {123, text_descriptor("HK On")}});
  EXPECT_THAT(done.strings, ElementsAre(201, 200, 100, 123));
  ASSERT_NE(done.initializer.parameters(), nullptr);
  EXPECT_EQ(done.initializer.parameters()->family, PenFamily::kUcLogicV1);
  EXPECT_TRUE(done.initializer.parameters()->frame_buttons);
  const auto text_only = initialise(
      kHuion, 0x0999,
      {{100, kV1Answer}, {200, text_descriptor("PenTablet")}, {123, text_descriptor("HK Off")}});
  EXPECT_THAT(text_only.strings, ElementsAre(201, 200, 100, 123));
  EXPECT_FALSE(text_only.initializer.parameters()->frame_buttons);
}

TEST(PenInitializer, TheTransitionalFirmwareIsNotAskedForV2) {
  const auto done =
      initialise(kHuion, 0x006E,
                 {{100, kV1Answer}, {200, kV2Answer}, {201, text_descriptor("HUION_T153_160607")}});
  EXPECT_THAT(done.strings, ElementsAre(201, 100, 123));
  EXPECT_EQ(done.initializer.parameters()->family, PenFamily::kUcLogicV1);
}

TEST(PenInitializer, ATabletThatAnswersNothingHasNoParameters) {
  const auto done = initialise(kHuion, 0x006E, {});
  EXPECT_THAT(done.strings, ElementsAre(201, 200, 100));
  EXPECT_EQ(done.initializer.parameters(), nullptr);
  EXPECT_EQ(done.initializer.firmware(), "");
}

TEST(PenInitializer, UgeeIsWrittenToFirst) {
  const auto done = initialise(kUgee, 0x0907, {{100, kV1Answer}});
  ASSERT_EQ(done.steps.size(), 2U);
  EXPECT_EQ(done.steps[0]->action, PenInitAction::kWriteInterrupt);
  EXPECT_EQ(done.steps[0]->endpoint, 3);
  EXPECT_THAT(done.steps[0]->bytes, ElementsAre(0x02, 0xB0, 0x04, 0, 0, 0, 0, 0, 0, 0));
  EXPECT_EQ(done.initializer.parameters()->family, PenFamily::kUgee);
  EXPECT_EQ(find_pen_initialization(kUgee, 0x0907)->interface_number, 2);
}

TEST(PenInitialization, StringsThatHarmAreNotRead) {
  // String 200 of a Deco 01 V2 turned it into product 1227 (index.md of its recordings).
  for (const PenInitialization& sequence : pen_initializations()) {
    if (sequence.vendor != kUgee) continue;
    for (const PenInitStep& step : sequence.steps) EXPECT_NE(step.string_index, 200);
  }
}

TEST(PenInitialization, UnknownDevicesAreLeftAlone) {
  EXPECT_EQ(find_pen_initialization(kUgee, 0x1227), nullptr);
  EXPECT_EQ(find_pen_initialization(0x0458, 0x0087), nullptr) << "a mouse of KYE";
  EXPECT_EQ(find_pen_initialization(test::kWacom, 0x0314), nullptr);
  EXPECT_EQ(find_pen_initialization(0, 0), nullptr);
}

TEST(PenInitialization, EveryVendorRowThatNeedsOneHasOne) {
  const std::set<PenFamily> needed = {PenFamily::kUcLogicV2, PenFamily::kUgee, PenFamily::kUgeeGen2,
                                      PenFamily::kVeikk, PenFamily::kKye};
  for (const PenSpec& spec : pen_specs()) {
    if (needed.count(spec.family) == 0) continue;
    EXPECT_NE(find_pen_initialization(spec.vendor, spec.product), nullptr) << spec.name;
  }
  for (const PenInitialization& sequence : pen_initializations()) {
    EXPECT_FALSE(sequence.evidence.empty());
    EXPECT_FALSE(sequence.steps.empty());
  }
}

TEST(PenInitialization, ItsParametersMakeAPenOfAnUnknownProduct) {
  const auto done = initialise(kHuion, 0x0999, {{200, kV2Answer}});
  PenIdentity identity;
  identity.vendor = kHuion;
  identity.product = 0x0999;
  EXPECT_FALSE(PenDecoder::make(identity, {}));
  auto decoder = PenDecoder::make(identity, {}, done.initializer.parameters());
  ASSERT_TRUE(decoder);
  EXPECT_EQ(decoder->range().width_mm, 254);
  const ReportBytes report = {8, 0x80, 0x70, 0xC6, 0x06, 0x7C, 0, 0, 0, 0, 0, 0};
  const auto decoded = decoder->decode(Report{0, {}, report});
  ASSERT_EQ(decoded.samples.size(), 1U);
  EXPECT_EQ(decoded.samples[0].x_mm, 254);
  EXPECT_EQ(decoded.samples[0].y_mm, 158.75);
  EXPECT_TRUE(decoder->due());
}

TEST(PenInitialization, ParametersBeatTheRow) {
  // A Deco 01 V2 of another firmware: 5080 lines an inch.
  const ReportBytes answer = {0x0C, 3, 0x70, 0xC6, 0x06, 0x7C, 8, 0, 0xFF, 0x1F, 0xD8, 0x13};
  const auto done = initialise(kUgee, 0x0905, {{100, answer}});
  PenIdentity identity;
  identity.vendor = kUgee;
  identity.product = 0x0905;
  const auto decoder = PenDecoder::make(identity, {}, done.initializer.parameters());
  ASSERT_TRUE(decoder);
  EXPECT_EQ(decoder->range().x_max, 50800);
  EXPECT_EQ(decoder->range().width_mm, 254);
  EXPECT_TRUE(decoder->spec()->tilt) << "which the answer does not tell";
}

TEST(PenInitialization, SixteenBitsDoNotCutADisplay) {
  // Artist 24 Pro: 105370 counts, of which string 100 has room for the lower 16 bits.
  const ReportBytes answer = {0x0C, 3, 0x9A, 0x9B, 0x86, 0xE7, 20, 0, 0xFF, 0x1F, 0xD8, 0x13};
  const auto done = initialise(kUgee, 0x092D, {{100, answer}});
  PenIdentity identity;
  identity.vendor = kUgee;
  identity.product = 0x092D;
  const auto decoder = PenDecoder::make(identity, {}, done.initializer.parameters());
  ASSERT_TRUE(decoder);
  EXPECT_EQ(decoder->range().x_max, 105370);
}

/// "S 64 0E 03 7D .." lines of a probe: string 0x64.
Strings read_probe(const std::string& tablet) {
  std::istringstream lines(
      test::read_file(test::shared_folder() / "traces/pens-usbhid-dump" / tablet / "probe.txt"));
  Strings strings;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string kind;
    unsigned byte = 0;
    words >> kind >> std::hex;
    if (kind != "S" || !(words >> byte)) continue;
    ReportBytes& bytes = strings[static_cast<int>(byte)];
    bytes.clear();
    while (words >> byte) bytes.push_back(static_cast<std::uint8_t>(byte));
  }
  return strings;
}

TEST(PenInitialization, TabletsThatWereProbedTellTheirParameters) {
  LIMN_NEEDS_RECORDINGS();
  struct Probe {
    const char* tablet;
    std::uint16_t vendor;
    std::uint16_t product;
    PenFamily family;
    int x_max;
    int y_max;
    int pressure_max;
    double width_mm;
    double height_mm;
  };
  using F = PenFamily;
  const Probe probes[] = {
      {"Huion_K26", kHuion, 0x006E, F::kUcLogicV1, 32000, 24000, 2047, 203.2, 152.4},
      {"Huion_New_1060_Plus", kHuion, 0x006E, F::kUcLogicV2, 50800, 31750, 8191, 254, 158.75},
      {"Huion_W58", kHuion, 0x006E, F::kUcLogicV1, 32000, 20000, 2047, 203.2, 127},
      {"UC-Logic_TWHA60_v3", 0x5543, 0x0781, F::kUcLogicV1, 40000, 25000, 2047, 254, 158.75},
      {"Ugee_M708_v2", kUgee, 0x0907, F::kUgee, 50794, 30474, 8191, 253.97, 152.37},
      {"XP-Pen_Deco_01_v2_revb", kUgee, 0x0905, F::kUgee, 25400, 15875, 8191, 254, 158.75},
      {"XP-Pen_Star_06", kUgee, 0x0078, F::kUcLogicV1, 50800, 30480, 8191, 254, 152.4}};
  for (const Probe& probe : probes) {
    SCOPED_TRACE(probe.tablet);
    const auto done = initialise(probe.vendor, probe.product, read_probe(probe.tablet));
    const PenParameters* parameters = done.initializer.parameters();
    ASSERT_NE(parameters, nullptr);
    EXPECT_EQ(parameters->family, probe.family);
    EXPECT_EQ(parameters->x_max, probe.x_max);
    EXPECT_EQ(parameters->y_max, probe.y_max);
    EXPECT_EQ(parameters->pressure_max, probe.pressure_max);
    EXPECT_NEAR(parameters->x_max / parameters->counts_per_mm, probe.width_mm, 1e-9);
    EXPECT_NEAR(parameters->y_max / parameters->counts_per_mm, probe.height_mm, 1e-9);
  }
  // VEIKK answers to every index with the same text.
  const Strings veikk = read_probe("VEIKK_A30");
  EXPECT_FALSE(pen_parameters_v1(veikk.at(100)));
  EXPECT_FALSE(pen_parameters_v2(veikk.at(200)));
  EXPECT_FALSE(pen_parameters_v2(read_probe("XP-Pen_Star_06").at(200)));
  EXPECT_TRUE(initialise(kHuion, 0x006E, read_probe("Huion_New_1060_Plus"))
                  .initializer.parameters()
                  ->frame_buttons);
}

/// A byte string of numbers, low byte first.
class FileBytes {
 public:
  FileBytes& number(std::uint64_t value, int size) {
    for (int i = 0; i < size; ++i, value >>= 8) text_ += static_cast<char>(value & 0xFFU);
    return *this;
  }
  FileBytes& bytes(const std::string& more) {
    text_ += more;
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

const std::string kGetString = {'\x80', 6, 100, 3, 9, 4, 0, 1};

TEST(UsbCapture, TiesUsbmonsAnswersToTheirRequests) {
  const auto packet = [](int request, char type, int transfer, int endpoint, bool setup,
                         const std::string& data) {
    FileBytes out;
    out.number(static_cast<std::uint64_t>(request), 8).bytes({type});
    out.number(static_cast<std::uint64_t>(transfer), 1);
    out.number(static_cast<std::uint64_t>(endpoint), 1).number(5, 1).number(1, 2);
    out.number(setup ? 0 : '-', 1).number(0, 1).number(0, 24);
    out.bytes(setup ? kGetString : std::string(8, '\0')).number(0, 16).bytes(data);
    return out.text();
  };
  FileBytes file;
  file.number(0xA1B2C3D4, 4).number(0, 16).number(220, 4);
  for (const std::string& each :
       {packet(1, 'S', 2, 0x80, true, ""), packet(2, 'S', 2, 0x80, true, ""),
        packet(2, 'C', 2, 0x80, false, "two"), packet(3, 'C', 1, 0x81, false, "report"),
        packet(1, 'C', 2, 0x80, false, "one")}) {
    file.number(0, 8).number(each.size(), 4).number(each.size(), 4).bytes(each);
  }
  const test::TempFolder folder;
  const auto capture = folder.write("usbmon.pcap", file.text());
  const auto controls = test::read_usb_controls(capture);
  ASSERT_EQ(controls.size(), 2U);
  EXPECT_EQ(controls[0].device, 5U);
  EXPECT_EQ(controls[0].setup[2], 100);
  EXPECT_EQ(std::string(controls[0].data.begin(), controls[0].data.end()), "one");
  EXPECT_EQ(std::string(controls[1].data.begin(), controls[1].data.end()), "two");
  const auto reports = test::read_usb_reports(capture, 5);
  ASSERT_EQ(reports.size(), 1U);
  EXPECT_EQ(std::string(reports[0].begin(), reports[0].end()), "report");
  EXPECT_TRUE(test::read_usb_reports(capture, 6).empty());
}

TEST(UsbCapture, TiesUsbPcapsAnswersToTheirRequests) {
  const auto block = [](std::uint32_t type, const std::string& content) {
    FileBytes out;
    out.number(type, 4).number(12 + content.size(), 4).bytes(content);
    out.number(12 + content.size(), 4);
    return out.text();
  };
  const auto packet = [&block](bool from_device, int stage, const std::string& data) {
    FileBytes out;
    out.number(28, 2).number(77, 8).number(0, 6).number(from_device ? 1 : 0, 1).number(1, 2);
    out.number(7, 2).number(0x80, 1).number(2, 1).number(data.size(), 4);
    out.number(static_cast<std::uint64_t>(stage), 1).bytes(data);
    FileBytes enhanced;
    enhanced.number(0, 12).number(out.text().size(), 4).number(out.text().size(), 4);
    return block(6, enhanced.bytes(out.text()).text());
  };
  FileBytes file;
  file.bytes(block(0x0A0D0D0A, std::string(16, '\0')));
  file.bytes(block(1, FileBytes().number(249, 2).number(0, 6).text()));
  file.bytes(packet(false, 0, kGetString)).bytes(packet(true, 1, "answer"));
  const test::TempFolder folder;
  const auto controls = test::read_usb_controls(folder.write("usb.pcapng", file.text()));
  ASSERT_EQ(controls.size(), 1U);
  EXPECT_EQ(controls[0].device, 7U);
  EXPECT_EQ(controls[0].setup[2], 100);
  EXPECT_EQ(std::string(controls[0].data.begin(), controls[0].data.end()), "answer");
}

/// Where `step` reads its string among `controls`, from `from` on; their number where it does not.
std::size_t find_string(const std::vector<test::UsbControl>& controls, const PenInitStep& step,
                        std::size_t from) {
  const auto found = std::find_if(controls.begin() + static_cast<std::ptrdiff_t>(from),
                                  controls.end(), [&step](const test::UsbControl& control) {
                                    return control.setup[1] == 6 && control.setup[3] == 3 &&
                                           control.setup[2] == step.string_index;
                                  });
  return static_cast<std::size_t>(found - controls.begin());
}

TEST(InitCaptures, HuionsDriverReadsTheSameStringsInTheSameOrder) {
  LIMN_NEEDS_RECORDINGS();
  const auto capture = test::shared_folder() / "traces/init-captures/huion_q11k.pcapng";
  const auto controls = test::read_usb_controls(capture);
  const PenInitialization* sequence = find_pen_initialization(kHuion, 0x006E);
  ASSERT_NE(sequence, nullptr);
  PenInitializer initializer(*sequence);
  std::size_t at = 0;
  std::vector<int> read;
  while (const PenInitStep* step = initializer.next()) {
    at = find_string(controls, *step, at);
    ASSERT_LT(at, controls.size()) << "string " << int{step->string_index} << " was not read";
    read.push_back(step->string_index);
    initializer.done(controls[at].data);
  }
  EXPECT_THAT(read, ElementsAre(201, 200));
  EXPECT_EQ(initializer.firmware(), "HUION_T164_170520");
  ASSERT_NE(initializer.parameters(), nullptr);
  EXPECT_EQ(initializer.parameters()->x_max, 55880);
  EXPECT_EQ(initializer.parameters()->y_max, 34925);

  // And what it then reports decodes: all of it within the range that it told.
  PenIdentity identity;
  identity.vendor = kHuion;
  identity.product = 0x006E;
  identity.firmware = initializer.firmware();
  auto decoder = PenDecoder::make(identity, {}, initializer.parameters());
  ASSERT_TRUE(decoder);
  EXPECT_EQ(decoder->spec()->name, "Huion Q11K");
  std::map<ReportClass, std::size_t> kinds;
  std::size_t contacts = 0;
  for (const ReportBytes& report : test::read_usb_reports(capture, controls[at].device)) {
    const auto decoded = decoder->decode(Report{0, {}, report});
    ++kinds[decoded.kind];
    for (const PenSample& sample : decoded.samples) {
      contacts += in_contact(sample.state) ? 1 : 0;
      EXPECT_LE(sample.raw.x, 55880);
      EXPECT_LE(sample.raw.y, 34925);
    }
  }
  EXPECT_EQ(kinds[ReportClass::kPen], 747U);
  EXPECT_EQ(kinds[ReportClass::kPad], 16U);
  EXPECT_EQ(kinds.size(), 2U);
  EXPECT_EQ(contacts, 111U);
}

}  // namespace
}  // namespace limn
