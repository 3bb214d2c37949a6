#include "firmware_sim/link/uhid.hpp"

#include <fcntl.h>
#include <linux/uhid.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include "firmware_sim/link/linux_name.hpp"
#include "firmware_sim/link/standard_requests.hpp"

namespace limn::firmware {
namespace {

using std::chrono::microseconds;

constexpr const char* kPath = "/dev/uhid";

/// "/1234.0": unlike that of any other link of this machine's.
std::string unused_place() {
  static std::atomic<unsigned> links = 0;
  return "/" + std::to_string(::getpid()) + "." + std::to_string(links++);
}

/// UhidOptions::bus where nobody says. Sources: hid_is_usb() in drivers/hid/hid-uclogic-core.c and
/// hid-lg.c, and the vendors of their tables.
std::uint16_t bus_of(const DeviceSpec& spec) noexcept {
  constexpr std::array<std::uint16_t, 4> kWantUsb = {0x046D, 0x256C, 0x28BD, 0x5543};
  constexpr std::uint16_t kBluetooth = 5;
  const bool wants = std::find(kWantUsb.begin(), kWantUsb.end(), spec.vendor) != kWantUsb.end();
  return wants ? kBluetooth : static_cast<std::uint16_t>(spec.bus);
}

/// Writes the first `size` bytes of an event; Linux takes those that follow as zeros. Gives 0, or
/// the system's error.
int write_event(const FileDescriptor& file, const uhid_event& event, std::size_t size) {
  while (::write(file.get(), &event, size) < 0) {
    if (errno != EINTR) return errno;
  }
  return 0;
}

LinkResult<void> result_of(int error) {
  if (error == 0) return {};
  return link_fail(std::string("Linux refused an event of /dev/uhid: ") + std::strerror(error),
                   "see what the kernel log says of it");
}

/// Copies as much as fits, ended by a zero.
template <std::size_t kSize>
void put_text(__u8 (&out)[kSize], std::string_view text) {
  std::copy_n(text.begin(), std::min(text.size(), kSize - 1), out);
}

ReportKind kind_of(std::uint8_t uhid_type) {
  if (uhid_type == UHID_FEATURE_REPORT) return ReportKind::kFeature;
  return uhid_type == UHID_OUTPUT_REPORT ? ReportKind::kOutput : ReportKind::kInput;
}

/// A report from Linux as it goes over USB: a zero that stands for no ID stays here.
std::span<std::uint8_t> on_the_wire(std::span<std::uint8_t> bytes) {
  return !bytes.empty() && bytes[0] == 0 ? bytes.subspan(1) : bytes;
}

std::span<std::uint8_t> report_of(__u8* data, std::size_t size) {
  return {data, std::min<std::size_t>(size, UHID_DATA_MAX)};
}

}  // namespace

LinkResult<FileDescriptor> open_uhid() {
  FileDescriptor file(::open(kPath, O_RDWR | O_CLOEXEC | O_NONBLOCK));
  if (file) return file;
  const int error = errno;
  const std::string what = std::string("cannot open ") + kPath + ": " + std::strerror(error);
  if (error == ENOENT || error == ENODEV || error == ENXIO) {
    return link_fail(what, "load it: sudo modprobe uhid");
  }
  if (error == EACCES || error == EPERM) {
    return link_fail(what, "run limn as root, or let your group write to /dev/uhid by a udev rule");
  }
  return link_fail(what, "see whether another program holds too many files");
}

LinkResult<UhidLink> UhidLink::open(BusDevice& device, UhidOptions options, const Opener& opener) {
  std::vector<FileDescriptor> files;
  for (const InterfaceSpec& interface : device.spec().interfaces) {
    if (interface.report_descriptor.size() > HID_MAX_DESCRIPTOR_SIZE) {
      return link_fail("the report descriptor has " +
                           std::to_string(interface.report_descriptor.size()) +
                           " bytes, and UHID takes 4096",
                       "use USB/IP");
    }
    auto file = opener();
    if (!file) return tl::unexpected(std::move(file.error()));
    make_nonblocking(*file);
    files.push_back(*std::move(file));
  }
  return UhidLink(device, options, std::move(files));
}

UhidLink::UhidLink(BusDevice& device, UhidOptions options, std::vector<FileDescriptor> files)
    : place_(unused_place()),
      device_(&device),
      options_(options),
      files_(std::move(files)),
      host_(std::make_unique<InMemoryHost>(device, InMemoryHost::Polling::kWhenDue)) {}

LinkResult<LinkEnd> UhidLink::run(microseconds end, Waiter& waiter) {
  if (!options_.wait_for_reader) clock_.start();
  auto ended = serve(end, waiter);
  destroy();
  return ended;
}

LinkResult<LinkEnd> UhidLink::serve(microseconds end, Waiter& waiter) {
  std::vector<Watched> watched;
  for (const FileDescriptor& file : files_) watched.push_back({file.get()});
  while (!waiter.stopped()) {
    const microseconds now = std::min(clock_.now(), end);
    while (const auto event = host_->next(now)) {
      if (auto done = handle(*event); !done) return tl::unexpected(std::move(done.error()));
    }
    if (now >= end) return LinkEnd::kTimeUp;
    std::optional<SimulationClock::Point> deadline;
    if (clock_.runs()) deadline = clock_.at(std::min(host_->next_look(), end));
    waiter.wait(watched, deadline);
    for (std::size_t i = 0; i < watched.size(); ++i) {
      if (!watched[i].ready) continue;
      if (auto done = answer(static_cast<std::uint8_t>(i)); !done) {
        return tl::unexpected(std::move(done.error()));
      }
    }
  }
  return LinkEnd::kStopped;
}

LinkResult<void> UhidLink::handle(const HostEvent& event) {
  if (event.kind == HostEvent::Kind::kUnplugged) {
    destroy();
    return {};
  }
  if (event.kind == HostEvent::Kind::kPlugged) {
    for (std::size_t i = 0; i < files_.size(); ++i) {
      if (auto done = create(static_cast<std::uint8_t>(i)); !done) return done;
    }
    created_ = true;
    return {};
  }
  uhid_event input{};
  input.type = UHID_INPUT2;
  const std::size_t size = std::min<std::size_t>(event.bytes.size(), UHID_DATA_MAX);
  input.u.input2.size = static_cast<__u16>(size);
  std::copy_n(event.bytes.begin(), size, input.u.input2.data);
  const int error =
      write_event(files_[event.interface], input, offsetof(uhid_event, u.input2.data) + size);
  ++(error == 0 ? reports_ : refused_);
  return result_of(error == EINVAL ? 0 : error);  // no driver took the device
}

LinkResult<void> UhidLink::create(std::uint8_t interface) {
  const DeviceSpec& spec = device_->spec();
  const auto descriptor = host_->report_descriptor(interface);
  uhid_event event{};
  event.type = UHID_CREATE2;
  auto& device = event.u.create2;
  put_text(device.name, linux_name(spec));
  put_text(device.phys, physical_path(interface, place_));
  put_text(device.uniq, spec.serial_number);
  device.rd_size = static_cast<__u16>(descriptor.size());
  std::copy(descriptor.begin(), descriptor.end(), device.rd_data);
  device.bus = options_.bus.value_or(bus_of(spec));
  device.vendor = spec.vendor;
  device.product = spec.product;
  device.version = spec.version;
  return result_of(write_event(files_[interface], event, sizeof event));
}

void UhidLink::destroy() {
  if (!std::exchange(created_, false)) return;
  uhid_event event{};
  event.type = UHID_DESTROY;
  // One that no driver took is gone already.
  for (const FileDescriptor& file : files_) write_event(file, event, sizeof event.type);
}

LinkResult<void> UhidLink::answer(std::uint8_t interface) {
  uhid_event event{};
  const ssize_t got = ::read(files_[interface].get(), &event, sizeof event);
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return {};
  if (got < static_cast<ssize_t>(sizeof event.type)) {
    return link_fail("/dev/uhid was closed", "see what the kernel log says of it");
  }
  if (event.type == UHID_OPEN && created_ && !clock_.runs()) clock_.start();
  if (!created_) return {};  // it came while the device was being unplugged: for the one that left
  if (event.type == UHID_GET_REPORT) return answer_get(interface, event);
  if (event.type == UHID_SET_REPORT) return answer_set(interface, event);
  if (event.type == UHID_OUTPUT) {
    const auto bytes = report_of(event.u.output.data, event.u.output.size);
    const std::uint8_t id = bytes.empty() ? std::uint8_t{0} : bytes[0];
    host_->send_output(interface, id, on_the_wire(bytes));  // Linux wants no answer to it
  }
  return {};
}

LinkResult<void> UhidLink::answer_get(std::uint8_t interface, const uhid_event& event) {
  uhid_event answer{};
  answer.type = UHID_GET_REPORT_REPLY;
  auto& answered = answer.u.get_report_reply;
  answered.id = event.u.get_report.id;
  const SetupPacket setup = get_report(interface, kind_of(event.u.get_report.rtype),
                                       event.u.get_report.rnum, UHID_DATA_MAX);
  const TransferResult result =
      host_->control(setup, std::span<std::uint8_t>(answered.data, UHID_DATA_MAX));
  if (result.status == TransferStatus::kNak) return {};  // Linux itself waits 5 s
  if (result.status == TransferStatus::kDone) {
    answered.size = static_cast<__u16>(std::min<std::size_t>(result.bytes, UHID_DATA_MAX));
  } else {
    answered.err = EIO;
  }
  return result_of(write_event(files_[interface], answer, sizeof answer));
}

LinkResult<void> UhidLink::answer_set(std::uint8_t interface, uhid_event& event) {
  auto& asked = event.u.set_report;
  const auto whole = report_of(asked.data, asked.size);
  const auto bytes = asked.rnum == 0 ? on_the_wire(whole) : whole;
  const SetupPacket setup = set_report(interface, kind_of(asked.rtype), asked.rnum,
                                       static_cast<std::uint16_t>(bytes.size()));
  const TransferResult result = host_->control(setup, bytes);
  if (result.status == TransferStatus::kNak) return {};
  uhid_event answer{};
  answer.type = UHID_SET_REPORT_REPLY;
  answer.u.set_report_reply.id = asked.id;
  answer.u.set_report_reply.err = result.status == TransferStatus::kDone ? 0 : EIO;
  return result_of(write_event(files_[interface], answer,
                               offsetof(uhid_event, u) + sizeof answer.u.set_report_reply));
}

}  // namespace limn::firmware
