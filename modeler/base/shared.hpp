#pragma once

#include <atomic>
#include <utility>

namespace limn {

/// What Shared<T> points to derives from this: the number of its owners.
class SharedCount {
 public:
  SharedCount() = default;
  SharedCount(const SharedCount&) noexcept {}  // a copy has owners of its own
  SharedCount& operator=(const SharedCount&) noexcept { return *this; }

 private:
  template <class>
  friend class Shared;
  mutable std::atomic<int> owners_{0};
};

/// Shared ownership of a value that is copied before it is written: std::shared_ptr with a
/// uniqueness that threads may rely on. (shared_ptr::use_count() is a relaxed read, so a lone owner
/// would not see that the others had finished reading.)
///
/// Threads: different Shared of one value may be copied, read and dropped in different threads.
template <class T>
class Shared {
 public:
  Shared() = default;
  explicit Shared(T* value) noexcept : value_(value) { acquire(); }
  Shared(const Shared& other) noexcept : value_(other.value_) { acquire(); }
  Shared(Shared&& other) noexcept : value_(std::exchange(other.value_, nullptr)) {}
  Shared& operator=(Shared other) noexcept {
    std::swap(value_, other.value_);
    return *this;
  }
  ~Shared() {
    if (value_ != nullptr && value_->owners_.fetch_sub(1, std::memory_order_acq_rel) == 1) {
      delete value_;
    }
  }

  const T* get() const noexcept { return value_; }
  const T& operator*() const noexcept { return *value_; }
  const T* operator->() const noexcept { return value_; }
  explicit operator bool() const noexcept { return value_ != nullptr; }

  /// The value for writing, after a copy of it if others own it too. Precondition: not empty.
  T& own() {
    if (value_->owners_.load(std::memory_order_acquire) != 1) *this = Shared(new T(*value_));
    return *value_;
  }

 private:
  void acquire() const noexcept {
    if (value_ != nullptr) value_->owners_.fetch_add(1, std::memory_order_relaxed);
  }

  T* value_ = nullptr;
};

}  // namespace limn
