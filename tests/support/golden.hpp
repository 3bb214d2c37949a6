#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string_view>

namespace limn::test {

/// Compares text with the recorded text in tests/golden/`relative`, byte for byte:
///
///     EXPECT_TRUE(matches_golden(text, "exchange/star.json"));
///
/// A difference is reported by its first differing line. With LIMN_UPDATE_GOLDEN=1 in the
/// environment the file is written instead and the comparison succeeds; the commit then explains
/// the difference. The folder of the file holds an ORIGIN.md that says where its cases come from.
testing::AssertionResult matches_golden(std::string_view text,
                                        const std::filesystem::path& relative);

/// The same with another root than tests/golden.
testing::AssertionResult matches_golden_in(const std::filesystem::path& root, std::string_view text,
                                           const std::filesystem::path& relative);

}  // namespace limn::test
