#include "tests/kernel/hidapi_reader.hpp"

#include <hidapi/hidapi.h>

#include <array>
#include <cstdio>

bool read_by_hidapi(const char* path, long count, void (*opened)(void*),
                    void (*report)(void*, const unsigned char*, int), void* reader) {
  hid_device* const device = hid_init() == 0 ? hid_open_path(path) : nullptr;
  if (device == nullptr) {
    std::fprintf(stderr, "hidapi: %s: %ls\n", path, hid_error(nullptr));
    return false;
  }
  opened(reader);
  std::array<unsigned char, 1024> bytes{};
  for (; count > 0; --count) {
    constexpr int kPatienceMs = 20000;
    const int size = hid_read_timeout(device, bytes.data(), bytes.size(), kPatienceMs);
    if (size <= 0) break;
    report(reader, bytes.data(), size);
  }
  hid_close(device);
  return count == 0;
}
