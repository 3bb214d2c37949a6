#include "input/trace/line_source.hpp"

#include <algorithm>
#include <cstring>

#include "input/trace/text.hpp"

namespace limn {

Expected<std::optional<Line>> LineSource::next() {
  if (in_long_line_) {
    const auto discarded = discard_line();
    if (!discarded) return tl::unexpected(discarded.error());
  }
  std::size_t searched = 0;
  for (;;) {
    const std::string_view rest(buffer_.data() + begin_, end_ - begin_);
    const std::size_t newline = rest.find('\n', searched);
    if (std::min(newline, rest.size()) > kMaxLineBytes) {
      Line line = cut(kMaxLineBytes, 0);
      line.too_long = in_long_line_ = true;
      return line;
    }
    if (newline != std::string_view::npos) return cut(newline, 1);
    searched = rest.size();
    const auto more = refill();
    if (!more) return tl::unexpected(more.error());
    if (*more) continue;
    if (searched == 0) return std::optional<Line>();
    Line line = cut(searched, 0);
    line.terminated = false;
    return line;
  }
}

/// Gives out buffer_[begin_, begin_ + size) and steps over it and `line_end` bytes more.
Line LineSource::cut(std::size_t size, std::size_t line_end) {
  Line line;
  line.text = std::string_view(buffer_.data() + begin_, size);
  line.number = ++number_;
  line.offset = offset_;
  begin_ += size + line_end;
  offset_ += size + line_end;
  if (line.number == 1 &&
      line.text.substr(0, text::kByteOrderMark.size()) == text::kByteOrderMark) {
    line.text.remove_prefix(text::kByteOrderMark.size());
  }
  if (!line.text.empty() && line.text.back() == '\r') line.text.remove_suffix(1);
  return line;
}

/// Steps over what is left of a line that was too long, its line end included.
Expected<void> LineSource::discard_line() {
  in_long_line_ = false;
  for (;;) {
    const std::string_view rest(buffer_.data() + begin_, end_ - begin_);
    const std::size_t newline = rest.find('\n');
    const std::size_t gone = newline == std::string_view::npos ? rest.size() : newline + 1;
    begin_ += gone;
    offset_ += gone;
    if (newline != std::string_view::npos) return {};
    const auto more = refill();
    if (!more) return tl::unexpected(more.error());
    if (!*more) return {};
  }
}

/// Reads some more behind what is there; false at the end. There is room: no more than
/// kMaxLineBytes are left over when more is wanted.
Expected<bool> LineSource::refill() {
  if (at_end_) return false;
  if (begin_ > 0) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
  }
  if (end_ == buffer_.size()) buffer_.resize(std::min(2 * buffer_.size(), kMaxBufferBytes));
  const auto count = bytes_->read(std::span(buffer_).subspan(end_));
  if (!count) return tl::unexpected(count.error());
  end_ += *count;
  at_end_ = *count == 0;
  return !at_end_;
}

}  // namespace limn
