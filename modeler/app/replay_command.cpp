#include <cstdio>

#include "drivers/devices/trace_decoder.hpp"
#include "drivers/transport/paced_reader.hpp"
#include "firmware_sim/usb/usb_device.hpp"
#include "modeler/app/command.hpp"
#include "modeler/app/device_link.hpp"
#include "modeler/app/recorded_device.hpp"
#include "modeler/app/sample_text.hpp"
#include "modeler/app/standard_output.hpp"
#include "modeler/app/trace_input.hpp"

namespace limn::app {
namespace {

/// The recorded device, at the end of a cable that is pulled when it was.
class ReplayedDevice final : public firmware::BusDevice {
 public:
  using Time = std::chrono::microseconds;

  /// `recorded` must outlive this.
  explicit ReplayedDevice(RecordedDevice& recorded) : recorded_(recorded), usb_(recorded) {}

  const firmware::DeviceSpec& spec() const noexcept override { return usb_.spec(); }
  bool plugged(Time now) noexcept override { return recorded_.plugged(now); }
  void reset() noexcept override { usb_.reset(); }
  firmware::TransferResult control(const firmware::SetupPacket& setup, Time now,
                                   std::span<std::uint8_t> data) noexcept override {
    return plugged(now) ? usb_.control(setup, now, data) : kAway;
  }
  firmware::TransferResult interrupt_in(std::uint8_t endpoint, Time now,
                                        std::span<std::uint8_t> data) noexcept override {
    return plugged(now) ? usb_.interrupt_in(endpoint, now, data) : kAway;
  }
  firmware::TransferResult interrupt_out(std::uint8_t endpoint, Time now,
                                         std::span<const std::uint8_t> data) noexcept override {
    return plugged(now) ? usb_.interrupt_out(endpoint, now, data) : kAway;
  }

 private:
  static constexpr firmware::TransferResult kAway{firmware::TransferStatus::kNoDevice, 0};

  RecordedDevice& recorded_;
  firmware::UsbDevice usb_;
};

Outcome replay_to_others(TraceReader& reader, const ReplayArguments& arguments) {
  auto recorded = in_file(arguments.trace.path, RecordedDevice::read(reader, arguments.speed));
  if (!recorded) return tl::unexpected(std::move(recorded.error()));
  ReplayedDevice device(**recorded);
  return run_device_link(device, (*recorded)->duration(), arguments.link);
}

}  // namespace

Outcome run_replay(const ReplayArguments& arguments) {
  auto reader = open_trace_input(arguments.trace);
  if (!reader) return tl::unexpected(std::move(reader.error()));
  if (arguments.link.wanted()) return replay_to_others(**reader, arguments);
  SampleText format(arguments.format, (*reader)->format() != TraceFormat::kStrokeCsv,
                    arguments.drag);
  TraceDecoder decoder(
      std::make_unique<PacedReader>(std::move(*reader), arguments.speed, monotonic_clock()),
      {.salvage = arguments.trace.salvage});

  StandardOutput out;
  format.begin(out.text());
  for (;;) {
    // Each sample goes out before the next one is waited for.
    if (auto written = out.flush(); !written) return written;
    auto sample = decoder.next_any();
    if (!sample) {
      return in_file(arguments.trace.path, Expected<void>(tl::unexpected(sample.error())));
    }
    if (!format.append(*sample, out.text())) break;
  }
  format.end(out.text());
  if (auto written = out.flush(); !written) return written;
  std::fprintf(stderr, "%s\n", summarise(decoder.summary()).c_str());
  return {};
}

}  // namespace limn::app
