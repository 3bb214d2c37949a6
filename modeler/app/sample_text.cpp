#include "modeler/app/sample_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <numbers>
#include <utility>

namespace limn::app {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

/// Shortest text that reads back as the same number.
template <class Number>
void append_number(Number value, std::string& out) {
  std::array<char, 32> text;
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  out.append(text.data(), end);
}

/// Angles are computed from counts in whole or hundredth degrees; nine decimals take the dust of
/// the conversion to radians and back off again.
double to_degrees(double radians) {
  constexpr double kDust = 1e9;
  const double scaled = radians * kDegrees * kDust;
  return static_cast<double>(static_cast<long long>(scaled + (scaled < 0 ? -0.5 : 0.5))) / kDust;
}

/// Seconds with all nine decimals that a Timestamp holds and no trailing zeros.
void append_seconds(Timestamp t, std::string& out) {
  constexpr long long kNanoseconds = 1'000'000'000;
  long long count = t.count();
  if (count < 0) {
    out += '-';
    count = -count;
  }
  append_number(count / kNanoseconds, out);
  if (const long long fraction = count % kNanoseconds; fraction != 0) {
    std::array<char, 16> text;
    std::snprintf(text.data(), text.size(), ".%09lld", fraction);
    std::string_view digits(text.data());
    digits.remove_suffix(digits.size() - 1 - digits.find_last_not_of('0'));
    out += digits;
  }
}

void append_serial(std::uint64_t serial, std::string& out) {
  std::array<char, 20> text;
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), serial, 16);
  out += "0x";
  out.append(text.data(), end);
}

/// Calls `each(name)` for every pressed button.
template <class Each>
void for_buttons(const PenSample& sample, Each each) {
  for (unsigned i = 0; i < 8; ++i) {
    if ((sample.buttons >> i & 1U) != 0) each(button_name(sample.tool, i));
  }
}

/// Calls `each(name)` for every disturbance.
template <class Each>
void for_disturbances(Disturbances disturbances, Each each) {
  for (unsigned i = 0; i < kDisturbanceCount; ++i) {
    const auto one = static_cast<Disturbance>(1U << i);
    if (disturbances.has(one)) each(name(one));
  }
}

/// What of a sample says how its stream was disturbed before it, in each format.
template <class Sample>
void append_json_loss(const Sample& sample, std::string& out) {
  if (sample.lost_estimated) out += ",\"lost_estimated\":true";
  if (sample.disturbances.empty()) return;
  std::string_view separator = ",\"disturbances\":[\"";
  for_disturbances(sample.disturbances, [&](std::string_view disturbance) {
    out += separator;
    out += disturbance;
    separator = "\",\"";
  });
  out += "\"]";
}

template <class Sample>
void append_csv_loss(const Sample& sample, std::string& out) {
  out += sample.lost_estimated ? ",true," : ",,";
  bool first = true;
  for_disturbances(sample.disturbances, [&](std::string_view disturbance) {
    if (!first) out += ' ';
    out += disturbance;
    first = false;
  });
}

template <class Sample>
void append_line_loss(const Sample& sample, std::string& out) {
  if (sample.lost > 0) {
    out += sample.lost_estimated ? " lost>=" : " lost ";
    append_number(sample.lost, out);
  }
  for_disturbances(sample.disturbances, [&](std::string_view disturbance) {
    out += " !";
    out += disturbance;
  });
}

/// "[1,2,3]"
template <class Numbers>
void append_json_array(const Numbers& numbers, std::string& out) {
  char separator = '[';
  for (const auto number : numbers) {
    out += separator;
    append_number(number, out);
    separator = ',';
  }
  out += ']';
}

constexpr std::string_view kPenHeading =
    "       t s  dev tool         state              x mm      y mm  pressure  tilt x  tilt y"
    "   twist  dist buttons\n";
constexpr std::string_view kMotionHeading =
    "       t s  dev tool         state            x         y         z             rx       ry"
    "       rz\n";
constexpr std::string_view kMouse = "3d_mouse";
constexpr std::size_t kMotionCells = 13;  // columns that only 3D mice have

void append_json(const MotionSample& sample, const Drag& drag, std::string& out) {
  out += "{\"t\":";
  append_seconds(sample.time, out);
  out += ",\"device\":";
  append_number(sample.device, out);
  out += ",\"motion\":{\"mm_per_s\":";
  append_json_array(drag.mm_per_s, out);
  out += ",\"rad_per_s\":";
  append_json_array(drag.rad_per_s, out);
  out += "},\"buttons\":[";
  bool first = true;
  sample.buttons.for_each([&](unsigned number) {
    if (!first) out += ',';
    append_number(number, out);
    first = false;
  });
  out += "],\"raw\":";
  append_json_array(sample.raw, out);
  if (sample.battery_percent) {
    out += ",\"battery_percent\":";
    append_number(static_cast<unsigned>(*sample.battery_percent), out);
  }
  if (sample.silence) out += ",\"silence\":true";
  if (sample.lost > 0) {
    out += ",\"lost\":";
    append_number(sample.lost, out);
  }
  append_json_loss(sample, out);
  out += '}';
}

