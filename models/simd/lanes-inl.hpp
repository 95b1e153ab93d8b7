// Vectors of doubles for the inner loops, for the instruction set being compiled.
//
// A file with such loops is compiled once per instruction set, by Highway's foreach_target; the
// best one that the processor supports is chosen at run time:
//
//   #undef HWY_TARGET_INCLUDE
//   #define HWY_TARGET_INCLUDE "models/dynamics/batch_kernels.cpp"
//   #include <hwy/foreach_target.h>
//   #include "models/simd/lanes-inl.hpp"
//
// Results are bit-identical for every choice: there are no fused multiply-adds, and sums are taken
// in kLanes interleaved parts, whatever the width of the vectors.

// One inclusion for each instruction set.
#if defined(QSMPC_SIMD_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef QSMPC_SIMD_LANES_INL_HPP
#undef QSMPC_SIMD_LANES_INL_HPP
#else
#define QSMPC_SIMD_LANES_INL_HPP
#endif

#include <cmath>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace qsmpc::models {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Interleaved parts of a sum, and the stride of the loops: the width of the widest vectors.
inline constexpr std::size_t kLanes = 8;

using VectorTag = hn::CappedTag<double, kLanes>;
using Vector = hn::Vec<VectorTag>;
using Mask = hn::Mask<VectorTag>;

/// Doubles in a vector, and vectors in kLanes.
inline constexpr std::size_t kWidth = hn::MaxLanes(VectorTag());
inline constexpr std::size_t kParts = kLanes / kWidth;

HWY_INLINE Vector constant(double value) { return hn::Set(VectorTag(), value); }
HWY_INLINE Vector zeros() { return hn::Zero(VectorTag()); }

/// Loads or stores a vector at any address; the variants `…_first` do so when only `count` elements
/// exist (the others read as zero and are not written).
HWY_INLINE Vector load(const double* from) { return hn::LoadU(VectorTag(), from); }
// The first `count` elements, the others zero; no other memory is accessed. Only newer instruction
// sets can mask memory accesses; elsewhere Highway's own functions access whole vectors.
HWY_INLINE Vector load_first(std::size_t count, const double* from) {
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2
  return hn::MaskedLoad(hn::FirstN(VectorTag(), count), VectorTag(), from);
#else
  double lane[kWidth] = {};
  for (std::size_t i = 0; i < count; ++i) lane[i] = from[i];
  return load(lane);
#endif
}
HWY_INLINE void store(Vector value, double* to) { hn::StoreU(value, VectorTag(), to); }
HWY_INLINE void store_first(std::size_t count, Vector value, double* to) {
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2
  hn::BlendedStore(value, hn::FirstN(VectorTag(), count), VectorTag(), to);
#else
  double lane[kWidth];
  store(value, lane);
  for (std::size_t i = 0; i < count; ++i) to[i] = lane[i];
#endif
}

/// Stores the chosen lanes of `value` contiguously and returns their number; the memory after them,
/// up to kWidth doubles from `to`, may be overwritten. (Highway's own Compress copies its
/// permutation table to the stack on each call if the compiler does not optimise that away.)
HWY_INLINE std::size_t store_chosen(Vector value, Mask chosen, double* to) {
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX3
  _mm512_storeu_pd(to, _mm512_maskz_compress_pd(chosen.raw, value.raw));
  return hn::CountTrue(VectorTag(), chosen);
#else
  double lane[kWidth];
  std::uint8_t bits[8] = {};
  store(value, lane);
  hn::StoreMaskBits(VectorTag(), chosen, bits);
  std::size_t count = 0;
  for (std::size_t i = 0; i < kWidth; ++i) {
    to[count] = lane[i];
    count += (bits[0] >> i) & 1U;
  }
  return count;
#endif
}

/// Calls body(i, load, store, part) for every vector of `size` doubles: it covers i … i + kWidth −
/// 1, and is number `part` within its kLanes doubles. `load(pointer)` and `store(value, pointer)`
/// take the address of element i and stay within the size.
template <class Body>
HWY_INLINE void for_vectors(std::size_t size, const Body& body) {
  std::size_t i = 0;
  for (; i + kLanes <= size; i += kLanes) {
    for (std::size_t part = 0; part < kParts; ++part) {
      body(
          i + part * kWidth, [](const double* from) HWY_ATTR { return load(from); },
          [](Vector value, double* to) HWY_ATTR { store(value, to); }, part);
    }
  }
  for (std::size_t part = 0; i < size; i += kWidth, ++part) {
    const std::size_t count = size - i;
    if (count >= kWidth) {
      body(
          i, [](const double* from) HWY_ATTR { return load(from); },
          [](Vector value, double* to) HWY_ATTR { store(value, to); }, part);
    } else {
      body(
          i, [count](const double* from) HWY_ATTR { return load_first(count, from); },
          [count](Vector value, double* to) HWY_ATTR { store_first(count, value, to); }, part);
    }
  }
}

