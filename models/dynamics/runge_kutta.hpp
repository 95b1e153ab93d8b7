// The classical Runge-Kutta method of fourth order, for any scalar.
#pragma once

namespace qsmpc::models {

/// next = x + h (k₁ + 2k₂ + 2k₃ + k₄)/6 for ẋ = derivative(x), one step of h = time_step (s).
/// derivative(const Scalar* x, Scalar* slope); all arrays have `kDim` entries; `next` may be `x`.
template <int kDim, class Scalar, class Derivative>
void runge_kutta_step(const Derivative& derivative, const Scalar* x, double time_step,
                      Scalar* next) {
  Scalar first[kDim];
  Scalar second[kDim];
  Scalar third[kDim];
  Scalar fourth[kDim];
  Scalar stage[kDim];
  derivative(x, first);
  for (int i = 0; i < kDim; ++i) stage[i] = x[i] + (0.5 * time_step) * first[i];
  derivative(stage, second);
  for (int i = 0; i < kDim; ++i) stage[i] = x[i] + (0.5 * time_step) * second[i];
  derivative(stage, third);
  for (int i = 0; i < kDim; ++i) stage[i] = x[i] + time_step * third[i];
  derivative(stage, fourth);
  for (int i = 0; i < kDim; ++i) {
    next[i] = x[i] + (time_step / 6.0) * (first[i] + 2.0 * (second[i] + third[i]) + fourth[i]);
  }
}

}  // namespace qsmpc::models
