#include "harness/control/bounded_log.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace qsmpc::harness {

void BoundedLog::add(std::string_view text) {
  const std::size_t first = std::min(text.size(), half_ - begin_.size());
  begin_ += text.substr(0, first);
  end_ += text.substr(first);
  // Trimmed rarely, so that a long log is not moved for every line.
  if (end_.size() <= 2 * half_) return;
  const std::size_t cut = end_.size() - half_;
  end_.erase(0, cut);
  left_out_ += cut;
}

void BoundedLog::clear() {
  begin_.clear();
  end_.clear();
  left_out_ = 0;
}

std::string BoundedLog::text() const {
  if (left_out_ == 0) return begin_ + end_;
  return fmt::format("{}\n[… {} bytes omitted …]\n{}", begin_, left_out_, end_);
}

std::string BoundedLog::last_line() const {
  // A line may have begun in the first half.
  const std::string text = left_out_ == 0 ? begin_ + end_ : end_;
  const std::size_t last = text.find_last_not_of(" \t\r\n");
  if (last == std::string::npos) return {};
  const std::size_t line = text.find_last_of('\n', last);
  const std::size_t begin = line == std::string::npos ? 0 : line + 1;
  return text.substr(begin, last + 1 - begin);
}

}  // namespace qsmpc::harness