void append_csv(const MotionSample& sample, const Drag& drag, std::string& out) {
  const auto cell = [&out](auto value) {
    out += ',';
    append_number(value, out);
  };
  append_seconds(sample.time, out);
  cell(sample.device);
  out += ',';
  out += kMouse;
  out += drag.at_rest ? ",at_rest" : ",moving";
  out += ",,,,,,,,";  // x_mm to distance
  bool first = true;
  sample.buttons.for_each([&](unsigned number) {
    if (!first) out += ' ';
    append_number(number, out);
    first = false;
  });
  out += ',';  // serial
  cell(sample.lost);
  out += ",,,";  // raw.x to raw.pressure
  append_csv_loss(sample, out);
  for (const double value : drag.mm_per_s) cell(value);
  for (const double value : drag.rad_per_s) cell(value);
  for (const std::int32_t count : sample.raw) cell(count);
  out += ',';
  if (sample.battery_percent) append_number(static_cast<unsigned>(*sample.battery_percent), out);
  out += '\n';
}

void append_line(const MotionSample& sample, const Drag& drag, std::string& out) {
  std::array<char, 160> text;
  const auto& v = drag.mm_per_s;
  const auto& w = drag.rad_per_s;
  const int length =
      std::snprintf(text.data(), text.size(),
                    "%10.6f %4u %-12s %-8s %9.3f %9.3f %9.3f mm/s  %8.5f %8.5f %8.5f rad/s",
                    to_seconds(sample.time), sample.device, kMouse.data(),
                    drag.at_rest ? "at_rest" : "moving", v[0], v[1], v[2], w[0], w[1], w[2]);
  out.append(text.data(), std::min(static_cast<std::size_t>(length), text.size() - 1));
  sample.buttons.for_each([&out](unsigned number) {
    out += " button";
    append_number(number, out);
  });
  if (sample.battery_percent) {
    out += " battery ";
    append_number(static_cast<unsigned>(*sample.battery_percent), out);
    out += " %";
  }
  append_line_loss(sample, out);
  out += '\n';
}

}  // namespace

void SampleText::begin(std::string& out) const {
  switch (format_) {
    case OutputFormat::kJson:
      out += '[';
      break;
    case OutputFormat::kText:
    case OutputFormat::kJsonl:
      break;
    case OutputFormat::kCsv:
      out +=
          "t,device,tool,state,x_mm,y_mm,pressure,tilt_x_deg,tilt_y_deg,twist_deg,distance,"
          "buttons,serial,lost,raw.x,raw.y,raw.pressure,lost_estimated,disturbances,"
          "mm_per_s.x,mm_per_s.y,mm_per_s.z,rad_per_s.x,rad_per_s.y,rad_per_s.z,"
          "raw.1,raw.2,raw.3,raw.4,raw.5,raw.6,battery_percent\n";
      break;
  }
}

void SampleText::end(std::string& out) const {
  if (format_ == OutputFormat::kJson) out += first_ ? "]\n" : "\n]\n";
}

/// `append()` writes the sample itself.
template <class Append>
void SampleText::append_one(std::string& out, Append append) {
  if (format_ == OutputFormat::kJson) out += first_ ? "\n" : ",\n";
  append();
  if (format_ == OutputFormat::kJsonl) out += '\n';
  first_ = false;
}

void SampleText::append(const PenSample& sample, std::string& out) {
  append_one(out, [&] {
    switch (format_) {
      case OutputFormat::kText:
        if (std::exchange(first_pen_, false)) out += kPenHeading;
        return append_line(sample, out);
      case OutputFormat::kCsv:
        return append_csv(sample, out);
      case OutputFormat::kJson:
      case OutputFormat::kJsonl:
        return append_json(sample, out);
    }
  });
}

bool SampleText::append(const AnySample& sample, std::string& out) {
  if (const auto* const pen = std::get_if<const PenSample*>(&sample)) {
    append(**pen, out);
  } else if (const auto* const motion = std::get_if<const MotionSample*>(&sample)) {
    append(**motion, out);
  } else {
    return false;
  }
  return true;
}

void SampleText::append(const MotionSample& sample, std::string& out) {
  const Drag drag = drags_.push(sample);
  append_one(out, [&] {
    switch (format_) {
      case OutputFormat::kText:
        if (std::exchange(first_motion_, false)) out += kMotionHeading;
        return app::append_line(sample, drag, out);
      case OutputFormat::kCsv:
        return app::append_csv(sample, drag, out);
      case OutputFormat::kJson:
      case OutputFormat::kJsonl:
        return app::append_json(sample, drag, out);
    }
  });
}

