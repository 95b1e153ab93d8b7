// The largest singular value of a 2 x 2 matrix, in closed form.
#pragma once

#include <algorithm>
#include <cmath>

namespace qsmpc::models {

/// Largest singular value of [[a, b], [c, d]].
[[nodiscard]] inline double spectral_norm(double a, double b, double c, double d) {
  const double sum = a * a + b * b + c * c + d * d;
  const double determinant = a * d - b * c;
  const double root = std::sqrt(std::max(0.0, sum * sum - 4.0 * determinant * determinant));
  return std::sqrt(0.5 * (sum + root));
}

}  // namespace qsmpc::models
