// limn-input [NODE]...: what a small device embeds. Reads pens and prints a line a sample; for each
// stroke, at its end, how many samples it has. Without NODE: every pen that is plugged in, and
// those that come later. NODE `-`: standard input is a socket that keeps messages apart; the first
// is a report descriptor, the others are reports (a firmware under test, say).

#include <unistd.h>

#include <array>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "drivers/devices/trace_decoder.hpp"
#include "drivers/transport/device_listing.hpp"
#include "drivers/transport/hidraw_transport.hpp"
#include "drivers/transport/live_reader.hpp"
#include "drivers/transport/udev_hotplug.hpp"
#include "input/stroke/stroke_sampler.hpp"

namespace {

using Transports = std::vector<std::unique_ptr<limn::Transport>>;

bool is_pen(const limn::ListedDevice& listed) {
  const auto decoder = limn::PenDecoder::make(listed.device.vendor, listed.device.product,
                                              listed.device.report_descriptor);
  return decoder && decoder->has_pen();
}

limn::Expected<std::unique_ptr<limn::Transport>> open_standard_input() {
  std::array<std::uint8_t, 4096> descriptor;
  const ssize_t size = ::read(STDIN_FILENO, descriptor.data(), descriptor.size());
  if (size <= 0) {
    return limn::fail(limn::ErrorCode::kIo, "-", "no report descriptor comes",
                      "send it as the first message");
  }
  limn::TraceDevice device;
  device.report_descriptor.assign(descriptor.begin(), descriptor.begin() + size);
  return limn::open_messages(STDIN_FILENO, std::move(device));
}

limn::Expected<Transports> open_pens(const std::vector<std::string_view>& nodes) {
  Transports opened;
  if (nodes.empty()) {
    const auto listed = limn::list_hid_devices();
    if (!listed) return tl::unexpected(listed.error());
    for (const auto& one : *listed) {
      if (!is_pen(one)) continue;
      if (auto transport = limn::open_hidraw(one.node)) opened.push_back(*std::move(transport));
    }
    return opened;
  }
  for (const std::string_view node : nodes) {
    auto transport = node == "-" ? open_standard_input() : limn::open_hidraw(std::string(node));
    if (!transport) return tl::unexpected(transport.error());
    opened.push_back(*std::move(transport));
  }
  return opened;
}

int fail(const limn::Error& error) {
  std::fprintf(stderr, "limn-input: %s%s%s; %s\n", error.at.c_str(), error.at.empty() ? "" : ": ",
               error.what.c_str(), error.remedy.c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  // Before listing, so that nothing is missed in between; what is told twice is read once.
  auto heard = limn::listen_for_devices();
  auto pens = open_pens({argv + 1, argv + argc});
  if (!pens) return fail(pens.error());
  std::unique_ptr<limn::Hotplug> hotplug;
  if (argc == 1 && heard) {
    limn::DeviceWatch watch;
    watch.wanted = is_pen;
    watch.open = [](const limn::ListedDevice& listed) {
      auto transport = limn::open_hidraw(listed.node);
      return transport ? *std::move(transport) : nullptr;
    };
    if (auto watched = limn::watch_devices(std::move(watch), *std::move(heard)))
      hotplug = *std::move(watched);
  }
  auto reader = limn::LiveReader::start(*std::move(pens), std::move(hotplug));
  if (!reader) return fail(reader.error());

  limn::TraceDecoder decoder(*std::move(reader), {.salvage = true});
  limn::StrokeSampler sampler;
  const auto print = [](const limn::Stroke& stroke) {
    std::printf("stroke of %zu samples\n", stroke.points.size());
  };
  for (;;) {
    const auto sample = decoder.next();
    if (!sample) return fail(sample.error());
    if (*sample == nullptr) break;  // nothing is left to read
    const limn::PenSample& s = **sample;
    std::printf("%.6f %u %s %.3f %.3f %.4f\n", limn::to_seconds(s.time), s.device,
                limn::name(s.state).data(), s.x_mm, s.y_mm, s.pressure);
    std::fflush(stdout);
    sampler.push(s, print);
  }
  sampler.finish(print);
  return 0;
}
