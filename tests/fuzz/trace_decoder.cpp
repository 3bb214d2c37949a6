// A whole stream: events of all kinds, of any devices, at any times, strictly and with salvage.
//
//   u8    bit 0: frames of the kernel instead of reports
//   then events: u8 kind (modulo 8), u8 device (modulo 66: more than there may be), and
//     0  described: u8 a row of the tables + 1, or 0 and u16 vendor, u16 product; u16 length and
//        bytes of the descriptor (or, of the kernel: u8 number of axes, of 17 bytes)
//     1  report: u8 ms since the last, u8 length, bytes; or frame: u8 ms, u8 events, of 7 bytes
//     2  note: u8 length, bytes
//     3  note "gone"
//     4  note "lost N" or "lost? N": u8 form, u32 N
//     5  time: s32 ms further or back
//     6  damage: u8 flags, u16 lost
//     7  silence until the decoder's deadline, where it has one

#include "drivers/devices/trace_decoder.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "input/stroke/drag_sampler.hpp"
#include "tests/fuzz/fuzz_input.hpp"
#include "tests/fuzz/pen_laws.hpp"

namespace {

using namespace limn;

constexpr std::array<std::uint16_t, 10> kAxes = {0x00, 0x01, 0x18, 0x19, 0x1A,
                                                 0x1B, 0x02, 0x03, 0x04, 0x05};

class FuzzedReader final : public TraceReader {
 public:
  explicit FuzzedReader(std::span<const std::uint8_t> bytes) : input_(bytes.data(), bytes.size()) {
    kernel_ = (input_.byte() & 1U) != 0;
  }

  TraceFormat format() const noexcept override {
    return kernel_ ? TraceFormat::kEvemu : TraceFormat::kHidRecorder;
  }
  std::string place() const override { return "event " + std::to_string(count_); }

  Expected<TraceEvent> next() override {
    for (;;) {
      if (auto event = *next_until(Timestamp::max())) return *std::move(event);
    }
  }

  Expected<std::optional<TraceEvent>> next_until(Timestamp deadline) override {
    while (!input_.empty()) {
      ++count_;
      const unsigned kind = input_.byte() % 8U;
      const DeviceIndex device = input_.byte() % 66U;
      switch (kind) {
        case 0:
          return describe(device);
        case 1:
          return kernel_ ? frame(device) : report(device);
        case 2: {
          const auto text = input_.take(input_.byte());
          note_.assign(text.begin(), text.end());
          return TraceNote{note_, device};
        }
        case 3:
          note_ = "gone";
          return TraceNote{note_, device};
        case 4:
          note_ = (input_.byte() & 1U) != 0 ? "lost? " : "lost ";
          note_ += std::to_string(static_cast<std::uint32_t>(input_.number()));
          return TraceNote{note_, device};
        case 5:
          pass(std::chrono::milliseconds(input_.number()));
          break;
        case 6:
          return damage(device);
        default:
          if (deadline == Timestamp::max()) break;
          time_ = std::max(time_, deadline);
          return std::nullopt;
      }
    }
    return TraceEnd{};
  }

 private:
  /// Times are those of clocks and files: never negative.
  void pass(Timestamp time) {
    constexpr Timestamp kLatest = Timestamp::max() / 2;
    time_ = std::clamp(time_ + time, Timestamp::zero(), kLatest);
  }

  TraceEvent describe(DeviceIndex index) {
    device_ = TraceDevice{};
    device_.index = index;
    if (const std::size_t row = input_.byte(); row > 0) {
      const PenSpec& spec = pen_specs()[(row - 1) % pen_specs().size()];
      device_.vendor = spec.vendor;
      device_.product = spec.product;
      device_.name = spec.product_name;
    } else {
      device_.vendor = input_.word();
      device_.product = input_.word();
    }
    if (kernel_) {
      const std::size_t axes = input_.byte() % (kAxes.size() + 1);
      for (std::size_t i = 0; i < axes; ++i) {
        EvdevAxis axis;
        axis.code = kAxes[i];
        axis.minimum = input_.number();
        axis.maximum = input_.number();
        axis.resolution = input_.byte();
        device_.axes.push_back(axis);
      }
    } else {
      const auto descriptor = input_.take(input_.word());
      device_.report_descriptor.assign(descriptor.begin(), descriptor.end());
    }
    return DeviceDescribed{&device_};
  }

