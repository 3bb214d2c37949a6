#include "input/trace_import/guarded_text.hpp"

#include <algorithm>

namespace limn {

GuardedText::int_type GuardedText::underflow() {
  if (gptr() < egptr()) return traits_type::to_int_type(*gptr());
  if (error_ || stopped_) return traits_type::eof();
  auto count = bytes_->read(buffer_);
  if (!count) {
    error_ = std::move(count.error());
    return traits_type::eof();
  }
  const std::size_t size = fit(*count);
  if (size == 0) return traits_type::eof();
  setg(buffer_.data(), buffer_.data(), buffer_.data() + size);
  return traits_type::to_int_type(buffer_[0]);
}

std::size_t GuardedText::fit(std::size_t size) {
  const std::string place = "line ";
  for (std::size_t i = 0; i < size; ++i) {
    const char c = buffer_[i];
    if (c == '\0') {
      error_ = Error{ErrorCode::kSyntax, place + std::to_string(line_), "a NUL byte in the text",
                     "add --salvage to keep what stands before it"};
      return i;
    }
    take(c);
    if (depth_ > kMostNesting) {
      error_ = Error{ErrorCode::kLimit, place + std::to_string(line_),
                     "brackets are nested deeper than " + std::to_string(kMostNesting),
                     "this is no recording; give what libinput record wrote"};
      return i;
    }
    if (++taken_ > most_bytes_) {
      error_ = Error{ErrorCode::kLimit, place + std::to_string(line_),
                     "the file is longer than " + std::to_string(most_bytes_ >> 20) + " MB",
                     "record for a shorter time, or add --salvage to keep what stands before"};
      return i;
    }
  }
  return size;
}

void GuardedText::take(char c) noexcept {
  const bool after_blank = before_ == ' ' || before_ == '\t' || before_ == '\n';
  const bool begins = after_blank || before_ == '[' || before_ == '{' || before_ == ',';
  switch (in_) {
    case In::kPlain:
      if (c == '"' && begins) in_ = In::kDouble;
      if (c == '\'' && begins) in_ = In::kSingle;
      if (c == '#' && after_blank) in_ = In::kComment;
      if (c == '[' || c == '{') ++depth_;
      if (c == ']' || c == '}') depth_ = std::max(0, depth_ - 1);
      break;
    case In::kDouble:
      if (c == '\\') in_ = In::kDoubleEscape;
      if (c == '"') in_ = In::kPlain;
      break;
    case In::kDoubleEscape:
      in_ = In::kDouble;
      break;
    case In::kSingle:
      if (c == '\'') in_ = In::kPlain;
      break;
    case In::kComment:
      if (c == '\n') in_ = In::kPlain;
      break;
  }
  if (c == '\n') ++line_;
  before_ = c;
}

}  // namespace limn
