#include "firmware_sim/devices/faulty_device.hpp"

#include <algorithm>

#include "firmware_sim/devices/sensor_noise.hpp"

namespace limn::firmware {
namespace {

using K = FaultKind;

/// SplitMix64, see SensorNoise.
std::uint64_t random_bits(std::uint64_t& state) noexcept {
  state += 0x9E3779B97F4A7C15U;
  return noise_seed(0, state);
}

std::size_t random_below(std::uint64_t& state, std::size_t end) noexcept {
  return static_cast<std::size_t>(random_bits(state) % end);
}

bool chance(std::uint64_t& state, double probability) noexcept {
  constexpr double kStep = 1.0 / (std::uint64_t{1} << 53);
  return static_cast<double>(random_bits(state) >> 11) * kStep < probability;
}

bool is_of_device(FaultKind kind) noexcept {
  return kind == K::kTimeout || kind == K::kUnplug || kind == K::kModeChange ||
         kind == K::kTimeJump;
}

}  // namespace

FaultyDevice::FaultyDevice(BusDevice& device, std::span<const FaultSpec> faults) : device_(device) {
  for (const FaultSpec& spec : faults) {
    faults_.push_back(
        {spec, noise_seed(spec.seed, static_cast<std::uint64_t>(spec.kind)), spec.at, 0});
  }
}

bool FaultyDevice::strikes(Armed& fault, std::chrono::microseconds now) noexcept {
  if (now < fault.spec.at || (fault.spec.count > 0 && fault.done >= fault.spec.count)) return false;
  if (!chance(fault.random, fault.spec.probability)) return false;
  ++fault.done;
  ++happened_[static_cast<std::size_t>(fault.spec.kind)];
  return true;
}

void FaultyDevice::happen_to_device(std::chrono::microseconds now) noexcept {
  constexpr SetupPacket kConfigure{0x00, 9, 1, 0, 0};
  for (Armed& fault : faults_) {
    if (!is_of_device(fault.spec.kind) || now < fault.next) continue;
    fault.next = now + std::chrono::seconds(1);
    if (!strikes(fault, now)) continue;
    switch (fault.spec.kind) {
      case K::kTimeout:
        dead_until_ = now + kDeadTime;
        break;
      case K::kUnplug:
        unplugged_until_ = now + kUnpluggedTime;
        break;
      case K::kModeChange:
        device_.reset();
        device_.control(kConfigure, now + shift_, {});
        break;
      default:
        shift_ += kJump;
    }
  }
}

bool FaultyDevice::plugged(std::chrono::microseconds now) noexcept {
  happen_to_device(now);
  return now >= unplugged_until_ && device_.plugged(now + shift_);
}

void FaultyDevice::reset() noexcept {
  halted_.reset();
  waiting_.clear();
  held_.reset();
  orphan_.reset();
  orphaning_ = false;
  stuck_.reset();
  batch_until_ = {};
  device_.reset();
}

TransferResult FaultyDevice::control(const SetupPacket& setup, std::chrono::microseconds now,
                                     std::span<std::uint8_t> data) noexcept {
  constexpr std::uint8_t kToEndpoint = 0x02;
  constexpr std::uint8_t kFromInterface = 0x81;
  constexpr std::uint8_t kClearFeature = 1;
  constexpr std::uint8_t kGetDescriptor = 6;
  constexpr std::uint16_t kReportDescriptor = 0x2200;
  if (!plugged(now)) return {TransferStatus::kNoDevice, 0};
  if (now < dead_until_) return {TransferStatus::kNak, 0};
  if (setup.request_type == kToEndpoint && setup.request == kClearFeature &&
      halted_ == setup.index) {
    halted_.reset();
  }
  const TransferResult result = device_.control(setup, now + shift_, data);
  if (result.status == TransferStatus::kDone && setup.request_type == kFromInterface &&
      setup.request == kGetDescriptor && setup.value == kReportDescriptor) {
    spoil_descriptor(data.first(std::min(result.bytes, data.size())));
  }
  return result;
}

/// The same each time it is read.
void FaultyDevice::spoil_descriptor(std::span<std::uint8_t> descriptor) noexcept {
  for (const Armed& fault : faults_) {
    if (fault.spec.kind != K::kHostileDescriptor) continue;
    std::uint64_t random = noise_seed(fault.spec.seed, descriptor.size());
    std::uint32_t left = fault.spec.count;
    for (std::uint8_t& byte : descriptor) {
      if (!chance(random, fault.spec.probability)) continue;
      byte = static_cast<std::uint8_t>(random_bits(random) & 0xFFU);
      ++happened_[static_cast<std::size_t>(K::kHostileDescriptor)];
      if (--left == 0) break;
    }
  }
}

TransferResult FaultyDevice::interrupt_out(std::uint8_t endpoint, std::chrono::microseconds now,
                                           std::span<const std::uint8_t> data) noexcept {
  if (!plugged(now)) return {TransferStatus::kNoDevice, 0};
  if (now < dead_until_) return {TransferStatus::kNak, 0};
  return device_.interrupt_out(endpoint, now + shift_, data);
}

TransferResult FaultyDevice::interrupt_in(std::uint8_t endpoint, std::chrono::microseconds now,
                                          std::span<std::uint8_t> data) noexcept {
  if (!plugged(now)) return {TransferStatus::kNoDevice, 0};
  if (now < dead_until_) return {TransferStatus::kNak, 0};
  if (halted_ == endpoint) return {TransferStatus::kStall, 0};
  std::size_t bytes = 0;
  if (take_waiting(endpoint, now, data, bytes)) return {TransferStatus::kDone, bytes};
  for (;;) {
    const TransferResult result = device_.interrupt_in(endpoint, now + shift_, data);
    if (result.status != TransferStatus::kDone) {
      if (take_late(endpoint, now, data, bytes)) return {TransferStatus::kDone, bytes};
      return result;
    }
    bytes = std::min(result.bytes, data.size());
    switch (happen_to_report(endpoint, now, data, bytes)) {
      case Fate::kGiven:
        if (held_ && held_->endpoint == endpoint) {
          waiting_.push_front(*std::move(held_));
          held_.reset();
        }
        return {TransferStatus::kDone, bytes};
      case Fate::kTaken:
        continue;
      case Fate::kHalted:
        return {TransferStatus::kStall, 0};
    }
  }
}

bool FaultyDevice::take_waiting(std::uint8_t endpoint, std::chrono::microseconds now,
                                std::span<std::uint8_t> data, std::size_t& bytes) noexcept {
  const auto found = std::find_if(waiting_.begin(), waiting_.end(), [&](const Waiting& one) {
    return one.endpoint == endpoint && one.due <= now;
  });
  if (found == waiting_.end()) return false;
  bytes = std::min(found->bytes.size(), data.size());
  std::copy_n(found->bytes.begin(), bytes, data.begin());
  waiting_.erase(found);
  return true;
}

/// What a pause brings out: a report that waits for one behind it, the last one of an approach.
bool FaultyDevice::take_late(std::uint8_t endpoint, std::chrono::microseconds now,
                             std::span<std::uint8_t> data, std::size_t& bytes) noexcept {
  constexpr std::chrono::milliseconds kPause{50};
  for (std::optional<Waiting>* late : {&held_, &orphan_}) {
    if (!*late || (*late)->endpoint != endpoint || now - (*late)->due < kPause) continue;
    waiting_.push_back(*std::move(*late));
    late->reset();
    if (late == &orphan_) orphaning_ = false;
  }
  return take_waiting(endpoint, now, data, bytes);
}

FaultyDevice::Fate FaultyDevice::happen_to_report(std::uint8_t endpoint,
                                                  std::chrono::microseconds now,
                                                  std::span<std::uint8_t> data,
                                                  std::size_t& bytes) noexcept {
  for (Armed& fault : faults_) {
    if (is_of_device(fault.spec.kind) || fault.spec.kind == K::kHostileDescriptor) continue;
    if (!strikes(fault, now)) continue;
    const Waiting report{
        endpoint, now, {data.begin(), data.begin() + static_cast<std::ptrdiff_t>(bytes)}};
    const Fate fate = happen(fault, report, data, bytes);
    if (fate != Fate::kGiven) return fate;
  }
  if (!orphaning_ && now >= batch_until_) return Fate::kGiven;
  Waiting report{endpoint, now, {data.begin(), data.begin() + static_cast<std::ptrdiff_t>(bytes)}};
  if (orphaning_) {
    orphan_ = std::move(report);
  } else {
    report.due = batch_until_;
    waiting_.push_back(std::move(report));
  }
  return Fate::kTaken;
}

FaultyDevice::Fate FaultyDevice::happen(Armed& fault, const Waiting& report,
                                        std::span<std::uint8_t> data, std::size_t& bytes) noexcept {
  constexpr std::size_t kMostExtra = 16;
  std::uint64_t& random = fault.random;
  switch (fault.spec.kind) {
    case K::kDrop:
      return Fate::kTaken;
    case K::kDuplicate:
      waiting_.push_front(report);
      break;
    case K::kReorder:
      if (held_) break;
      held_ = report;
      return Fate::kTaken;
    case K::kShort:
      if (bytes > 1) bytes = 1 + random_below(random, bytes - 1);
      break;
    case K::kOverlong: {
      const std::size_t end = std::min(bytes + 1 + random_below(random, kMostExtra), data.size());
      for (; bytes < end; ++bytes)
        data[bytes] = static_cast<std::uint8_t>(random_bits(random) & 0xFFU);
      break;
    }
    case K::kWrongId:
      if (bytes > 0) data[0] = static_cast<std::uint8_t>(data[0] + 1 + random_below(random, 255));
      break;
    case K::kGarbage:
      for (std::size_t i = 1; i < bytes; ++i) {
        data[i] = static_cast<std::uint8_t>(random_bits(random) & 0xFFU);
      }
      break;
    case K::kStall:
      halted_ = report.endpoint;
      return Fate::kHalted;
    case K::kStuckTip:
      if (!stuck_ || stuck_->endpoint != report.endpoint) stuck_ = report;
      bytes = std::min(stuck_->bytes.size(), data.size());
      std::copy_n(stuck_->bytes.begin(), bytes, data.begin());
      break;
    case K::kOrphanExit:
      orphaning_ = true;
      break;
    case K::kBatch:
      batch_until_ = report.due + kBatchTime;
      break;
    case K::kFlood:
      waiting_.insert(waiting_.begin(), kFloodReports - 1, report);
      break;
    default:
      break;
  }
  return Fate::kGiven;
}

}  // namespace limn::firmware
