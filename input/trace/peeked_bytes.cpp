#include "input/trace/peeked_bytes.hpp"

#include <algorithm>
#include <cstring>

namespace limn {

Expected<bool> PeekedBytes::grow() {
  constexpr std::size_t kStep = std::size_t{64} * 1024;
  while (!ended_ && window_.size() < kWindowBytes) {
    const std::size_t old = window_.size();
    window_.resize(std::min(old + kStep, kWindowBytes));
    const auto count = inner_->read(std::span(window_).subspan(old));
    if (!count) {
      window_.resize(old);
      return tl::unexpected(count.error());
    }
    window_.resize(old + *count);
    ended_ = *count == 0;
    if (old == 0) {
      const auto content =
          std::find_if(window_.begin(), window_.end(), [](char c) { return c != 0; });
      leading_nuls_ += static_cast<std::uint64_t>(content - window_.begin());
      window_.erase(window_.begin(), content);
    }
    if (window_.size() > old) return true;
  }
  return false;
}

Expected<std::size_t> PeekedBytes::read(std::span<char> out) {
  if (nuls_given_ < leading_nuls_) {
    const auto count =
        static_cast<std::size_t>(std::min<std::uint64_t>(out.size(), leading_nuls_ - nuls_given_));
    std::memset(out.data(), 0, count);
    nuls_given_ += count;
    return count;
  }
  if (given_ < window_.size()) {
    const std::size_t count = std::min(out.size(), window_.size() - given_);
    std::memcpy(out.data(), window_.data() + given_, count);
    given_ += count;
    if (given_ == window_.size()) {
      window_ = {};  // it has served
      given_ = 0;
    }
    return count;
  }
  if (ended_) return std::size_t{0};
  return inner_->read(out);
}

}  // namespace limn
