#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "modeler/base/shared.hpp"

namespace limn {

/// A sequence of doubles of fixed length, kept in pages that copies share until one of them writes:
///
///     root -> groups of up to 16 blocks -> blocks of up to 16 pages -> pages of up to 1024 doubles
///
/// Copying an array is O(1), whatever its size. Writing a value copies the page, the block, the
/// group and the root that other arrays share with this one, and nothing where none does. So a
/// viewer may go on reading a copy while an editor writes, and a local edit costs what it touches.
///
/// Threads: one array is as safe as an int; copies of it are independent of each other.
class PagedArray {
 public:
  static constexpr std::size_t kPageSize = 1024;  ///< doubles
  static constexpr std::size_t kPagesPerBlock = 16;
  static constexpr std::size_t kBlocksPerGroup = 16;
  /// Zeros that follow each page, so that vectors may be loaded at its last value.
  static constexpr std::size_t kPadding = 3;

  PagedArray() = default;
  explicit PagedArray(std::span<const double> values);

  /// An array of `size` values that `fill` writes, a page a call: fill(i, out) sets out[k] to value
  /// i + k. The pages come in ascending order.
  template <class Fill>
  static PagedArray generate(std::size_t size, Fill fill) {
    PagedArray array = with_room(size);
    for (std::size_t i = 0; i < size; i += kPageSize) {
      fill(i, std::span<double>(array.own_page(i), std::min(kPageSize, size - i)));
    }
    return array;
  }

  std::size_t size() const noexcept { return size_; }
  double operator[](std::size_t i) const noexcept { return page(i)[i % kPageSize]; }

  /// Value i and those that follow it in its page. Precondition: i < size().
  std::span<const double> rest_of_page(std::size_t i) const noexcept {
    const std::size_t begin = i % kPageSize;
    return {page(i) + begin, std::min(kPageSize - begin, size_ - i)};
  }

  /// Where values i to i + count - 1 lie one after another: in their page, or in `scratch`, to
  /// which they are copied if two pages hold them. What kPadding values behind them hold is
  /// undefined but may be read. Precondition: i + count <= size(), count <= kPageSize, and scratch
  /// has room for count + kPadding.
  const double* run(std::size_t i, std::size_t count, double* scratch) const noexcept {
    const std::size_t begin = i % kPageSize;
    const double* values = page(i) + begin;
    return begin + count <= kPageSize ? values : gather(i, count, scratch);
  }

  /// Asks the processor for the same values, which are read soon.
  void prefetch(std::size_t i, std::size_t count) const noexcept {
    constexpr std::size_t kLine = 8;  // doubles of a cache line
    const double* values = page(i) + i % kPageSize;
    for (std::size_t k = 0; k < count; k += kLine) __builtin_prefetch(values + k);
    __builtin_prefetch(values + count - 1);
  }

  /// Copies values i, i + 1, ... to `out`. Precondition: i + out.size() <= size().
  void read(std::size_t i, std::span<double> out) const noexcept;

  /// Writes `values` to i, i + 1, ... Precondition: i + values.size() <= size().
  void write(std::size_t i, std::span<const double> values);

  std::vector<double> to_vector() const;

  /// How many pages both hold together, not only with equal values.
  std::size_t count_shared_pages(const PagedArray& other) const noexcept;

  friend bool operator==(const PagedArray& a, const PagedArray& b) noexcept;

 private:
  /// Pages that are made together lie in one piece of memory, which lives as long as one of them.
  struct Page : SharedCount {
    Page(std::shared_ptr<double[]> piece, double* first, std::size_t count);
    Page(const Page& other);  // with memory of its own

    std::shared_ptr<double[]> memory;
    double* values;
    std::size_t size;
  };
  struct Block : SharedCount {
    std::array<Shared<Page>, kPagesPerBlock> pages;
  };
  struct Group : SharedCount {
    std::array<Shared<Block>, kBlocksPerGroup> blocks;
  };
  struct Root : SharedCount {
    std::vector<Shared<Group>> groups;
  };

  const double* page(std::size_t i) const noexcept {
    const std::size_t number = i / kPageSize;
    const std::size_t block = number / kPagesPerBlock;
    const Group& group = *root_->groups[block / kBlocksPerGroup];
    return group.blocks[block % kBlocksPerGroup]->pages[number % kPagesPerBlock]->values;
  }
  /// An array of numbers that are not set yet.
  static PagedArray with_room(std::size_t size);
  /// The page of value i, for writing.
  double* own_page(std::size_t i);
  const double* gather(std::size_t i, std::size_t count, double* scratch) const noexcept;

  std::size_t size_ = 0;
  Shared<Root> root_;
};

}  // namespace limn
