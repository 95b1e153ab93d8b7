// Numbers as people read them: a true minus sign, powers of ten written out, no false digits.
#pragma once

#include <string>

namespace qsmpc::harness {

/// `value` with `digits` significant digits; very large and very small ones as "1.2 × 10⁻⁵".
/// What is not finite is "∞", "−∞" or "not a number".
[[nodiscard]] std::string format_number(double value, int digits = 3);

/// As format_number, without zeros at the end of the decimals.
[[nodiscard]] std::string format_short(double value, int digits = 3);

/// As format_short, rounded away from zero: what is shown of an upper bound is still one.
/// value ≥ 0.
[[nodiscard]] std::string format_bound(double value, int digits = 3);

/// `value` with `decimals` digits after the point.
[[nodiscard]] std::string format_fixed(double value, int decimals);

/// A share of something, 0 to 1, in percent without the sign, with three significant digits and at
/// most two decimals: "0" and "100" only for exactly 0 and 1, else "<0.01" and ">99.9" next to
/// them;
/// "-" for what is not a number.
[[nodiscard]] std::string format_percent(double share);

/// Whether a table shows `value` as a plain decimal: zero, or of a size from 0.01 to below 10 000.
/// Others, and what is not a number, take an exponent there or a mark.
[[nodiscard]] bool is_plain_in_table(double value);

/// "10⁻⁵".
[[nodiscard]] std::string format_power_of_ten(int exponent);

}  // namespace qsmpc::harness
