#include "modeler/base/paged_array.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "input/base/expect.hpp"

namespace limn {

namespace {

/// Doubles of a cache line, which pages begin with: copying one is fastest then.
constexpr std::size_t kLine = 8;
constexpr std::size_t kStride =
    (PagedArray::kPageSize + PagedArray::kPadding + kLine - 1) / kLine * kLine;

struct Piece {
  std::shared_ptr<double[]> memory;
  double* first;
};

Piece allocate(std::size_t count) {
  auto memory = std::make_shared_for_overwrite<double[]>(count + kLine);
  const auto past = reinterpret_cast<std::uintptr_t>(memory.get()) / sizeof(double) % kLine;
  double* first = memory.get() + (kLine - past) % kLine;
  return {std::move(memory), first};
}

}  // namespace

PagedArray::Page::Page(std::shared_ptr<double[]> piece, double* first, std::size_t count)
    : memory(std::move(piece)), values(first), size(count) {
  std::fill_n(values + size, kPadding, 0.0);
}

PagedArray::Page::Page(const Page& other) : SharedCount(other), size(other.size) {
  Piece piece = allocate(size + kPadding);
  memory = std::move(piece.memory);
  values = piece.first;
  std::copy_n(other.values, size + kPadding, values);
}

PagedArray PagedArray::with_room(std::size_t size) {
  PagedArray array;
  array.size_ = size;
  if (size == 0) return array;
  const Piece piece =
      allocate((size - 1) / kPageSize * kStride + (size - 1) % kPageSize + 1 + kPadding);
  auto* root = new Root;
  array.root_ = Shared<Root>(root);
  Group* group = nullptr;
  Block* block = nullptr;
  for (std::size_t number = 0; number * kPageSize < size; ++number) {
    const std::size_t in_block = number % kPagesPerBlock;
    const std::size_t in_group = number / kPagesPerBlock % kBlocksPerGroup;
    if (in_block == 0) {
      if (in_group == 0) {
        group = new Group;
        root->groups.emplace_back(group);
      }
      block = new Block;
      group->blocks[in_group] = Shared<Block>(block);
    }
    block->pages[in_block] = Shared<Page>(new Page(piece.memory, piece.first + number * kStride,
                                                   std::min(kPageSize, size - number * kPageSize)));
  }
  return array;
}

double* PagedArray::own_page(std::size_t i) {
  const std::size_t number = i / kPageSize;
  const std::size_t block_number = number / kPagesPerBlock;
  Group& group = root_.own().groups[block_number / kBlocksPerGroup].own();
  Block& block = group.blocks[block_number % kBlocksPerGroup].own();
  return block.pages[number % kPagesPerBlock].own().values;
}

PagedArray::PagedArray(std::span<const double> values)
    : PagedArray(generate(values.size(), [values](std::size_t i, std::span<double> out) {
        std::copy_n(values.data() + i, out.size(), out.data());
      })) {}

const double* PagedArray::gather(std::size_t i, std::size_t count, double* scratch) const noexcept {
  const std::size_t first = kPageSize - i % kPageSize;
  std::copy_n(page(i) + i % kPageSize, first, scratch);
  std::copy_n(page(i + first), count - first, scratch + first);
  std::fill_n(scratch + count, kPadding, 0.0);
  return scratch;
}

void PagedArray::read(std::size_t i, std::span<double> out) const noexcept {
  LIMN_EXPECT(i + out.size() <= size_);
  while (!out.empty()) {
    const std::span<const double> rest = rest_of_page(i);
    const std::size_t count = std::min(rest.size(), out.size());
    std::copy_n(rest.data(), count, out.data());
    out = out.subspan(count);
    i += count;
  }
}

void PagedArray::write(std::size_t i, std::span<const double> values) {
  LIMN_EXPECT(i + values.size() <= size_);
  while (!values.empty()) {
    const std::size_t begin = i % kPageSize;
    const std::size_t count = std::min(values.size(), kPageSize - begin);
    std::copy_n(values.data(), count, own_page(i) + begin);
    values = values.subspan(count);
    i += count;
  }
}

std::vector<double> PagedArray::to_vector() const {
  std::vector<double> all(size_);
  read(0, all);
  return all;
}

std::size_t PagedArray::count_shared_pages(const PagedArray& other) const noexcept {
  std::size_t count = 0;
  for (std::size_t i = 0; i < std::min(size_, other.size_); i += kPageSize) {
    if (page(i) == other.page(i)) ++count;
  }
  return count;
}

bool operator==(const PagedArray& a, const PagedArray& b) noexcept {
  if (a.size_ != b.size_) return false;
  for (std::size_t i = 0; i < a.size_; i += PagedArray::kPageSize) {
    const double* p = a.page(i);
    const double* q = b.page(i);
    if (p != q && !std::equal(p, p + std::min(PagedArray::kPageSize, a.size_ - i), q)) return false;
  }
  return true;
}

}  // namespace limn