void SampleText::append_json(const PenSample& sample, std::string& out) const {
  const PenAxes axes = sample.axes;
  const auto field = [&out](std::string_view key, double value) {
    out += ",\"";
    out += key;
    out += "\":";
    append_number(value, out);
  };
  out += "{\"t\":";
  append_seconds(sample.time, out);
  out += ",\"device\":";
  append_number(sample.device, out);
  out += ",\"tool\":\"";
  out += name(sample.tool);
  out += "\",\"state\":\"";
  out += name(sample.state);
  out += '"';
  if (axes.has(PenAxis::kX)) field("x_mm", sample.x_mm);
  if (axes.has(PenAxis::kY)) field("y_mm", sample.y_mm);
  if (axes.has(PenAxis::kPressure)) field("pressure", sample.pressure);
  if (axes.has(PenAxis::kTiltX)) field("tilt_x_deg", to_degrees(sample.tilt_x_rad));
  if (axes.has(PenAxis::kTiltY)) field("tilt_y_deg", to_degrees(sample.tilt_y_rad));
  if (axes.has(PenAxis::kTwist)) field("twist_deg", to_degrees(sample.twist_rad));
  if (axes.has(PenAxis::kDistance)) field("distance", sample.distance);
  out += ",\"buttons\":[";
  bool first = true;
  for_buttons(sample, [&](std::string_view button) {
    out += first ? "\"" : ",\"";
    out += button;
    out += '"';
    first = false;
  });
  out += ']';
  if (axes.has(PenAxis::kSerial)) {
    out += ",\"serial\":\"";
    append_serial(sample.serial, out);
    out += '"';
  }
  out += ",\"lost\":";
  append_number(sample.lost, out);
  append_json_loss(sample, out);
  if (with_raw_ && (axes.has_position() || axes.has(PenAxis::kPressure))) {
    std::string_view separator = ",\"raw\":{";
    const auto count = [&](PenAxis axis, std::string_view key, std::int32_t value) {
      if (!axes.has(axis)) return;
      out += separator;
      out += '"';
      out += key;
      out += "\":";
      append_number(value, out);
      separator = ",";
    };
    count(PenAxis::kX, "x", sample.raw.x);
    count(PenAxis::kY, "y", sample.raw.y);
    count(PenAxis::kPressure, "pressure", sample.raw.pressure);
    out += '}';
  }
  out += '}';
}

void SampleText::append_csv(const PenSample& sample, std::string& out) const {
  const PenAxes axes = sample.axes;
  const auto cell = [&](bool present, auto value) {
    out += ',';
    if (present) append_number(value, out);
  };
  append_seconds(sample.time, out);
  cell(true, sample.device);
  out += ',';
  out += name(sample.tool);
  out += ',';
  out += name(sample.state);
  cell(axes.has(PenAxis::kX), sample.x_mm);
  cell(axes.has(PenAxis::kY), sample.y_mm);
  cell(axes.has(PenAxis::kPressure), sample.pressure);
  cell(axes.has(PenAxis::kTiltX), to_degrees(sample.tilt_x_rad));
  cell(axes.has(PenAxis::kTiltY), to_degrees(sample.tilt_y_rad));
  cell(axes.has(PenAxis::kTwist), to_degrees(sample.twist_rad));
  cell(axes.has(PenAxis::kDistance), sample.distance);
  out += ',';
  bool first = true;
  for_buttons(sample, [&](std::string_view button) {
    if (!first) out += ' ';
    out += button;
    first = false;
  });
  out += ',';
  if (axes.has(PenAxis::kSerial)) append_serial(sample.serial, out);
  cell(true, sample.lost);
  cell(with_raw_ && axes.has(PenAxis::kX), sample.raw.x);
  cell(with_raw_ && axes.has(PenAxis::kY), sample.raw.y);
  cell(with_raw_ && axes.has(PenAxis::kPressure), sample.raw.pressure);
  append_csv_loss(sample, out);
  out.append(kMotionCells, ',');
  out += '\n';
}

void SampleText::append_line(const PenSample& sample, std::string& out) const {
  std::array<char, 96> text;
  const auto append = [&](int length) {
    out.append(text.data(), std::min(static_cast<std::size_t>(length), text.size() - 1));
  };
  const auto axis = [&](PenAxis which, int width, int decimals, double value) {
    append(sample.axes.has(which)
               ? std::snprintf(text.data(), text.size(), " %*.*f", width, decimals, value)
               : std::snprintf(text.data(), text.size(), " %*s", width, "."));
  };
  append(std::snprintf(text.data(), text.size(), "%10.6f %4u %-12s %-16s", to_seconds(sample.time),
                       sample.device, name(sample.tool).data(), name(sample.state).data()));
  axis(PenAxis::kX, 9, 3, sample.x_mm);
  axis(PenAxis::kY, 9, 3, sample.y_mm);
  axis(PenAxis::kPressure, 9, 5, sample.pressure);
  axis(PenAxis::kTiltX, 7, 2, to_degrees(sample.tilt_x_rad));
  axis(PenAxis::kTiltY, 7, 2, to_degrees(sample.tilt_y_rad));
  axis(PenAxis::kTwist, 7, 2, to_degrees(sample.twist_rad));
  axis(PenAxis::kDistance, 5, 2, sample.distance);
  for_buttons(sample, [&](std::string_view button) {
    out += ' ';
    out += button;
  });
  append_line_loss(sample, out);
  out += '\n';
}

}  // namespace limn::app
