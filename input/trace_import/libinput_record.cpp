#include "input/trace_import/libinput_record.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <array>
#include <istream>
#include <limits>
#include <map>
#include <string_view>
#include <utility>

#include "input/trace/text.hpp"
#include "input/trace_import/guarded_text.hpp"
#include "input/trace_import/trace_import.hpp"

namespace limn {
namespace {

using Item = LibinputRecord::Item;
using Kind = LibinputRecord::Kind;

constexpr std::int64_t kFormatVersion = 1;
constexpr std::uint16_t kEvSyn = 0;  // <linux/input-event-codes.h>
constexpr std::uint16_t kSynReport = 0;
constexpr std::int64_t kAbsMax = 0x3F;

/// A whole number as libinput writes them: decimal, or hexadecimal behind 0x.
std::optional<std::int64_t> number_of(std::string_view word) {
  if (word.starts_with("0x")) return text::parse_integer<std::int64_t>(word.substr(2), 16);
  return text::parse_integer<std::int64_t>(word);
}

template <class T>
bool fits(std::int64_t number) {
  return number >= std::numeric_limits<T>::min() && number <= std::numeric_limits<T>::max();
}

/// Walks through the file as the parser comes along, without a tree of it. What a node means
/// follows from what its parent means and the key it stands under.
class Walker final : public YAML::EventHandler {
 public:
  Walker(LibinputRecord& record, GuardedText& text, bool salvage)
      : record_(record), text_(text), salvage_(salvage) {}

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnAnchor(const YAML::Mark&, const std::string&) override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { scalar(mark, ""); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { scalar(mark, ""); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                const std::string& value) override {
    scalar(mark, value);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    begin(mark, false);
  }
  void OnSequenceEnd() override { end(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    begin(mark, true);
  }
  void OnMapEnd() override { end(); }

  bool has_version() const noexcept { return has_version_; }

 private:
  enum class Role : std::uint8_t {
    kIgnored,
    kFile,
    kVersion,
    kDevices,
    kDevice,
    kEvdev,  // of a device: what the kernel says of it
    kName,
    kIds,
    kAxes,
    kAxis,
    kDescriptor,
    kEvents,
    kEvent,
    kFrame,  // evdev: of an event
    kKernelEvent,
    kHid,  // hid: of an event
    kTime,
    kBytes,
  };
  struct Level {
    Role role = Role::kIgnored;
    bool is_map = false;
    bool at_key = true;
    std::string key;
  };

  /// What a node in hand means.
  Role role_here() const {
    if (levels_.empty()) return Role::kFile;
    const Level& parent = levels_.back();
    if (!parent.is_map) return role_of_element(parent.role);
    return role_of_value(parent.role, parent.key);
  }

  static Role role_of_element(Role parent) {
    switch (parent) {
      case Role::kDevices:
        return Role::kDevice;
      case Role::kEvents:
        return Role::kEvent;
      case Role::kFrame:
        return Role::kKernelEvent;
      default:
        return Role::kIgnored;
    }
  }

  static Role role_of_value(Role parent, std::string_view key) {
    switch (parent) {
      case Role::kFile:
        if (key == "version") return Role::kVersion;
        return key == "devices" ? Role::kDevices : Role::kIgnored;
      case Role::kDevice:
        if (key == "evdev") return Role::kEvdev;
        if (key == "hid") return Role::kDescriptor;
        return key == "events" ? Role::kEvents : Role::kIgnored;
      case Role::kEvdev:
        if (key == "name") return Role::kName;
        if (key == "id") return Role::kIds;
        return key == "absinfo" ? Role::kAxes : Role::kIgnored;
      case Role::kAxes:
        return Role::kAxis;
      case Role::kEvent:
        if (key == "evdev") return Role::kFrame;
        return key == "hid" ? Role::kHid : Role::kIgnored;
      case Role::kHid:
        if (key == "time") return Role::kTime;
        return key.starts_with("hidraw") ? Role::kBytes : Role::kIgnored;
      default:
        return Role::kIgnored;
    }
  }

  static bool holds_numbers(Role role) {
    return role == Role::kIds || role == Role::kAxis || role == Role::kDescriptor ||
           role == Role::kKernelEvent || role == Role::kTime || role == Role::kBytes;
  }

  static bool wants_map(Role role) {
    return role == Role::kFile || role == Role::kDevice || role == Role::kEvdev ||
           role == Role::kAxes || role == Role::kEvent || role == Role::kHid;
  }

  void begin(const YAML::Mark& mark, bool is_map) {
    if (record_.failure) return;
    line_ = static_cast<std::uint32_t>(mark.line + 1);
    // A key that is no word is one that limn does not know.
    const bool is_key = !levels_.empty() && levels_.back().is_map && levels_.back().at_key;
    Role role = is_key ? Role::kIgnored : role_here();
    if (role != Role::kIgnored && wants_map(role) != is_map) {
      damaged("the structure is not that of a libinput recording here");
      role = Role::kIgnored;
    }
    if (holds_numbers(role)) {
      numbers_.clear();
      numbers_good_ = true;
    }
    if (role == Role::kDevice) begin_device();
    if (role == Role::kFrame) begin_frame();
    if (role == Role::kHid) begin_hid();
    levels_.push_back({role, is_map, true, {}});
  }

  void end() {
    if (record_.failure) return;
    const Level level = std::move(levels_.back());
    levels_.pop_back();
    finish_value(level.role);
    if (!levels_.empty() && levels_.back().is_map && levels_.back().at_key) {
      levels_.back().key.clear();  // it was a key
      levels_.back().at_key = false;
    } else {
      value_done();
    }
  }

  void scalar(const YAML::Mark& mark, std::string_view value) {
    if (record_.failure) return;
    line_ = static_cast<std::uint32_t>(mark.line + 1);
    if (levels_.empty()) return;  // a document of one word
    Level& level = levels_.back();
    if (level.is_map && level.at_key) {
      constexpr std::size_t kLongestKey = 64;  // of those that mean something
      level.key = value.substr(0, kLongestKey);
      level.at_key = false;
      return;
    }
    if (!level.is_map && holds_numbers(level.role)) {
      take_number(level.role, value);
      return;
    }
    take_scalar(role_here(), value);
    value_done();
  }

  void value_done() {
    if (!levels_.empty() && levels_.back().is_map) levels_.back().at_key = true;
  }

  void take_number(Role role, std::string_view word) {
    const auto number = number_of(word);
    const std::size_t most = role == Role::kDescriptor ? kMaxDescriptorBytes
                             : role == Role::kBytes    ? kMaxReportBytes
                                                       : 16;
    if (!numbers_good_) return;
    if (!number || numbers_.size() == most) {
      numbers_good_ = false;
      damaged(number ? "more than " + std::to_string(most) + " numbers in a row"
                     : text::quoted(word) + " is no whole number",
              number ? ErrorCode::kLimit : ErrorCode::kSyntax);
      return;
    }
    numbers_.push_back(*number);
  }

  void take_scalar(Role role, std::string_view value) {
    if (role == Role::kVersion) {
      const auto version = number_of(value);
      has_version_ = true;
      if (version == kFormatVersion) return;
      return give_up(Error{ErrorCode::kUnknown, place(),
                           "libinput's format " + text::quoted(value) + " is none that limn knows",
                           "record with a libinput that writes version 1"});
    }
    if (role == Role::kName) {
      if (value.size() > kMaxDeviceTextBytes) {
        return damaged("a device name of " + text::counted(value.size(), "byte"),
                       ErrorCode::kLimit);
      }
      record_.devices.back().name = value;
    }
  }

  /// A whole sequence or map of this role has ended.
  void finish_value(Role role) {
    if (holds_numbers(role) && !numbers_good_) {
      if (role == Role::kKernelEvent) frame_good_ = false;
      if (role == Role::kTime || role == Role::kBytes) hid_good_ = false;
      return;
    }
    switch (role) {
      case Role::kIds:
        return take_ids();
      case Role::kAxis:
        return take_axis();
      case Role::kDescriptor:
        return take_descriptor();
      case Role::kKernelEvent:
        return take_kernel_event();
      case Role::kFrame:
        return finish_frame();
      case Role::kTime:
        hid_time_ = time_of_numbers();
        if (!hid_time_) damaged("time: wants seconds and microseconds");
        return;
      case Role::kBytes:
        return take_report_bytes();
      case Role::kHid:
        return finish_hid();
      default:
        return;
    }
  }

  void begin_device() {
    if (record_.devices.size() == kMaxTraceDevices) {
      return give_up({ErrorCode::kLimit, place(),
                      "more than " + std::to_string(kMaxTraceDevices) + " devices",
                      "record fewer devices"});
    }
    TraceDevice device;
    device.index = static_cast<DeviceIndex>(record_.devices.size());
    record_.devices.push_back(std::move(device));
  }

  void take_ids() {
    TraceDevice& device = record_.devices.back();
    const bool good =
        numbers_.size() == 4 && std::all_of(numbers_.begin(), numbers_.end(), fits<std::uint16_t>);
    if (!good) return damaged("id: wants bus, vendor, product and version");
    device.bus = static_cast<std::uint16_t>(numbers_[0]);
    device.vendor = static_cast<std::uint16_t>(numbers_[1]);
    device.product = static_cast<std::uint16_t>(numbers_[2]);
    device.version = static_cast<std::uint16_t>(numbers_[3]);
  }

  void take_axis() {
    const auto code = number_of(levels_.back().key);
    const bool good = code && *code >= 0 && *code <= kAbsMax && numbers_.size() == 5 &&
                      std::all_of(numbers_.begin(), numbers_.end(), fits<std::int32_t>);
    if (!good)
      return damaged("absinfo: wants minimum, maximum, fuzz, flat and resolution of a code");
    const auto at = [this](std::size_t i) { return static_cast<std::int32_t>(numbers_[i]); };
    const EvdevAxis axis{static_cast<std::uint16_t>(*code), at(0), at(1), at(2), at(3), at(4)};
    auto& axes = record_.devices.back().axes;
    const bool again = std::any_of(axes.begin(), axes.end(),
                                   [&axis](const EvdevAxis& a) { return a.code == axis.code; });
    if (!again) axes.push_back(axis);
  }

  bool numbers_are_bytes() {
    const bool good = std::all_of(numbers_.begin(), numbers_.end(), fits<std::uint8_t>);
    if (!good) damaged("a number beyond 255 among bytes", ErrorCode::kOutOfRange);
    return good;
  }

  void take_descriptor() {
    if (!numbers_are_bytes()) return;
    auto& descriptor = record_.devices.back().report_descriptor;
    descriptor.clear();
    for (const std::int64_t byte : numbers_) descriptor.push_back(static_cast<std::uint8_t>(byte));
  }

  /// Seconds and microseconds, the first two numbers in hand.
  std::optional<Timestamp> time_of_numbers() const {
    constexpr std::int64_t kMostSeconds = std::int64_t{1} << 33;
    if (numbers_.size() < 2 || numbers_[0] < 0 || numbers_[0] > kMostSeconds || numbers_[1] < 0 ||
        numbers_[1] >= 1'000'000) {
      return std::nullopt;
    }
    return Timestamp(numbers_[0] * 1'000'000'000 + numbers_[1] * 1'000);
  }

  void begin_frame() {
    frame_begin_ = record_.events.size();
    frame_good_ = true;
    frame_line_ = line_;
  }

  void take_kernel_event() {
    if (!frame_good_) return;
    const auto time = time_of_numbers();
    const bool good = time && numbers_.size() == 5 && fits<std::uint16_t>(numbers_[2]) &&
                      fits<std::uint16_t>(numbers_[3]) && fits<std::int32_t>(numbers_[4]);
    if (!good) {
      frame_good_ = false;
      return damaged("an event wants seconds, microseconds, type, code and value");
    }
    const EvdevEvent event{*time, static_cast<std::uint16_t>(numbers_[2]),
                           static_cast<std::uint16_t>(numbers_[3]),
                           static_cast<std::int32_t>(numbers_[4])};
    if (event.type == kEvSyn && event.code == kSynReport) return add_frame(event.time);
    if (record_.events.size() - frame_begin_ == kMaxFrameEvents) {
      frame_good_ = false;
      return damaged("a frame of more than " + std::to_string(kMaxFrameEvents) + " events",
                     ErrorCode::kLimit);
    }
    record_.events.push_back(event);
  }

  void add_frame(Timestamp time) {
    add({.kind = Kind::kFrame,
         .line = frame_line_,
         .time = time,
         .begin = frame_begin_,
         .count = record_.events.size() - frame_begin_});
    frame_begin_ = record_.events.size();
    frame_line_ = line_;
  }

  void finish_frame() {
    const bool open = record_.events.size() > frame_begin_;
    record_.events.resize(frame_begin_);
    if (frame_good_ && open)
      damaged("the frame is cut short: no SYN_REPORT ends it", ErrorCode::kSyntax, true);
  }

  void begin_hid() {
    hid_time_.reset();
    hid_good_ = true;
    hid_line_ = line_;
    hid_begin_ = record_.bytes.size();
    hid_sources_.clear();
  }

  void take_report_bytes() {
    if (!hid_good_) return;
    if (!numbers_are_bytes()) {
      hid_good_ = false;
      return;
    }
    const std::size_t begin = record_.bytes.size();
    for (const std::int64_t byte : numbers_)
      record_.bytes.push_back(static_cast<std::uint8_t>(byte));
    if (const auto source = source_of(levels_.back().key)) {
      hid_sources_.push_back({*source, begin, numbers_.size()});
    }
  }

  /// The hidraw node of that name; nothing (and damage) when there are too many.
  std::optional<std::uint32_t> source_of(const std::string& name) {
    auto& names = record_.hidraw_names;
    const auto known = std::find(names.begin(), names.end(), name);
    const auto source = static_cast<std::uint32_t>(known - names.begin());
    if (known != names.end()) return source;
    if (names.size() == kMaxTraceDevices) {
      damaged("more than " + std::to_string(kMaxTraceDevices) + " hidraw nodes", ErrorCode::kLimit);
      return std::nullopt;
    }
    names.push_back(name);
    return source;
  }

  void finish_hid() {
    if (hid_good_ && !hid_time_) {
      hid_good_ = false;
      damaged("a report without time:");
    }
    if (!hid_good_) {
      record_.bytes.resize(hid_begin_);
      return;
    }
    for (const auto& [source, begin, count] : hid_sources_) {
      add({.kind = Kind::kReport,
           .source = source,
           .line = hid_line_,
           .time = *hid_time_,
           .begin = begin,
           .count = count});
    }
  }

  void add(Item item) {
    item.device = static_cast<std::uint32_t>(record_.devices.size() - 1);
    record_.items.push_back(item);
  }

  /// Nothing of what the parser still tells counts any more.
  void give_up(Error error) {
    record_.failure = std::move(error);
    text_.stop();
  }

  void damaged(std::string what, ErrorCode code = ErrorCode::kSyntax, bool frame_lost = false) {
    Error error{code, place(), std::move(what), "add --salvage to skip the damaged part"};
    if (!salvage_) return give_up(std::move(error));
    Item item;
    item.kind = Kind::kDamage;
    item.line = line_;
    item.source = static_cast<std::uint32_t>(record_.devices.size());
    item.begin = record_.damage.size();
    const bool in_frame = std::any_of(levels_.begin(), levels_.end(), [](const Level& level) {
      return level.role == Role::kFrame;
    });
    item.count = in_frame || frame_lost ? 1 : 0;
    item.device =
        record_.devices.empty() ? 0 : static_cast<std::uint32_t>(record_.devices.size() - 1);
    // What is damaged all over takes no more memory than one place of it.
    if (!record_.items.empty()) {
      Item& before = record_.items.back();
      if (before.kind == Kind::kDamage && before.source == item.source) {
        before.count += item.count;
        ++record_.damage.back().places;
        return;
      }
    }
    record_.damage.push_back({std::move(error), 1});
    record_.items.push_back(item);
  }

  std::string place() const { return "line " + std::to_string(line_); }

  struct SourceBytes {
    std::uint32_t source;
    std::size_t begin;
    std::size_t count;
  };

  LibinputRecord& record_;
  GuardedText& text_;
  bool salvage_;
  bool has_version_ = false;
  std::uint32_t line_ = 1;
  std::vector<Level> levels_;
  std::vector<std::int64_t> numbers_;
  bool numbers_good_ = true;
  std::size_t frame_begin_ = 0;
  std::uint32_t frame_line_ = 0;
  bool frame_good_ = true;
  std::optional<Timestamp> hid_time_;
  std::uint32_t hid_line_ = 0;
  std::size_t hid_begin_ = 0;
  bool hid_good_ = true;
  std::vector<SourceBytes> hid_sources_;
};

/// The parser's words, fit for one line.
Error parser_error(const YAML::Exception& error) {
  std::string what = "the YAML is damaged: " + error.msg;
  for (char& c : what) {
    if (c < ' ' || c > '~') c = ' ';
  }
  return {ErrorCode::kSyntax, "line " + std::to_string(error.mark.line + 1), std::move(what),
          "add --salvage to keep what stands before it"};
}

}  // namespace

Expected<LibinputRecord> read_libinput_record(std::unique_ptr<ByteSource> bytes, bool salvage) {
  LibinputRecord record;
  GuardedText text(std::move(bytes), kMaxLibinputBytes);
  Walker walker(record, text, salvage);
  try {
    std::istream in(&text);
    YAML::Parser parser(in);
    parser.HandleNextDocument(walker);
  } catch (const YAML::Exception& error) {
    if (!record.failure) record.failure = parser_error(error);
  }
  // Where the text was ended by its guard, the parser only saw the consequence.
  if (text.error()) record.failure = text.error();
  if (!record.failure && !walker.has_version()) {
    record.failure = Error{ErrorCode::kSyntax, "line 1", "the recording has no version",
                           "give what libinput record wrote"};
  }
  return record;
}

bool has_libinput_records() noexcept { return true; }

}  // namespace limn
