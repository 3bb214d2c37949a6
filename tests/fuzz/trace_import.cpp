#include "input/trace_import/trace_import.hpp"

#include "tests/fuzz/trace_laws.hpp"

// Telling the format from any bytes, then reading in it: captures, YAML, CSV and limn's own.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  limn::fuzz::check_reader(limn::fuzz::as_text(data, size),
                           [](std::unique_ptr<limn::ByteSource> bytes,
                              limn::TraceOptions options) -> std::unique_ptr<limn::TraceReader> {
                             auto reader = limn::open_import(std::move(bytes), std::move(options));
                             if (reader) return std::move(*reader);
                             limn::fuzz::require_good_error(reader.error());
                             return nullptr;
                           });
  return 0;
}
