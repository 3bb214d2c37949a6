// The same reports give samples of the same bits: in every run, in any thread, replayed at any
// speed, read in pieces of any size, built by any compiler for any processor.
//
//     golden_sample_bits HASHES [SHARED]
//
// compares with the file HASHES (LIMN_UPDATE_GOLDEN=1 rewrites it) and exits with 1 where anything
// differs. SHARED is the folder of real recordings.

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "drivers/devices/motion_decoder.hpp"
#include "drivers/devices/pen_decoder.hpp"
#include "drivers/devices/trace_decoder.hpp"
#include "drivers/transport/paced_reader.hpp"
#include "firmware_sim/devices/pen_session.hpp"
#include "input/sample/sample_hash.hpp"
#include "input/trace/hid_recorder_writer.hpp"
#include "input/trace/trace.hpp"

namespace {

using namespace limn;
namespace fs = std::filesystem;

/// Samples and their hash, each device by itself: between devices a replay may have another order.
class Hash {
 public:
  template <class Sample>
  void add(const Sample& sample) {
    ++samples_;
    std::uint64_t& hash = devices_.try_emplace(sample.device, kEmptySampleHash).first->second;
    hash = hash_sample(sample, hash);
  }
  std::string text() const {
    std::uint64_t all = kEmptySampleHash;
    for (const auto& [device, hash] : devices_) {
      all = (all ^ hash) * 0x100000001B3U;
      all ^= all >> 32;
    }
    char line[64];
    std::snprintf(line, sizeof line, "%zu %016llx", samples_, static_cast<unsigned long long>(all));
    return line;
  }
  bool empty() const { return samples_ == 0; }

 private:
  std::size_t samples_ = 0;
  std::map<DeviceIndex, std::uint64_t> devices_;
};

/// A recording in memory, given in pieces of `piece` bytes at most.
class Pieces final : public ByteSource {
 public:
  Pieces(std::string_view bytes, std::size_t piece) : rest_(bytes), piece_(piece) {}
  Expected<std::size_t> read(std::span<char> out) override {
    const std::size_t count = std::min({out.size(), piece_, rest_.size()});
    std::copy_n(rest_.begin(), count, out.begin());
    rest_.remove_prefix(count);
    return count;
  }

 private:
  std::string_view rest_;
  std::size_t piece_;
};

/// Passes only by being waited for.
class WaitedClock final : public WaitingClock {
 public:
  Timestamp now() noexcept override { return now_; }
  void wait_until(Timestamp time) noexcept override { now_ = std::max(now_, time); }

 private:
  Timestamp now_{};
};

struct Ids {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
};

struct Way {
  std::size_t piece = 65536;
  double speed = 0;  // 0: at once
};

Hash decode(std::string_view recording, Ids ids, Way way) {
  TraceOptions options;
  options.salvage = true;
  options.supplied.vendor = ids.vendor;
  options.supplied.product = ids.product;
  Hash hash;
  auto reader = open_trace(std::make_unique<Pieces>(recording, way.piece), std::move(options));
  if (!reader) return hash;
  WaitedClock clock;
  std::unique_ptr<TraceReader> paced = std::move(*reader);
  if (way.speed > 0) paced = std::make_unique<PacedReader>(std::move(paced), way.speed, clock);
  TraceDecoder decoder(std::move(paced), {.salvage = true});
  for (;;) {
    const auto sample = decoder.next_any();
    if (!sample || std::holds_alternative<std::monostate>(*sample)) return hash;
    if (const auto* const pen = std::get_if<const PenSample*>(&*sample)) {
      hash.add(**pen);
    } else {
      hash.add(*std::get<const MotionSample*>(*sample));
    }
  }
}

std::string simulated(const firmware::Drawing& drawing) {
  const auto descriptor = firmware::HidPen::report_descriptor();
  TraceDevice device;
  device.name = firmware::HidPen::kIdentity.name;
  device.vendor = firmware::HidPen::kIdentity.vendor;
  device.product = firmware::HidPen::kIdentity.product;
  device.report_descriptor.assign(descriptor.begin(), descriptor.end());
  StringSink sink;
  HidRecorderWriter writer(sink);
  bool written = writer.describe(device).has_value();
  firmware::PenSession session(drawing, 1);
  for (firmware::TimedReport report; written && session.next(report);) {
    written = writer.write(Report{0, report.time, report.bytes}).has_value();
  }
  return std::string(sink.text());
}

/// Invented bytes: splitmix64.
class Bytes {
 public:
  explicit Bytes(std::uint64_t seed) : state_(kStep + seed) {}
  std::uint8_t operator()() {
    state_ += kStep;
    std::uint64_t z = state_;
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9U;
    z = (z ^ z >> 27) * 0x94D049BB133111EBU;
    return static_cast<std::uint8_t>(z >> 56);
  }

