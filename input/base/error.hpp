#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace limn {

/// What kind of thing went wrong; decides nothing but is stable, so callers and tests may compare.
enum class ErrorCode {
  kIo,          ///< the operating system refused to open, read or write
  kSyntax,      ///< the text or bytes do not follow their format
  kUnknown,     ///< well formed, but names something that limn does not know
  kMissing,     ///< something needed is absent (a descriptor, a device id)
  kOutOfRange,  ///< a value outside what is allowed or finite
  kLimit,       ///< larger than limn accepts
  kPointCount,  ///< counts that must agree do not
  kNumeric,     ///< a computation has no (stable) answer
};

/// One failure, in the four parts a person needs. The command line prints
/// "limn: FILE: AT: WHAT; REMEDY" on one line, so no part ends with a full stop or holds a newline.
struct Error {
  ErrorCode code = ErrorCode::kIo;
  std::string at;      ///< place inside the input, e.g. "line 12" or "byte 40"; may be empty
  std::string what;    ///< what is wrong, e.g. "the length says 9 but 8 bytes follow"
  std::string remedy;  ///< what to do, e.g. "correct the line or add --salvage to skip it"
};

template <class T>
using Expected = tl::expected<T, Error>;

inline tl::unexpected<Error> fail(ErrorCode code, std::string at, std::string what,
                                  std::string remedy) {
  return tl::unexpected<Error>(Error{code, std::move(at), std::move(what), std::move(remedy)});
}

}  // namespace limn