  TraceEvent report(DeviceIndex device) {
    pass(std::chrono::milliseconds(input_.byte()));
    return Report{device, time_, input_.take(input_.byte())};
  }

  TraceEvent frame(DeviceIndex device) {
    pass(std::chrono::milliseconds(input_.byte()));
    events_.clear();
    const std::size_t count = input_.byte() % 32U;
    for (std::size_t i = 0; i < count; ++i) {
      EvdevEvent event;
      event.time = time_;
      event.type = input_.byte() % 5U;
      event.code = input_.word();
      event.value = input_.number();
      events_.push_back(event);
    }
    return EvdevFrame{device, time_, events_};
  }

  TraceEvent damage(DeviceIndex device) {
    const unsigned flags = input_.byte();
    TraceDamage damage;
    damage.error = Error{ErrorCode::kSyntax, "here", "damage", "none"};
    if ((flags & 1U) != 0) damage.lost.push_back({device, input_.word(), (flags & 2U) != 0});
    return damage;
  }

  fuzz::Input input_;
  bool kernel_ = false;
  std::size_t count_ = 0;
  Timestamp time_{};
  TraceDevice device_;
  std::string note_;
  std::vector<EvdevEvent> events_;
};

struct Seen {
  fuzz::PenLaws laws;
  Timestamp last{};
  bool any = false;
};

/// What holds of every sample in its stream; gives what is lost before it.
template <class Sample>
std::uint64_t check_stream(const Sample& s, Seen& seen) {
  fuzz::require(!seen.any || s.time >= seen.last || s.disturbances.has(Disturbance::kClockJump),
                "time goes back only with a clock jump");
  fuzz::require(s.lost == 0 || s.disturbances.has(Disturbance::kOverrun) ||
                    s.disturbances.has(Disturbance::kGap) ||
                    s.disturbances.has(Disturbance::kDamage),
                "what is lost has a cause");
  fuzz::require(!s.lost_estimated || s.lost > 0 || s.disturbances.has(Disturbance::kOverrun),
                "an estimate is of something, or of a queue that was full");
  seen.last = s.time;
  seen.any = true;
  return s.lost;
}

void check_motion(const MotionSample& sample, const Drag& drag) {
  fuzz::require(!sample.silence || sample.is_zero(), "silence is rest");
  for (std::size_t i = 0; i < 3; ++i) {
    fuzz::require(std::isfinite(drag.mm_per_s[i]) && std::isfinite(drag.rad_per_s[i]) &&
                      std::isfinite(drag.mm[i]) && std::isfinite(drag.rad[i]),
                  "drags are finite");
    fuzz::require(!sample.silence || (drag.mm_per_s[i] == 0 && drag.rad_per_s[i] == 0),
                  "nothing moves in silence");
  }
}

void decode(std::span<const std::uint8_t> bytes, bool salvage) {
  TraceDecoder decoder(std::make_unique<FuzzedReader>(bytes), {.salvage = salvage});
  std::map<DeviceIndex, Seen> devices;
  DragSampler drags;
  std::uint64_t samples = 0;
  std::uint64_t lost = 0;
  // A byte is at most an event, an event at most a full output.
  std::uint64_t left = (bytes.size() + 2) * 2 * PenOutput::kCapacity;
  for (;;) {
    fuzz::require(left-- > 0, "a stream ends");
    const auto sample = decoder.next_any();
    if (!sample) {
      const auto again = decoder.next_any();
      fuzz::require(!again && again.error().what == sample.error().what, "an error stays");
      fuzz::require(!sample.error().what.empty() && !sample.error().remedy.empty(),
                    "an error says what is wrong and to do");
      break;
    }
    if (std::holds_alternative<std::monostate>(*sample)) break;
    ++samples;
    if (const auto* const pen = std::get_if<const PenSample*>(&*sample)) {
      Seen& seen = devices[(*pen)->device];
      seen.laws.check({*pen, 1});
      lost += check_stream(**pen, seen);
    } else {
      const MotionSample& motion = *std::get<const MotionSample*>(*sample);
      lost += check_stream(motion, devices[motion.device]);
      check_motion(motion, drags.push(motion));
    }
  }
  const TraceSummary summary = decoder.summary();
  fuzz::require(summary.samples == samples, "every sample is counted");
  fuzz::require(summary.losses().lost >= lost, "every loss is counted");
  fuzz::require(summary.devices.size() <= TraceDecoder::kMaxDevices, "devices are limited");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  decode({data, size}, false);
  decode({data, size}, true);
  return 0;
}
