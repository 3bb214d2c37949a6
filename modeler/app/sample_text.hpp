#pragma once

#include <string>
#include <string_view>

#include "drivers/devices/trace_decoder.hpp"
#include "input/stroke/drag_sampler.hpp"
#include "modeler/app/output_format.hpp"

namespace limn::app {

/// Writes samples of pens and 3D mice one by one, in the contract of `limn decode` (see limn(1)):
/// absent axes are absent fields in JSON, empty cells in CSV and dots in text. Times in seconds,
/// positions in mm, angles in degrees.
///
/// The objects hold numbers and fixed words only, so nothing needs escaping and a sample costs
/// a few hundred nanoseconds: recordings of a gigabyte are written without a JSON tree.
class SampleText {
 public:
  /// `with_raw` is false for recordings that hold no device counts; `drag` is for 3D mice.
  SampleText(OutputFormat format, bool with_raw, const DragOptions& drag = {})
      : format_(format), with_raw_(with_raw), drags_(drag) {}

  /// What stands before the first sample and after the last. (In text each kind of device has a
  /// heading of its own, above its first sample.)
  void begin(std::string& out) const;
  void end(std::string& out) const;

  void append(const PenSample& sample, std::string& out);
  void append(const MotionSample& sample, std::string& out);

  /// Either; false, and nothing is written, for the end.
  bool append(const AnySample& sample, std::string& out);

 private:
  template <class Append>
  void append_one(std::string& out, Append append);
  void append_json(const PenSample& sample, std::string& out) const;
  void append_csv(const PenSample& sample, std::string& out) const;
  void append_line(const PenSample& sample, std::string& out) const;

  OutputFormat format_;
  bool with_raw_;
  DragSampler drags_;
  bool first_ = true;
  bool first_pen_ = true;
  bool first_motion_ = true;
};

}  // namespace limn::app
