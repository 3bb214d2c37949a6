#include "modeler/app/bus_control.hpp"

#include <algorithm>

#include "drivers/transport/control_request.hpp"
#include "firmware_sim/link/standard_requests.hpp"

namespace limn::app {
namespace {

using firmware::ReportKind;
using firmware::TransferStatus;

tl::unexpected<Error> refused(const char* what) {
  return fail(ErrorCode::kIo, "", std::string("the simulated device refuses ") + what,
              "leave out the fault that makes it do so");
}

}  // namespace

Expected<std::vector<std::uint8_t>> BusControl::read_string(std::uint8_t index,
                                                            std::uint16_t language,
                                                            std::uint16_t length) {
  std::vector<std::uint8_t> data(length);
  const auto result = host_.control(firmware::get_string(index, language, length), data);
  data.resize(result.status == TransferStatus::kDone ? std::min(result.bytes, data.size()) : 0);
  return data;
}

Expected<void> BusControl::write_interrupt(std::uint8_t, std::span<const std::uint8_t> bytes) {
  const std::uint8_t id = bytes.empty() ? std::uint8_t{0} : bytes[0];
  if (!host_.send_output(interface_, id, bytes)) return refused("an output report");
  return {};
}

Expected<void> BusControl::set_output(std::span<const std::uint8_t> bytes) {
  return set_report(ReportKind::kOutput, bytes, "an output report");
}

Expected<void> BusControl::set_feature(std::span<const std::uint8_t> bytes) {
  return set_report(ReportKind::kFeature, bytes, "a feature report");
}

Expected<void> BusControl::set_report(ReportKind kind, std::span<const std::uint8_t> bytes,
                                      const char* what) {
  if (bytes.empty()) return {};
  const auto sent = report_data(bytes);
  std::vector<std::uint8_t> data(sent.begin(), sent.end());
  const auto setup =
      firmware::set_report(interface_, kind, bytes[0], static_cast<std::uint16_t>(data.size()));
  if (host_.control(setup, data).status != TransferStatus::kDone) return refused(what);
  return {};
}

Expected<std::vector<std::uint8_t>> BusControl::get_feature(std::uint8_t id, std::size_t length) {
  std::vector<std::uint8_t> data(std::min<std::size_t>(length, 65535));
  const auto setup = firmware::get_report(interface_, ReportKind::kFeature, id,
                                          static_cast<std::uint16_t>(data.size()));
  const auto result = host_.control(setup, data);
  if (result.status != TransferStatus::kDone) return refused("to give a feature report");
  data.resize(std::min(result.bytes, data.size()));
  return data;
}

}  // namespace limn::app
