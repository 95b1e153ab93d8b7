// The standard normal distribution for vectors; see models/simd/lanes-inl.hpp.

// One inclusion for each instruction set.
#if defined(QSMPC_NORMAL_CDF_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef QSMPC_NORMAL_CDF_INL_HPP
#undef QSMPC_NORMAL_CDF_INL_HPP
#else
#define QSMPC_NORMAL_CDF_INL_HPP
#endif

#include "models/simd/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace qsmpc::controller {
namespace HWY_NAMESPACE {

using namespace models::HWY_NAMESPACE;

/// e^x for −50 ≤ x ≤ 0, to about one unit in the last place.
HWY_INLINE Vector exponential_of_negative(Vector x) {
  constexpr double kLog2E = 1.4426950408889634074;
  constexpr double kLn2High = 6.93147180369123816490e-01;  // products with integers are exact
  constexpr double kLn2Low = 1.90821492927058770002e-10;
  constexpr double kRounder = 0x1.8p52;  // adding it rounds to an integer, in the lowest bits
  // 1/n!: the rest of the series is below 5e-18 on |r| ≤ ½ ln 2.
  constexpr double kInverseFactorials[] = {1.0,
                                           1.0,
                                           1.0 / 2.0,
                                           1.0 / 6.0,
                                           1.0 / 24.0,
                                           1.0 / 120.0,
                                           1.0 / 720.0,
                                           1.0 / 5040.0,
                                           1.0 / 40320.0,
                                           1.0 / 362880.0,
                                           1.0 / 3628800.0,
                                           1.0 / 39916800.0,
                                           1.0 / 479001600.0,
                                           1.0 / 6227020800.0};
  const VectorTag d;
  const hn::RebindToUnsigned<VectorTag> bits;
  const Vector shifted = x * constant(kLog2E) + constant(kRounder);
  const Vector multiple = shifted - constant(kRounder);
  const Vector r = (x - multiple * constant(kLn2High)) - multiple * constant(kLn2Low);
  const Vector value = polynomial(r, kInverseFactorials);
  // Times 2^multiple, by adding to the exponent.
  const auto exponent = hn::ShiftLeft<52>(hn::BitCast(bits, shifted));
  return hn::BitCast(d, hn::Add(hn::BitCast(bits, value), exponent));
}

struct NormalValues {
  Vector probability;  ///< Φ(z)
  Vector density;      ///< φ(z)
};

/// Φ and φ, to an absolute error below 1e-15; beyond |z| = 8.3, Φ is taken as 0 or 1 and φ as 0.
/// Φ(−z)/φ(z) is Hart's rational approximation 5666 ("Computer Approximations", 1968).
HWY_INLINE NormalValues normal_values(Vector z) {
  constexpr double kBeyond = 8.3;
  constexpr double kInverseRootTwoPi = 0.39894228040143267794;
  constexpr double kNumerator[] = {220.206867912376,    221.213596169931, 112.079291497871,
                                   33.912866078383,     6.37396220353165, 0.700383064443688,
                                   3.52624965998911e-02};
  constexpr double kDenominator[] = {440.413735824752, 793.826512519948,    637.333633378831,
                                     296.564248779674, 86.7807322029461,    16.064177579207,
                                     1.75566716318264, 8.83883476483184e-02};
  const Vector size = hn::Min(hn::Abs(z), constant(kBeyond));
  const Mask inside = hn::Lt(size, constant(kBeyond));
  const Vector bell = exponential_of_negative(constant(-0.5) * size * size);
  const Vector ratio = polynomial(size, kNumerator) / polynomial(size, kDenominator);
  const Vector tail = hn::IfThenElseZero(inside, bell * ratio);
  return {hn::IfThenElse(hn::Lt(z, zeros()), tail, constant(1.0) - tail),
          hn::IfThenElseZero(inside, bell * constant(kInverseRootTwoPi))};
}

}  // namespace HWY_NAMESPACE
}  // namespace qsmpc::controller
HWY_AFTER_NAMESPACE();

#endif
