#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace limn {

/// Lock-free queue of byte records from one thread to one other, oldest first, in memory of fixed
/// size: nothing is allocated after construction, and a full ring refuses instead of waiting.
///
/// A record lies in one piece, aligned to 8 bytes:
///
///     | length, 8 bytes | payload, padded to 8 |   and, where one would run over the end,
///     | kWrap           | unused to the end    |   the record follows at the beginning.
///
/// The positions only grow (mod 2^64); the bits below the capacity are the place in the ring.
class RecordRing {
 public:
  /// Rounds the capacity, in bytes, up to a power of two of at least 64.
  explicit RecordRing(std::size_t capacity)
      : words_(std::bit_ceil(capacity < kLeast ? kLeast : capacity) / kWord) {}

  std::size_t capacity() const noexcept { return words_.size() * kWord; }

  /// Producer: room for a record of `size` bytes, to be filled before commit(); empty where the
  /// ring is full. A second call without a commit() between replaces the first.
  std::span<std::byte> reserve(std::size_t size) noexcept {
    if (size > capacity()) return {};
    const std::size_t need = kWord + padded(size);
    const std::size_t head = head_.load(std::memory_order_relaxed);
    const std::size_t to_end = capacity() - place(head);
    const std::size_t skipped = need > to_end ? to_end : 0;
    const std::size_t used = head - tail_.load(std::memory_order_acquire);
    if (skipped + need > capacity() - used) return {};
    if (skipped > 0) word(head) = kWrap;
    word(head + skipped) = size;
    reserved_ = head + skipped + need;
    return {bytes(head + skipped + kWord), size};
  }

  /// Producer: gives the reserved record to the consumer.
  void commit() noexcept { head_.store(reserved_, std::memory_order_release); }

  /// Consumer: the oldest record, in place until pop(). Empty where there is none.
  std::span<const std::byte> front() noexcept {
    const std::size_t head = head_.load(std::memory_order_acquire);
    std::size_t tail = tail_.load(std::memory_order_relaxed);
    if (tail == head) return {};
    if (word(tail) == kWrap) {
      tail += capacity() - place(tail);
      tail_.store(tail, std::memory_order_release);
    }
    return {bytes(tail + kWord), static_cast<std::size_t>(word(tail))};
  }

  /// Consumer: gives the oldest record's room back. Precondition: front() gave a record.
  void pop() noexcept {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    tail_.store(tail + kWord + padded(static_cast<std::size_t>(word(tail))),
                std::memory_order_release);
  }

 private:
  static constexpr std::size_t kWord = 8;
  static constexpr std::size_t kLeast = 64;
  static constexpr std::size_t kCacheLine = 64;
  static constexpr std::uint64_t kWrap = ~std::uint64_t{0};

  static std::size_t padded(std::size_t size) noexcept {
    return (size + kWord - 1) / kWord * kWord;
  }
  std::size_t place(std::size_t position) const noexcept { return position & (capacity() - 1); }
  std::uint64_t& word(std::size_t position) noexcept { return words_[place(position) / kWord]; }
  std::byte* bytes(std::size_t position) noexcept {
    return reinterpret_cast<std::byte*>(words_.data()) + place(position);
  }

  std::vector<std::uint64_t> words_;
  std::size_t reserved_ = 0;                               // the producer's alone
  alignas(kCacheLine) std::atomic<std::size_t> head_ = 0;  // written by the producer
  alignas(kCacheLine) std::atomic<std::size_t> tail_ = 0;  // written by the consumer
};

}  // namespace limn
