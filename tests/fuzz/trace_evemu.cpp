#include "input/trace/evemu_reader.hpp"
#include "tests/fuzz/trace_laws.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  limn::fuzz::check_reader(limn::fuzz::as_text(data, size),
                           [](std::unique_ptr<limn::ByteSource> bytes, limn::TraceOptions options) {
                             return std::make_unique<limn::EvemuReader>(std::move(bytes),
                                                                        std::move(options));
                           });
  return 0;
}