/// A sum over many vectors.
class Sum {
 public:
  HWY_INLINE Sum() {
    for (Vector& value : parts_) value = zeros();
  }
  HWY_INLINE void add(std::size_t part, Vector value) { parts_[part] = parts_[part] + value; }
  [[nodiscard]] HWY_INLINE double total() const {
    double lane[kLanes];
    for (std::size_t part = 0; part < kParts; ++part) store(parts_[part], lane + part * kWidth);
    return ((lane[0] + lane[1]) + (lane[2] + lane[3])) +
           ((lane[4] + lane[5]) + (lane[6] + lane[7]));
  }

 private:
  Vector parts_[kParts];
};

/// c₀ + x (c₁ + x (c₂ + …)).
template <std::size_t N>
HWY_INLINE Vector polynomial(Vector x, const double (&coefficients)[N]) {
  Vector value = constant(coefficients[N - 1]);
  for (std::size_t n = N - 1; n > 0; --n) value = value * x + constant(coefficients[n - 1]);
  return value;
}

struct SineCosine {
  Vector sine;
  Vector cosine;
};

/// Both to about one unit in the last place; NaN where x is not finite. The argument is reduced by
/// multiples of π/2 in three parts (Cody and Waite), whose products with the multiple are exact up
/// to kLargestReduced; larger arguments go through the standard library.
HWY_INLINE SineCosine sine_cosine(Vector x) {
  constexpr double kLargestReduced = 1e6;
  constexpr double kTwoOverPi = 0.63661977236758134308;
  constexpr double kHalfPi1 = 1.57079632673412561417e+00;  // 33 bits
  constexpr double kHalfPi2 = 6.07710050630396597660e-11;  // 33 bits of the remainder
  constexpr double kHalfPi3 = 2.02226624879595063154e-21;  // the rest
  // Adding it rounds to an integer, which is then in the lowest bits.
  constexpr double kRounder = 0x1.8p52;
  constexpr double kSine[] = {-1.66666666666666324348e-01, 8.33333333332248946124e-03,
                              -1.98412698298579493134e-04, 2.75573137070700676789e-06,
                              -2.50507602534068634195e-08, 1.58969099521155010221e-10};
  constexpr double kCosine[] = {4.16666666666666019037e-02, -1.38888888888741095749e-03,
                                2.48015872894767294178e-05, -2.75573143513906633035e-07,
                                2.08757232129817482790e-09, -1.13596475577881948265e-11};
  const VectorTag d;
  const hn::RebindToUnsigned<VectorTag> bits;
  const Vector shifted = x * constant(kTwoOverPi) + constant(kRounder);
  const Vector multiple = shifted - constant(kRounder);
  const auto quadrant = hn::BitCast(bits, shifted);
  const Vector r = ((x - multiple * constant(kHalfPi1)) - multiple * constant(kHalfPi2)) -
                   multiple * constant(kHalfPi3);
  const Vector square = r * r;
  const Vector sine = r + r * square * polynomial(square, kSine);
  // 1 − r²/2 is rounded; the rounding error is added back.
  const Vector half = constant(0.5) * square;
  const Vector one_less = constant(1.0) - half;
  const Vector cosine = one_less + (((constant(1.0) - one_less) - half) +
                                    square * square * polynomial(square, kCosine));
  // Odd quadrants swap the two; the sign of the sine changes in the second half of the turn, that
  // of the cosine a quadrant earlier.
  const auto one = hn::Set(bits, 1);
  const auto two = hn::Set(bits, 2);
  const Mask odd = hn::RebindMask(d, hn::TestBit(quadrant, one));
  const Vector sine_sign = hn::BitCast(d, hn::ShiftLeft<62>(hn::And(quadrant, two)));
  const Vector cosine_sign =
      hn::BitCast(d, hn::ShiftLeft<62>(hn::And(hn::Add(quadrant, one), two)));
  SineCosine result{hn::Xor(hn::IfThenElse(odd, cosine, sine), sine_sign),
                    hn::Xor(hn::IfThenElse(odd, sine, cosine), cosine_sign)};
  const Mask large = hn::Ge(hn::Abs(x), constant(kLargestReduced));
  if (HWY_UNLIKELY(!hn::AllFalse(d, large))) {
    double angle[kWidth];
    double library_sine[kWidth];
    double library_cosine[kWidth];
    store(x, angle);
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
      library_sine[lane] = std::sin(angle[lane]);
      library_cosine[lane] = std::cos(angle[lane]);
    }
    // The other lanes keep their results: no result depends on its neighbours in a vector.
    result.sine = hn::IfThenElse(large, load(library_sine), result.sine);
    result.cosine = hn::IfThenElse(large, load(library_cosine), result.cosine);
  }
  return result;
}

}  // namespace HWY_NAMESPACE
}  // namespace qsmpc::models
HWY_AFTER_NAMESPACE();

#endif
