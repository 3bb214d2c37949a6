#include "tests/cli/simulated_usb.hpp"

#include <cerrno>
#include <filesystem>

#include "tests/support/recordings.hpp"
#include "tests/support/umockdev_text.hpp"

namespace limn::test {
namespace {

constexpr int kNoSimulation = 99;       // an exit status of ours
constexpr std::uint8_t kInterrupt = 1;  // as usbmon numbers types of transfers
constexpr std::uint8_t kControl = 2;
constexpr std::uint8_t kIn = 0x80;

std::uint8_t low(unsigned value) { return static_cast<std::uint8_t>(value & 0xFF); }
std::uint8_t high(unsigned value) { return low(value >> 8); }

void append(SimulatedUsb::Bytes& bytes, const SimulatedUsb::Bytes& more) {
  bytes.insert(bytes.end(), more.begin(), more.end());
}

/// Low byte first.
void put(std::string& out, std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i, value >>= 8) out += static_cast<char>(value & 0xFF);
}

void put(std::string& out, const SimulatedUsb::Bytes& bytes) {
  out.append(bytes.begin(), bytes.end());
}

/// One packet of a pcap file with usbmon's 64-byte headers.
std::string packet(std::uint64_t request, char event, std::uint8_t type, std::uint8_t endpoint,
                   const SimulatedUsb::Bytes& setup, int status, std::uint32_t length,
                   const SimulatedUsb::Bytes& data) {
  std::string out;
  put(out, request, 8);
  out += event;
  put(out, type, 1);
  put(out, endpoint, 1);
  put(out, 2, 1);  // the device's address
  put(out, 1, 2);  // its bus
  out += setup.empty() ? '-' : '\0';
  out += data.empty() ? '<' : '\0';
  put(out, 0, 12);  // the time
  put(out, static_cast<std::uint64_t>(static_cast<std::int64_t>(status)), 4);
  put(out, length, 4);
  put(out, data.size(), 4);
  put(out, setup.empty() ? SimulatedUsb::Bytes(8) : setup);
  put(out, 0, 16);
  put(out, data);
  std::string framed;
  put(framed, 0, 8);
  put(framed, out.size(), 4);
  put(framed, out.size(), 4);
  return framed + out;
}

}  // namespace

/// A transfer: what is submitted, and how it completes.
void SimulatedUsb::exchange(std::uint8_t type, std::uint8_t endpoint, const Bytes& setup,
                            std::uint32_t length, const Bytes& out, int status, const Bytes& in) {
  const std::uint64_t request = ++requests_;
  packets_ += packet(request, 'S', type, endpoint, setup, -EINPROGRESS, length, out);
  const auto done = static_cast<std::uint32_t>(out.empty() ? in.size() : out.size());
  packets_ += packet(request, 'C', type, endpoint, {}, status, status == 0 ? done : 0, in);
}

void SimulatedUsb::give_descriptor() {
  const std::size_t length =
      announced_descriptor != 0 ? announced_descriptor : report_descriptor.size();
  exchange(kControl, kIn,
           {0x81, 6, 0, 0x22, interface_number, 0, low(static_cast<unsigned>(length)),
            high(static_cast<unsigned>(length))},
           static_cast<std::uint32_t>(length), {}, 0, report_descriptor);
}

void SimulatedUsb::give_string(std::uint8_t index, const Bytes& answer) {
  exchange(kControl, kIn, {0x80, 6, index, 3, 0x09, 0x04, 0x00, 0x01}, 256, {},
           answer.empty() ? -EPIPE : 0, answer);
}

void SimulatedUsb::take_output(const Bytes& bytes) { take_report(2, bytes); }

void SimulatedUsb::take_feature(const Bytes& bytes) { take_report(3, bytes); }

void SimulatedUsb::take_report(std::uint8_t kind, const Bytes& bytes) {
  const auto length = static_cast<unsigned>(bytes.size());
  exchange(kControl, 0, {0x21, 9, bytes[0], kind, interface_number, 0, low(length), high(length)},
           length, bytes, 0, {});
}

void SimulatedUsb::give_feature(std::uint8_t id, const Bytes& answer, std::uint16_t length) {
  exchange(kControl, kIn, {0xA1, 1, id, 3, interface_number, 0, low(length), high(length)}, length,
           {}, 0, answer);
}

void SimulatedUsb::take_interrupt(const Bytes& bytes) {
  exchange(kInterrupt, 3, {}, static_cast<std::uint32_t>(bytes.size()), bytes, 0, {});
}

void SimulatedUsb::send(const Bytes& report, std::uint32_t transfer_bytes) {
  exchange(kInterrupt, kIn | 1, {}, transfer_bytes, {}, 0, report);
}

void SimulatedUsb::fail(int error, std::uint32_t transfer_bytes) {
  exchange(kInterrupt, kIn | 1, {}, transfer_bytes, {}, -error, {});
}