 private:
  static constexpr std::uint64_t kStep = 0x9E3779B97F4A7C15U;
  std::uint64_t state_;
};

/// Reports of invented bytes to a decoder of every row of 3D mice.
Hash decode_3d_mice() {
  Bytes byte(1000);
  Hash hash;
  DeviceIndex index = 0;
  for (const MotionSpec& row : motion_specs()) {
    auto decoder = MotionDecoder::make(row.vendor, row.product, {});
    if (!decoder) continue;
    std::array<std::uint8_t, 16> report{};
    for (int i = 0; i < 400; ++i) {
      constexpr std::array<std::uint8_t, 8> kIds = {1, 2, 1, 2, 3, 0x17, 0x1C, 9};
      for (std::uint8_t& b : report) b = byte();
      report[0] = kIds[byte() % kIds.size()];
      const std::size_t length = std::array<std::size_t, 4>{3, 7, 13, 16}[byte() % 4U];
      const Timestamp time = std::chrono::milliseconds(i * 8 + (i / 50) * 200);
      const Report made{index, time, std::span(report).first(length)};
      for (const MotionSample& sample : decoder->decode(made).samples) hash.add(sample);
    }
    ++index;
  }
  return hash;
}

/// Reports of invented bytes to a decoder of every row of `family`.
Hash decode_rows(PenFamily family) {
  Bytes byte(static_cast<std::uint64_t>(family));
  Hash hash;
  DeviceIndex index = 0;
  for (const PenSpec& row : pen_specs()) {
    if (row.family != family) continue;
    PenIdentity identity;
    identity.vendor = row.vendor;
    identity.product = row.product;
    identity.product_name = row.product_name;
    identity.firmware = row.firmware;
    identity.descriptor_bytes = row.descriptor_bytes;
    auto decoder = PenDecoder::make(identity, {});
    if (!decoder) continue;
    std::array<std::uint8_t, 64> report{};
    for (int i = 0; i < 400; ++i) {
      // Report IDs and flags that are too rare by chance.
      constexpr std::array<std::uint8_t, 8> kIds = {0x02, 0x10, 0x07, 0x08, 0x09, 0x0A, 0x03, 0x01};
      constexpr std::array<std::uint8_t, 8> kFlags = {0xE0, 0xA0, 0xC2, 0x80,
                                                      0x81, 0x90, 0x91, 0x41};
      for (std::uint8_t& b : report) b = byte();
      report[0] = row.report_id != 0 && i % 2 == 0 ? row.report_id : kIds[byte() % kIds.size()];
      if (i % 3 != 0) report[1] = kFlags[byte() % kFlags.size()];
      const std::size_t length = std::array<std::size_t, 6>{8, 9, 10, 12, 14, 64}[byte() % 6U];
      const Timestamp time = std::chrono::milliseconds(i * 5);
      const Report made{index, time, std::span(report).first(length)};
      for (const PenSample& sample : decoder->decode(made).samples) hash.add(sample);
    }
    ++index;
  }
  return hash;
}

struct Case {
  std::string name;
  std::function<Hash(Way)> run;
};

/// Ids of the tablets whose dumps have none, by their folders.
const std::map<std::string, Ids, std::less<>>& dumped_tablets() {
  static const std::map<std::string, Ids, std::less<>> tablets = {
      {"Huion_K26", {0x256C, 0x006E}},
      {"Huion_New_1060_Plus", {0x256C, 0x006E}},
      {"Huion_W58", {0x256C, 0x006E}},
      {"KYE_PenSketch_M912", {0x0458, 0x5015}},
      {"Ugee_M708_v2", {0x28BD, 0x0907}},
      {"VEIKK_A30", {0x2FEB, 0x0002}},
      {"XP-Pen_Deco_01_v2_revb", {0x28BD, 0x0905}},
      {"XP-Pen_Star_06", {0x28BD, 0x0078}}};
  return tablets;
}

void add_recordings(const fs::path& traces, std::vector<Case>& cases) {
  std::vector<fs::path> files;
  for (const char* folder : {"pens", "pens-evemu", "pens-kernel-oracle", "pens-usbhid-dump"}) {
    if (!fs::is_directory(traces / folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(traces / folder)) {
      if (entry.is_regular_file()) files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    Ids ids;
    for (const fs::path& part : file) {
      const auto known = dumped_tablets().find(part.string());
      if (known != dumped_tablets().end()) ids = known->second;
    }
    std::ifstream in(file, std::ios::binary);
    auto bytes = std::make_shared<const std::string>(std::istreambuf_iterator<char>(in),
                                                     std::istreambuf_iterator<char>());
    cases.push_back({fs::relative(file, traces).generic_string(),
                     [bytes, ids](Way way) { return decode(*bytes, ids, way); }});
  }
}

std::vector<Case> all_cases(const fs::path& shared) {
  std::vector<Case> cases;
  for (const firmware::DrawingInfo& info : firmware::drawings()) {
    auto bytes = std::make_shared<const std::string>(simulated(*firmware::find_drawing(info.name)));
    cases.push_back({"simulated/" + std::string(info.name),
                     [bytes](Way way) { return decode(*bytes, {}, way); }});
  }
  for (unsigned i = 0; i < kPenFamilyCount; ++i) {
    const auto family = static_cast<PenFamily>(i);
    std::string label(name(family));
    std::replace(label.begin(), label.end(), ' ', '_');
    cases.push_back({"rows/" + label, [family](Way) { return decode_rows(family); }});
  }
  cases.push_back({"rows/3D_mice", [](Way) { return decode_3d_mice(); }});
  if (shared.empty() || !fs::exists(shared / "traces/README.md")) {
    std::printf("real recordings are absent (%s): only the simulated pen and the tables' rows\n",
                (shared / "traces").string().c_str());
  } else {
    add_recordings(shared / "traces", cases);
  }
  return cases;
}

std::map<std::string, std::string> read_golden(const fs::path& path) {
  std::map<std::string, std::string> golden;  // name -> "samples hash"
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string samples, hash, name;
    if (words >> samples >> hash && std::getline(words >> std::ws, name)) {
      golden[name] = samples + ' ' + hash;
    }
  }
  return golden;
}

class Checks {
 public:
  void equal(const std::string& found, const std::string& wanted, const std::string& what) {
    ++count_;
    if (found == wanted) return;
    ++failed_;
    std::printf("%s: %s where %s is right\n", what.c_str(), found.c_str(), wanted.c_str());
  }
  int report() const {
    std::printf("%d comparisons, %d differ\n", count_, failed_);
    return failed_ == 0 && count_ > 0 ? EXIT_SUCCESS : EXIT_FAILURE;
  }

 private:
  int count_ = 0;
  int failed_ = 0;
};

}  // namespace

int main(int count, char** arguments) {
  if (count < 2) {
    std::fprintf(stderr, "usage: golden_sample_bits HASHES [SHARED]\n");
    return 2;
  }
  const fs::path golden_file = arguments[1];
  std::vector<Case> cases = all_cases(count > 2 ? fs::path(arguments[2]) : fs::path());
  auto golden = read_golden(golden_file);

  Checks checks;
  std::vector<std::string> found;
  std::vector<Case> decoded;
  for (Case& tested : cases) {
    const Hash hash = tested.run({});
    if (hash.empty()) {  // a folder's descriptors and notes
      checks.equal("no samples", golden.contains(tested.name) ? "samples" : "no samples",
                   tested.name);
      continue;
    }
    found.push_back(hash.text());
    decoded.push_back(std::move(tested));
  }

  if (std::getenv("LIMN_UPDATE_GOLDEN") != nullptr) {
    for (std::size_t i = 0; i < decoded.size(); ++i) golden[decoded[i].name] = found[i];
    std::ofstream out(golden_file);
    for (const auto& [name, hash] : golden) out << hash << ' ' << name << '\n';
    std::printf("%zu cases written\n", golden.size());
    return out.good() ? EXIT_SUCCESS : EXIT_FAILURE;
  }

  for (std::size_t i = 0; i < decoded.size(); ++i) {
    const Case& tested = decoded[i];
    const auto known = golden.find(tested.name);
    if (known != golden.end()) checks.equal(found[i], known->second, tested.name);
    checks.equal(tested.run({}).text(), found[i], tested.name + ", run again");
    checks.equal(tested.run({1, 0}).text(), found[i], tested.name + ", read byte by byte");
    checks.equal(tested.run({4093, 0}).text(), found[i], tested.name + ", read in pieces");
    for (const double speed : {0.01, 1.0, 3.7, 1e6}) {
      checks.equal(tested.run({65536, speed}).text(), found[i],
                   tested.name + ", replayed at " + std::to_string(speed));
    }
  }

  constexpr std::size_t kThreads = 4;
  std::array<std::vector<std::string>, kThreads> of_thread;
  std::vector<std::thread> threads;
  for (std::vector<std::string>& results : of_thread) {
    threads.emplace_back([&decoded, &results] {
      for (const Case& tested : decoded) results.push_back(tested.run({}).text());
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (std::size_t t = 0; t < kThreads; ++t) {
    for (std::size_t i = 0; i < decoded.size(); ++i) {
      checks.equal(of_thread[t][i], found[i], decoded[i].name + ", in thread " + std::to_string(t));
    }
  }
  std::printf("%zu cases\n", decoded.size());
  return checks.report();
}
