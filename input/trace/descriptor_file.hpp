#pragma once

#include <memory>
#include <vector>

#include "input/base/byte_stream.hpp"
#include "input/trace/trace.hpp"

namespace limn {

/// Reads the report descriptors of a file of any of these kinds, told apart by content:
///
///     raw bytes         has control characters that text has not, as every descriptor does
///     hexadecimal text  two-digit bytes, apart or in a row, with or without 0x, blanks and commas
///                       between; comments: # and // to the end of the line, and /* */
///     hid-recorder      its R: lines
///     usbhid-dump       its DESCRIPTOR records
///
/// Gives one device for each different descriptor, in file order: at least one, none with an empty
/// descriptor. Raw bytes and text give device 0 without name and ids. The descriptors are not
/// parsed. With options.salvage the damage in a recording is passed over; options.supplied is not
/// used.
///
/// Errors: kIo; kSyntax, also for an empty file; kLimit for more than kMaxDescriptorBytes; kMissing
/// where a recording or text holds no descriptor.
Expected<std::vector<TraceDevice>> read_descriptors(std::unique_ptr<ByteSource> bytes,
                                                    const TraceOptions& options = {});

}  // namespace limn
