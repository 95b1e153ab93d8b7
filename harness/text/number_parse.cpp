#include "harness/text/number_parse.hpp"

namespace qsmpc::harness {

std::optional<double> parse_decimal(std::string_view text) {
  const bool negative = text.starts_with('-');
  if (negative || text.starts_with('+')) text.remove_prefix(1);
  // After the sign handled here, from_chars would accept a second one; it also accepts words such
  // as "infinity".
  if (text.empty() || text.find_first_not_of("0123456789.eE+-") != std::string_view::npos ||
      text.front() == '-' || text.front() == '+') {
    return std::nullopt;
  }
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stopped != end) return std::nullopt;
  return negative ? -value : value;
}

}  // namespace qsmpc::harness
