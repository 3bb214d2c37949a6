#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <thread>
#include <vector>

#include "modeler/base/paged_array.hpp"

namespace limn {
namespace {

std::vector<double> ramp(std::size_t count) {
  std::vector<double> values(count);
  std::iota(values.begin(), values.end(), 1.0);
  return values;
}

constexpr std::size_t kPage = PagedArray::kPageSize;
constexpr std::size_t kBlock = kPage * PagedArray::kPagesPerBlock;
constexpr std::size_t kGroup = kBlock * PagedArray::kBlocksPerGroup;

TEST(PagedArray, HoldsWhatItIsGiven) {
  for (const std::size_t count :
       {std::size_t{0}, std::size_t{1}, kPage - 1, kPage, kPage + 1, kBlock, kBlock + 1,
        2 * kBlock + 5, kGroup, kGroup + kBlock + 1}) {
    const auto values = ramp(count);
    const PagedArray array(values);
    EXPECT_EQ(array.size(), count);
    EXPECT_EQ(array.to_vector(), values);
    for (std::size_t i = 0; i < count; i += 97) EXPECT_EQ(array[i], values[i]);
  }
}

TEST(PagedArray, IsGeneratedPageByPage) {
  std::size_t next = 0;
  const std::size_t count = kGroup + 2 * kPage + 7;
  const auto array = PagedArray::generate(count, [&next](std::size_t i, std::span<double> out) {
    EXPECT_EQ(i, next);
    next += out.size();
    std::iota(out.begin(), out.end(), static_cast<double>(i) + 1);
  });
  EXPECT_EQ(next, count);
  EXPECT_EQ(array, PagedArray(ramp(count)));
}

TEST(PagedArray, ReadsOverTheEdgesOfPages) {
  const PagedArray array(ramp(3 * kPage + 5));
  std::vector<double> out(2 * kPage + 2);
  array.read(kPage - 1, out);
  for (std::size_t i = 0; i < out.size(); ++i) {
    ASSERT_EQ(out[i], static_cast<double>(kPage + i));
  }
  EXPECT_EQ(array.rest_of_page(kPage + 1).size(), kPage - 1);
  EXPECT_EQ(array.rest_of_page(3 * kPage + 2).size(), 3U) << "the last page is short";
  EXPECT_EQ(array.rest_of_page(3 * kPage + 2).front(), 3 * kPage + 3);
}

TEST(PagedArray, RunsGoOverTheEdgeOfAPage) {
  const PagedArray array(ramp(3 * kPage));
  std::vector<double> scratch(16 + PagedArray::kPadding);
  const double* inside = array.run(kPage - 16, 16, scratch.data());
  EXPECT_NE(inside, scratch.data()) << "no copy within a page";
  EXPECT_EQ(inside[15], kPage);
  for (std::size_t begin = kPage - 15; begin < kPage; ++begin) {
    const double* run = array.run(begin, 16, scratch.data());
    ASSERT_EQ(run, scratch.data());
    for (std::size_t i = 0; i < 16; ++i) EXPECT_EQ(run[i], static_cast<double>(begin + i + 1));
  }
}

TEST(PagedArray, AWriteCopiesTheTouchedPagesOnly) {
  const PagedArray before(ramp(2 * kBlock));
  const std::size_t pages = 2 * PagedArray::kPagesPerBlock;
  PagedArray after = before;
  EXPECT_EQ(after.count_shared_pages(before), pages);
  after.write(kPage + 3, std::vector{-1.0});
  EXPECT_EQ(after.count_shared_pages(before), pages - 1);
  EXPECT_EQ(before[kPage + 3], kPage + 4);
  EXPECT_EQ(after[kPage + 3], -1);
  EXPECT_NE(before, after);
  after.write(kPage + 4, std::vector{-2.0});
  EXPECT_EQ(after.count_shared_pages(before), pages - 1) << "its own page is written in place";
  after.write(kBlock - 1, std::vector{-3.0, -4.0});
  EXPECT_EQ(after.count_shared_pages(before), pages - 3) << "over a block's edge";
  EXPECT_EQ(after[kBlock], -4);
  after.write(kPage + 3, std::vector<double>{kPage + 4, kPage + 5});
  after.write(kBlock - 1, std::vector<double>{kBlock, kBlock + 1});
  EXPECT_EQ(before, after) << "equal values, whatever is shared";
}

// ThreadSanitizer watches this one: a viewer reads copies while an editor writes its own.
TEST(PagedArray, AViewerReadsWhileAnEditorWrites) {
  PagedArray edited(ramp(4 * kPage));
  for (int round = 0; round < 200; ++round) {
    const PagedArray snapshot = edited;
    double sum = 0;
    std::thread viewer([&snapshot, &sum] {
      for (std::size_t i = 0; i < snapshot.size(); i += 64) sum += snapshot[i];
    });
    const double expected = [&] {
      double all = 0;
      for (std::size_t i = 0; i < edited.size(); i += 64) all += edited[i];
      return all;
    }();
    edited.write(static_cast<std::size_t>(round) * 16, std::vector<double>(16, round));
    viewer.join();
    EXPECT_EQ(sum, expected) << "round " << round;
  }
}

}  // namespace
}  // namespace limn
