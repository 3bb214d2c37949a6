#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "drivers/devices/pen_decoder.hpp"
#include "drivers/devices/trace_decoder.hpp"
#include "input/trace/trace.hpp"

namespace limn::test {

using ReportBytes = std::vector<std::uint8_t>;

constexpr std::uint16_t kWacom = 0x056A;
constexpr double kDegree = 0.017453292519943295;

/// A device that a row of the tables, with its conditions, stands for.
inline PenIdentity identity_of(const PenSpec& spec) {
  PenIdentity identity;
  identity.vendor = spec.vendor;
  identity.product = spec.product;
  identity.product_name = spec.product_name;
  identity.firmware = spec.firmware;
  identity.descriptor_bytes = spec.descriptor_bytes;
  return identity;
}

/// A decoder and everything it gave.
class DecodedDevice {
 public:
  DecodedDevice(std::uint16_t vendor, std::uint16_t product, const ReportBytes& descriptor = {})
      : decoder_(checked(PenDecoder::make(vendor, product, descriptor))) {}
  explicit DecodedDevice(const PenIdentity& identity)
      : decoder_(checked(PenDecoder::make(identity, {}))) {}

  /// Decodes one report and returns its samples.
  std::vector<PenSample> operator()(const ReportBytes& bytes, Timestamp time = {}) {
    const auto decoded = decoder_.decode(Report{3, time, bytes});
    kind_ = decoded.kind;
    return {decoded.samples.begin(), decoded.samples.end()};
  }

  /// Of the last report.
  ReportClass kind() const { return kind_; }
  PenDecoder& decoder() { return decoder_; }

 private:
  PenDecoder decoder_;
  ReportClass kind_ = ReportClass::kOther;

  static PenDecoder checked(Expected<PenDecoder> made) {
    EXPECT_TRUE(made) << made.error().what;
    return std::move(*made);
  }
};

/// All samples of a trace and what the decoder says of it, up to the end or the first error.
struct DecodedTrace {
  std::vector<PenSample> samples;
  TraceSummary summary;
  Error error;
  bool failed = false;

  std::size_t count(PenState state) const {
    std::size_t found = 0;
    for (const PenSample& sample : samples) found += sample.state == state ? 1 : 0;
    return found;
  }
};

inline DecodedTrace decode_trace(std::string_view text, TraceOptions options = {},
                                 bool salvage = false) {
  DecodedTrace out;
  options.salvage = salvage;
  auto reader = open_trace(memory_bytes(text), std::move(options));
  if (!reader) {
    out.failed = true;
    out.error = reader.error();
    return out;
  }
  TraceDecoder decoder(std::move(*reader), {.salvage = salvage});
  for (;;) {
    const auto sample = decoder.next();
    if (!sample) {
      out.failed = true;
      out.error = sample.error();
      break;
    }
    if (*sample == nullptr) break;
    out.samples.push_back(**sample);
  }
  out.summary = decoder.summary();
  return out;
}

/// Every pair of neighbours of one device is a legal transition, from out of range on.
inline void expect_legal_transitions(const std::vector<PenSample>& samples) {
  std::vector<std::pair<DeviceIndex, PenState>> last;
  for (const PenSample& sample : samples) {
    PenState* before = nullptr;
    for (auto& [device, state] : last) {
      if (device == sample.device) before = &state;
    }
    if (before == nullptr) before = &last.emplace_back(sample.device, PenState{}).second;
    ASSERT_TRUE(is_legal_transition(*before, sample.state))
        << name(*before) << " -> " << name(sample.state) << " at " << to_seconds(sample.time);
    *before = sample.state;
  }
}

}  // namespace limn::test
