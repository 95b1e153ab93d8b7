// Numbers formatted for people: a true minus sign, powers of ten written out, no spurious digits.
#pragma once

#include <string>

namespace qsmpc::harness {

/// `value` with `digits` significant digits; very large and very small values as "1.2 × 10⁻⁵".
/// Non-finite values are "∞", "−∞" or "not a number".
[[nodiscard]] std::string format_number(double value, int digits = 3);

/// As format_number, without trailing zeros after the decimal point.
[[nodiscard]] std::string format_short(double value, int digits = 3);

/// As format_short, rounded up, so that a displayed upper bound is still one. value ≥ 0.
[[nodiscard]] std::string format_bound(double value, int digits = 3);

/// `value` with `decimals` digits after the decimal point.
[[nodiscard]] std::string format_fixed(double value, int decimals);

/// A share from 0 to 1 in percent, without the percent sign, with three significant digits and at
/// most two decimals. "0" and "100" stand only for exactly 0 and 1; values close to them are
/// "<0.01" and ">99.9". NaN is "-".
[[nodiscard]] std::string format_percent(double share);

/// Whether a table shows `value` as a plain decimal: zero, or an absolute value from 0.01 to below
/// 10 000. A table shows others with an exponent, and NaN as a mark.
[[nodiscard]] bool is_plain_in_table(double value);

/// "10⁻⁵".
[[nodiscard]] std::string format_power_of_ten(int exponent);

}  // namespace qsmpc::harness
