#include "firmware_sim/devices/faults.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

namespace limn::firmware {
namespace {

using namespace std::chrono_literals;
using K = FaultKind;

// clang-format off
constexpr std::array<FaultInfo, kFaultKinds> kFaults = {{
    {"drop",       "reports are lost, each with p",                                    {K::kDrop,      0s, 0.02, 0, 1}},
    {"duplicate",  "reports come twice, each with p",                                  {K::kDuplicate, 0s, 0.02, 0, 1}},
    {"reorder",    "reports come after the one that follows them, each with p",        {K::kReorder,   0s, 0.02, 0, 1}},
    {"short",      "reports lack bytes at their end, each with p",                     {K::kShort,     0s, 0.02, 0, 1}},
    {"overlong",   "reports have up to 16 bytes too many, each with p",                {K::kOverlong,  0s, 0.02, 0, 1}},
    {"wrong-id",   "reports have another first byte, each with p",                     {K::kWrongId,   0s, 0.02, 0, 1}},
    {"garbage",    "reports have random bytes behind the first, each with p",          {K::kGarbage,   0s, 0.02, 0, 1}},
    {"stall",      "the endpoint halts until the host clears it, a report is lost",    {K::kStall,     1s, 1, 1, 1}},
    {"timeout",    "the device answers nothing for a second",                          {K::kTimeout,   1s, 1, 1, 1}},
    {"unplug",     "the device is unplugged for half a second",                        {K::kUnplug,    1s, 1, 1, 1}},
    {"mode-change", "the device forgets what its driver told it, unasked",             {K::kModeChange, 1s, 1, 1, 1}},
    {"stuck-tip",  "reports stay as one was: a tip that never lifts",                  {K::kStuckTip,  1s, 1, 0, 1}},
    {"orphan-exit", "of reports up to a pause only the last one comes: it leaves where it never was", {K::kOrphanExit, 1s, 1, 1, 1}},
    {"time-jump",  "the device's clock and its hand jump 10 s ahead",                  {K::kTimeJump,  1s, 1, 1, 1}},
    {"batch",      "the reports of 100 ms come all at once",                           {K::kBatch,     1s, 1, 1, 1}},
    {"flood",      "a report comes 2000 times at once",                                {K::kFlood,     1s, 1, 1, 1}},
    {"hostile-descriptor", "bytes of the report descriptor are random, each with p",   {K::kHostileDescriptor, 0s, 0.1, 0, 1}},
}};
// clang-format on

constexpr bool in_order() {
  for (std::size_t i = 0; i < kFaults.size(); ++i) {
    if (static_cast<std::size_t>(kFaults[i].usual.kind) != i) return false;
  }
  return true;
}
static_assert(in_order());

template <class Number>
std::optional<Number> number(std::string_view text) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, value);
  if (parsed.ec != std::errc{} || parsed.ptr != end) return std::nullopt;
  return value;
}

ParsedFault wrong(std::string what) { return {std::nullopt, std::move(what), false}; }

/// Sets what `setting` ("p=0.5") says; the error, or nothing.
std::string apply(std::string_view setting, FaultSpec& fault) {
  constexpr double kDay = 86400;
  const std::string quoted = "'" + std::string(setting) + "'";
  const std::size_t equals = setting.find('=');
  const std::string_view key = setting.substr(0, equals);
  const std::string_view text =
      equals == std::string_view::npos ? std::string_view() : setting.substr(equals + 1);
  if (key == "at") {
    const auto seconds = number<double>(text);
    if (!seconds || !(*seconds >= 0 && *seconds <= kDay)) {
      return quoted + ": at= takes seconds, 0 to 86400";
    }
    fault.at = std::chrono::microseconds(std::llround(*seconds * 1e6));
  } else if (key == "p") {
    const auto probability = number<double>(text);
    if (!probability || !(*probability > 0 && *probability <= 1)) {
      return quoted + ": p= takes a probability, above 0 and at most 1";
    }
    fault.probability = *probability;
  } else if (key == "n") {
    const auto count = number<std::uint32_t>(text);
    if (!count || *count == 0) return quoted + ": n= takes a count, 1 to 4294967295";
    fault.count = *count;
  } else if (key == "seed") {
    const auto seed = number<std::uint64_t>(text);
    if (!seed) return quoted + ": seed= takes a whole number, 0 to 2^64 - 1";
    fault.seed = *seed;
  } else {
    return quoted + ": a fault takes at=SECONDS, p=PROBABILITY, n=COUNT and seed=N";
  }
  return {};
}

}  // namespace

std::span<const FaultInfo, kFaultKinds> faults() noexcept { return kFaults; }

ParsedFault parse_fault(std::string_view text) {
  const std::size_t name_end = std::min(text.find(','), text.size());
  const std::string_view name = text.substr(0, name_end);
  const auto found = std::find_if(kFaults.begin(), kFaults.end(),
                                  [name](const FaultInfo& info) { return info.name == name; });
  if (found == kFaults.end()) {
    return {std::nullopt, "'" + std::string(name) + "': there is no such fault", true};
  }
  FaultSpec fault = found->usual;
  for (std::size_t at = name_end; at < text.size();) {
    const std::size_t end = std::min(text.find(',', at + 1), text.size());
    if (std::string error = apply(text.substr(at + 1, end - at - 1), fault); !error.empty()) {
      return wrong(std::move(error));
    }
    at = end;
  }
  return {fault, {}, false};
}

}  // namespace limn::firmware
