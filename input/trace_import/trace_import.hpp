#pragma once

#include <memory>
#include <string>

#include "input/base/byte_stream.hpp"
#include "input/base/error.hpp"
#include "input/trace/trace.hpp"

namespace limn {

/// Opens a recording of any program that limn knows: those of open_trace(), and the TraceFormats
/// kUsbCapture, kLibinputRecord and kMotionCsv, told apart by content, never by name.
///
/// What comes out is what open_trace() gives. USB captures are read as a stream; a libinput
/// recording is read whole before its first event, in up to some ten times its size, which is at
/// most kMaxLibinputBytes.
///
/// Error: kIo; kSyntax for an empty file or an unknown format; kUnknown for a capture of something
/// other than USB and for another version of libinput's format; kMissing where this limn was built
/// without the library that reads such a file.
Expected<std::unique_ptr<TraceReader>> open_import(std::unique_ptr<ByteSource> bytes,
                                                   TraceOptions options = {});

/// The same, of a file; "-" is standard input.
Expected<std::unique_ptr<TraceReader>> open_import(const std::string& path,
                                                   TraceOptions options = {});

/// Whether this limn reads USB captures (it was built with libpcap).
bool has_usb_captures() noexcept;

/// Whether this limn reads libinput recordings (it was built with yaml-cpp).
bool has_libinput_records() noexcept;

}  // namespace limn
