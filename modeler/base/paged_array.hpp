#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "modeler/base/shared.hpp"

namespace limn {

/// A sequence of doubles of fixed length, kept in pages that copies share until one of them writes:
///
///     root -> blocks of up to 64 pages -> pages of up to 1024 doubles
///
/// Copying an array is O(1), whatever its size. Writing a value copies the page, the block and the
/// root that other arrays share with this one, and nothing where none does. So a viewer may go on
/// reading a copy while an editor writes, and a local edit costs what it touches.
///
/// Threads: one array is as safe as an int; copies of it are independent of each other.
class PagedArray {
 public:
  static constexpr std::size_t kPageSize = 1024;  ///< doubles
  static constexpr std::size_t kPagesPerBlock = 64;
  /// Zeros that follow each page, so that vectors may be loaded at its last value.
  static constexpr std::size_t kPadding = 3;

  PagedArray() = default;
  explicit PagedArray(std::span<const double> values);

  std::size_t size() const noexcept { return size_; }
  double operator[](std::size_t i) const noexcept { return page(i)[i % kPageSize]; }

  /// Where values i to i + count - 1 lie one after another: in their page, or in `scratch`, to
  /// which they are copied if two pages hold them. What kPadding values behind them hold is
  /// undefined but may be read. Precondition: i + count <= size(), count <= kPageSize, and scratch
  /// has room for count + kPadding.
  const double* run(std::size_t i, std::size_t count, double* scratch) const noexcept {
    const std::size_t begin = i % kPageSize;
    const double* values = page(i) + begin;
    return begin + count <= kPageSize ? values : gather(i, count, scratch);
  }

  /// Writes `values` to i, i + 1, ... Precondition: i + values.size() <= size().
  void write(std::size_t i, std::span<const double> values);

  std::vector<double> to_vector() const;

  /// How many pages both hold together, not only with equal values.
  std::size_t count_shared_pages(const PagedArray& other) const noexcept;

  friend bool operator==(const PagedArray& a, const PagedArray& b) noexcept;

 private:
  struct Page : SharedCount {
    explicit Page(std::size_t count)
        : size(count), values(std::make_unique<double[]>(count + kPadding)) {}
    Page(const Page& other);
    std::size_t size;
    std::unique_ptr<double[]> values;
  };
  struct Block : SharedCount {
    std::vector<Shared<Page>> pages;
  };
  struct Root : SharedCount {
    std::vector<Shared<Block>> blocks;
  };

  const double* page(std::size_t i) const noexcept {
    const std::size_t number = i / kPageSize;
    return root_->blocks[number / kPagesPerBlock]->pages[number % kPagesPerBlock]->values.get();
  }
  const double* gather(std::size_t i, std::size_t count, double* scratch) const noexcept;

  std::size_t size_ = 0;
  Shared<Root> root_;
};

}  // namespace limn
