#include "input/trace/descriptor_file.hpp"
#include "tests/fuzz/trace_laws.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using limn::fuzz::require;
  const std::string_view text = limn::fuzz::as_text(data, size);
  bool strict_read = false;
  for (const bool salvage : {false, true}) {
    limn::TraceOptions options;
    options.salvage = salvage;
    const auto devices = limn::read_descriptors(limn::memory_bytes(text), options);
    if (!devices) {
      require(!strict_read, "salvage reads what strict reading does");
      limn::fuzz::require_good_error(devices.error());
      continue;
    }
    strict_read = !salvage;
    require(!devices->empty() && devices->size() <= limn::kMaxTraceDevices, "devices are limited");
    for (const limn::TraceDevice& device : *devices) {
      const std::size_t bytes = device.report_descriptor.size();
      require(bytes > 0 && bytes <= limn::kMaxDescriptorBytes, "descriptors are limited");
    }
  }
  return 0;
}
