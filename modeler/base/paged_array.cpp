#include "modeler/base/paged_array.hpp"

#include <algorithm>

#include "input/base/expect.hpp"

namespace limn {

PagedArray::Page::Page(const Page& other) : SharedCount(other), size(other.size) {
  values = std::make_unique<double[]>(size + kPadding);
  std::copy_n(other.values.get(), size, values.get());
}

PagedArray::PagedArray(std::span<const double> values) : size_(values.size()) {
  if (values.empty()) return;
  auto* root = new Root;
  root_ = Shared<Root>(root);
  constexpr std::size_t kBlockSize = kPageSize * kPagesPerBlock;
  for (std::size_t b = 0; b < size_; b += kBlockSize) {
    auto* block = new Block;
    root->blocks.emplace_back(block);
    const std::size_t end = std::min(size_, b + kBlockSize);
    for (std::size_t i = b; i < end; i += kPageSize) {
      auto* page = new Page(std::min(kPageSize, end - i));
      block->pages.emplace_back(page);
      std::copy_n(values.data() + i, page->size, page->values.get());
    }
  }
}

const double* PagedArray::gather(std::size_t i, std::size_t count, double* scratch) const noexcept {
  const std::size_t first = kPageSize - i % kPageSize;
  std::copy_n(page(i) + i % kPageSize, first, scratch);
  std::copy_n(page(i + first), count - first, scratch + first);
  std::fill_n(scratch + count, kPadding, 0.0);
  return scratch;
}

void PagedArray::write(std::size_t i, std::span<const double> values) {
  LIMN_EXPECT(i + values.size() <= size_);
  while (!values.empty()) {
    const std::size_t number = i / kPageSize;
    const std::size_t begin = i % kPageSize;
    const std::size_t count = std::min(values.size(), kPageSize - begin);
    Block& block = root_.own().blocks[number / kPagesPerBlock].own();
    Page& page = block.pages[number % kPagesPerBlock].own();
    std::copy_n(values.data(), count, page.values.get() + begin);
    values = values.subspan(count);
    i += count;
  }
}

std::vector<double> PagedArray::to_vector() const {
  std::vector<double> all;
  all.reserve(size_);
  for (std::size_t i = 0; i < size_; i += kPageSize) {
    all.insert(all.end(), page(i), page(i) + std::min(kPageSize, size_ - i));
  }
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
