#include "input/trace_import/libinput_record.hpp"
#include "input/trace_import/trace_import.hpp"

namespace limn {

Expected<LibinputRecord> read_libinput_record(std::unique_ptr<ByteSource> /*bytes*/,
                                              bool /*salvage*/) {
  return fail(ErrorCode::kMissing, "",
              "this limn was built without yaml-cpp, so without libinput recordings",
              "install libyaml-cpp-dev and build limn again");
}

bool has_libinput_records() noexcept { return false; }

}  // namespace limn
