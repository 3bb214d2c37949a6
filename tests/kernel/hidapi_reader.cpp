// hidapi_reader PATH COUNT: opens a device by hidapi's libusb backend, as other programs do, and
// prints its next COUNT reports, a line of hexadecimal bytes each. A program of its own, as
// hidapi's backends have the same symbols and limn has the other one.

#include <hidapi/hidapi.h>

#include <array>
#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  if (hid_init() != 0) return 1;
  hid_device* const device = hid_open_path(argv[1]);
  if (device == nullptr) {
    std::fprintf(stderr, "hidapi_reader: %s: %ls\n", argv[1], hid_error(nullptr));
    return 1;
  }
  std::puts("open");
  std::fflush(stdout);
  std::array<unsigned char, 1024> report{};
  for (long left = std::strtol(argv[2], nullptr, 10); left > 0; --left) {
    constexpr int kPatienceMs = 20000;
    const int size = hid_read_timeout(device, report.data(), report.size(), kPatienceMs);
    if (size <= 0) break;
    for (int i = 0; i < size; ++i) std::printf("%02x ", report[static_cast<std::size_t>(i)]);
    std::printf("\n");
  }
  hid_close(device);
  return hid_exit();
}
