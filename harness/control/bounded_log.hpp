// The output of a process; only the beginning and the end of a long one are kept.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace qsmpc::harness {

class BoundedLog {
 public:
  /// Keeps about `half` bytes of the beginning, and as many of the end.
  explicit BoundedLog(std::size_t half) : half_(half) {}

  void add(std::string_view text);
  void clear();

  /// The text; if bytes were left out, with a line that states how many.
  [[nodiscard]] std::string text() const;
  /// The last line that is not blank; empty without one.
  [[nodiscard]] std::string last_line() const;

 private:
  std::size_t half_;
  std::string begin_;
  std::string end_;
  std::size_t left_out_ = 0;
};

}  // namespace qsmpc::harness
