#include "harness/text/number_format.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>

#include <fmt/format.h>

namespace qsmpc::harness {
namespace {

constexpr int kSmallestPlain = -3;  // least exponent of a plain decimal
constexpr int kLargestPlain = 5;
constexpr const char* kMinus = "−";
constexpr double kLeastPlainInTable = 1e-2;  // keeps two digits with three or four decimals
constexpr double kEndOfPlainInTable = 1e4;   // keeps a column of nine characters

std::string with_minus_sign(const std::string& digits) {
  return digits.starts_with('-') ? kMinus + digits.substr(1) : digits;
}

std::string superscript(int value) {
  constexpr std::array<const char*, 10> kSuperscripts = {"⁰", "¹", "²", "³", "⁴",
                                                         "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = value < 0 ? "⁻" : "";
  for (const char digit : std::to_string(std::abs(value))) text += kSuperscripts.at(digit - '0');
  return text;
}

std::string not_finite(double value) {
  if (std::isnan(value)) return "not a number";
  return value > 0.0 ? "∞" : std::string(kMinus) + "∞";
}

}  // namespace

std::string format_number(double value, int digits) {
  if (!std::isfinite(value)) return not_finite(value);
  if (value == 0.0) return "0";
  // The rounded decimal form decides the exponent: 9.999 may become 10.0.
  const std::string scientific = fmt::format("{:.{}e}", value, digits - 1);
  const std::size_t mark = scientific.find('e');
  const int exponent = std::atoi(scientific.c_str() + mark + 1);
  if (exponent >= kSmallestPlain && exponent <= kLargestPlain) {
    return format_fixed(value, std::max(0, digits - 1 - exponent));
  }
  return with_minus_sign(scientific.substr(0, mark)) + " × 10" + superscript(exponent);
}

std::string format_short(double value, int digits) {
  std::string text = format_number(value, digits);
  const std::size_t point = text.find('.');
  if (point == std::string::npos) return text;
  const std::size_t end = std::min(text.find(' '), text.size());  // end of the decimals
  std::size_t kept = text.find_last_not_of('0', end - 1);
  if (kept == point) --kept;
  return text.erase(kept + 1, end - kept - 1);
}

std::string format_bound(double value, int digits) {
  if (!std::isfinite(value) || value <= 0.0) return format_short(value, digits);
  const double exponent = std::floor(std::log10(value)) - (digits - 1);
  const double unit = std::pow(10.0, exponent);
  if (unit == 0.0 || !std::isfinite(unit)) return format_short(value, digits);
  // A value that is a short decimal, such as 0.25, is kept although `unit` is not exact.
  constexpr double kRounding = 1e-12;
  return format_short(std::ceil(value / unit * (1.0 - kRounding)) * unit, digits);
}

std::string format_fixed(double value, int decimals) {
  if (!std::isfinite(value)) return not_finite(value);
  const std::string text = fmt::format("{:.{}f}", value, decimals);
  const bool zero = text.find_first_not_of("-0.") == std::string::npos;
  return zero && text.starts_with('-') ? text.substr(1) : with_minus_sign(text);
}

std::string format_percent(double share) {
  constexpr double kPercent = 100.0;
  constexpr double kLeast = 0.01;      // smallest value shown as a number
  constexpr double kMostBelow = 99.9;  // largest value with three digits below 100
  if (std::isnan(share)) return "-";
  const double percent = kPercent * share;
  if (percent > 0.0 && percent < kLeast) return "<0.01";
  if (percent > kMostBelow && share < 1.0) return ">99.9";
  return format_short(std::round(percent / kLeast) * kLeast);
}

bool is_plain_in_table(double value) {
  const double size = std::abs(value);
  return size == 0.0 || (size >= kLeastPlainInTable && size < kEndOfPlainInTable);
}

std::string format_power_of_ten(int exponent) {
  if (exponent == 0) return "1";
  if (exponent == 1) return "10";
  return "10" + superscript(exponent);
}

}  // namespace qsmpc::harness