SimulatedUsb::Bytes SimulatedUsb::descriptors() const {
  const auto length = static_cast<unsigned>(announced_descriptor != 0 ? announced_descriptor
                                                                      : report_descriptor.size());
  Bytes interface = {9, 4, interface_number, 0, 2, 3, 0, 0, 0};
  append(interface, {9, 0x21, 0x11, 1, 0, 1, 0x22, low(length), high(length)});
  append(interface, {7, 5, kIn | 1, 3, low(packet_bytes), high(packet_bytes), 8});
  append(interface, {7, 5, 3, 3, 64, 0, 8});
  Bytes out = {18, 1, 0, 2, 0, 0, 0, 8, low(vendor), high(vendor), low(product), high(product),
               0,  1, 1, 2, 0, 1};
  append(out, {9, 2, low(static_cast<unsigned>(9 + interface.size())), 0, 1, 1, 0, 0xA0, 50});
  append(out, interface);
  return out;
}

std::string SimulatedUsb::device_text() const {
  const auto hex = [](unsigned value) {
    char text[8];
    std::snprintf(text, sizeof text, "%04x", value);
    return std::string(text);
  };
  const std::string usb = "/devices/pci0000:00/0000:00:14.0/usb1/1-1";
  const std::string number = "0" + std::to_string(interface_number);
  const std::string interface = usb + "/1-1:1." + std::to_string(interface_number);
  const std::string bytes = digits_of(descriptors());
  std::string text = "P: " + usb + "\nN: bus/usb/001/002=" + bytes +
                     "\nE: DEVTYPE=usb_device\nE: DEVNAME=/dev/bus/usb/001/002\nE: BUSNUM=001\n"
                     "E: DEVNUM=002\nE: MAJOR=189\nE: MINOR=1\nE: SUBSYSTEM=usb\n"
                     "A: busnum=1\\n\nA: devnum=2\\n\nA: bConfigurationValue=1\\n\nA: speed=12\\n\n"
                     "A: idVendor=" +
                     hex(vendor) + "\\n\nA: idProduct=" + hex(product) +
                     "\\n\nA: bcdDevice=0100\\n\nA: product=Small Pen\\n\nA: manufacturer=Limn\\n\n"
                     "H: descriptors=" +
                     bytes + "\n\nP: " + interface +
                     "\nE: DEVTYPE=usb_interface\nE: SUBSYSTEM=usb\nA: bInterfaceNumber=" + number +
                     "\\n\nA: bInterfaceClass=03\\n\n\n";
  const std::string id = "0003:" + hex(vendor) + ":" + hex(product);
  text += "P: " + interface + "/" + id + ".0001\nE: DRIVER=" + driver + "\nE: HID_ID=0003:0000" +
          hex(vendor) + ":0000" + hex(product) +
          "\nE: HID_NAME=Limn Small Pen\nE: HID_PHYS=usb-0000:00:14.0-1/input0\nE: HID_UNIQ=\n"
          "E: SUBSYSTEM=hid\nH: report_descriptor=" +
          digits_of(report_descriptor) + "\n\n";
  if (!on_hidraw) return text;
  text += "P: " + interface + "/" + id +
          ".0001/hidraw/hidraw0\nN: hidraw0\nE: DEVNAME=/dev/hidraw0\nE: MAJOR=243\nE: MINOR=0\n"
          "E: SUBSYSTEM=hidraw\nL: device=../../../" +
          id + ".0001\n\n";
  return text;
}

CommandRun SimulatedUsb::limn(const std::string& words, const std::string& before,
                              const std::string& options) const {
  return run("\"$0\"", words, before, options);
}

CommandRun SimulatedUsb::run(const std::string& program, const std::string& words,
                             const std::string& before, const std::string& options) const {
  std::string head;
  put(head, 0xA1B2C3D4, 4);
  put(head, 2, 2);
  put(head, 4, 2);
  put(head, 0, 8);
  put(head, 262144, 4);
  put(head, 220, 4);  // LINKTYPE_USB_LINUX_MMAPPED
  const std::string capture = folder_.write("usb.pcap", head + packets_).string();
  const std::string device = write_description();
  // umockdev's node is a plain file, which epoll refuses; usbfs can be watched, and so can a pipe.
  // umockdev tells the same stream of transfers that nobody expected.
  const std::string err = folder_.write("err", "").string();
  const std::string script =
      folder_
          .write("inside", std::string("rm ") + kNode + " && mkfifo " + kNode + " || exit " +
                               std::to_string(kNoSimulation) + "\n" + before + "\nexec \"$@\" 2>" +
                               err + "\n")
          .string();
  CommandRun done =
      run_umockdev("-d " + device + " -p /sys/devices/pci0000:00/0000:00:14.0/usb1/1-1=" + capture +
                   " " + options + " -- sh " + script + " " + program + " " + words);
  if (done.exit_code != kNoSimulation) done.err = read_file(err);
  return done;
}

}  // namespace limn::test
