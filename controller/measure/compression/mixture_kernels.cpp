#include "controller/measure/compression/mixture_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "controller/measure/compression/mixture_kernels.cpp"
#include <hwy/foreach_target.h>

#include "controller/measure/normal/normal_cdf-inl.hpp"
#include "models/simd/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace qsmpc::controller {
namespace HWY_NAMESPACE {

using namespace models::HWY_NAMESPACE;

// Stands for 1/0: a source without noise is then entirely on one side or the other.
constexpr double kLargestInverse = 1e300;

/// ∫ over an interval: probability, x and x².
struct Integrals {
  Vector probability;
  Vector first;
  Vector second;
};

HWY_INLINE Integrals integrals(const MixtureInterval& interval, std::size_t stride, std::size_t i) {
  return {load(interval.upper + i) - load(interval.lower + i),
          load(interval.upper + stride + i) - load(interval.lower + stride + i),
          load(interval.upper + 2 * stride + i) - load(interval.lower + 2 * stride + i)};
}

/// Products of all entries but one: out[a] = Π_{b ≠ a} factors[b], and the product of all.
template <int Dim>
HWY_INLINE Vector products_of_others(const Vector* factors, Vector* out) {
  Vector before = constant(1.0);
  for (int a = 0; a < Dim; ++a) {
    out[a] = before;
    before = before * factors[a];
  }
  Vector after = constant(1.0);
  for (int a = Dim - 1; a >= 0; --a) {
    out[a] = out[a] * after;
    after = after * factors[a];
  }
  return before;
}

template <int Dim>
MixtureCutResult cut_in(const MixtureCut& cut, std::size_t begin, std::size_t end) {
  const VectorTag d;
  const std::size_t stride = cut.stride;
  const Vector at = constant(cut.at);
  const Vector deviation = constant(cut.deviation);
  const Vector variance = constant(cut.deviation * cut.deviation);
  const Vector inverse =
      constant(cut.deviation * kLargestInverse > 1.0 ? 1.0 / cut.deviation : kLargestInverse);
  const Vector least = constant(cut.least_share);
  const MixtureInterval own = cut.intervals[0];
  Sum mass;
  Sum first[Dim];
  Sum second[Dim];
  MixtureCutResult result;
  for (std::size_t block = begin; block < end; block += kLanes) {
    for (std::size_t part = 0; part < kParts; ++part) {
      const std::size_t i = block + part * kWidth;
      const Vector y = load(cut.position + i);
      const NormalValues normal = normal_values((at - y) * inverse);
      const Vector wide = deviation * normal.density;
      const Vector middle1 = y * normal.probability - wide;
      // ∫ (y + σz)² = y ∫ x − yσφ + σ² (Φ − zφ), and σ² zφ = σ (at − y) φ.
      const Vector middle2 = y * (middle1 - wide) + variance * normal.probability - wide * (at - y);
      const Vector lower0 = load(own.lower + i);
      const Vector upper0 = load(own.upper + i);
      const Vector lower1 = load(own.lower + stride + i);
      const Vector upper1 = load(own.upper + stride + i);
      const Vector lower2 = load(own.lower + 2 * stride + i);
      const Vector upper2 = load(own.upper + 2 * stride + i);
      Integrals other[Dim];
      Vector probability[Dim];
      Vector without[Dim];
      for (int b = 1; b < Dim; ++b) {
        other[b] = integrals(cut.intervals[b], stride, i);
        probability[b - 1] = other[b].probability;
      }
      const Vector share = products_of_others<Dim - 1>(probability, without);
      const Vector below = normal.probability - lower0;
      const Vector above = upper0 - normal.probability;
      const Mask both = hn::And(hn::Ge(share * below, least), hn::Ge(share * above, least));
      const Mask all_below = hn::Ge(below, above);
      const Vector edge0 =
          hn::IfThenElse(both, normal.probability, hn::IfThenElse(all_below, upper0, lower0));
      const Vector edge1 = hn::IfThenElse(both, middle1, hn::IfThenElse(all_below, upper1, lower1));
      const Vector edge2 = hn::IfThenElse(both, middle2, hn::IfThenElse(all_below, upper2, lower2));
      store(edge0, cut.edge + i);
      store(edge1, cut.edge + stride + i);
      store(edge2, cut.edge + 2 * stride + i);
      const Vector weight = load(cut.weight + i);
      const Vector kept = edge0 - lower0;
      const Vector scale = weight * share;
      const Vector weighted = weight * kept;
      mass.add(part, scale * kept);
      first[0].add(part, scale * (edge1 - lower1));
      second[0].add(part, scale * (edge2 - lower2));
      for (int b = 1; b < Dim; ++b) {
        const Vector factor = weighted * without[b - 1];
        first[b].add(part, factor * other[b].first);
        second[b].add(part, factor * other[b].second);
      }
      result.lower_parts += hn::CountTrue(d, hn::Gt(share * kept, zeros()));
      result.upper_parts += hn::CountTrue(d, hn::Gt(share * (upper0 - edge0), zeros()));
    }
  }
  result.lower.mass = mass.total();
  for (int a = 0; a < Dim; ++a) {
    result.lower.first[a] = first[a].total();
    result.lower.second[a] = second[a].total();
  }
  return result;
}

template <int Dim>
MixtureParts list_in(const MixtureCell& cell, std::size_t size, double* mass, double* source) {
  Sum total;
  Sum first[Dim];
  Sum noise[Dim];
  MixtureParts parts;
  for (std::size_t block = 0; block < size; block += kLanes) {
    for (std::size_t part = 0; part < kParts; ++part) {
      const std::size_t i = block + part * kWidth;
      Integrals along[Dim];
      Vector probability[Dim];
      Vector without[Dim];
      for (int a = 0; a < Dim; ++a) {
        along[a] = integrals(cell.intervals[a], cell.stride, i);
        probability[a] = along[a].probability;
      }
      const Vector share = products_of_others<Dim>(probability, without);
      const Vector weight = load(cell.weight + i);
      const Vector value = weight * share;
      total.add(part, value);
      for (int a = 0; a < Dim; ++a) {
        const Vector factor = weight * without[a];
        const Vector moved = along[a].first - load(cell.position[a] + i) * probability[a];
        first[a].add(part, factor * along[a].first);
        noise[a].add(part, factor * moved);
      }
      const Mask some = hn::Gt(value, zeros());
      store_chosen(value, some, mass + parts.count);
      parts.count += store_chosen(load(cell.source + i), some, source + parts.count);
    }
  }
  parts.mass = total.total();
  for (int a = 0; a < Dim; ++a) {
    parts.first[a] = first[a].total();
    parts.noise[a] = noise[a].total();
  }
  return parts;
}

void copy_parts(const MixtureCopy& copy) {
  const VectorTag d;
  const std::size_t from_stride = copy.stride;
  const std::size_t to_stride = copy.to_stride;
  std::size_t count = 0;
  for (std::size_t i = 0; i < copy.size && count < copy.parts; i += kWidth) {
    Mask some = hn::Gt(load(copy.intervals[0].upper + i), load(copy.intervals[0].lower + i));
    for (int a = 1; a < copy.dim; ++a) {
      some = hn::And(some,
                     hn::Gt(load(copy.intervals[a].upper + i), load(copy.intervals[a].lower + i)));
    }
    const std::size_t found = hn::CountTrue(d, some);
    if (found == 0) continue;
    store_chosen(load(copy.source + i), some, copy.to_source + count);
    store_chosen(load(copy.weight + i), some, copy.to_weight + count);
    for (int a = 0; a < copy.dim; ++a) {
      store_chosen(load(copy.position + a * from_stride + i), some,
                   copy.to_position + a * to_stride + count);
      for (int c = 0; c < 3; ++c) {
        const std::size_t to = c * to_stride + count;
        const std::size_t from = c * from_stride + i;
        if (copy.to_edges[a][0] != nullptr) {
          store_chosen(load(copy.intervals[a].lower + from), some, copy.to_edges[a][0] + to);
        }
        store_chosen(load(copy.intervals[a].upper + from), some, copy.to_edges[a][1] + to);
      }
    }
    count += found;
  }
  for (std::size_t i = count; i < count + kMixturePadding; i += kWidth) {
    store(zeros(), copy.to_source + i);
    store(zeros(), copy.to_weight + i);
    for (int a = 0; a < copy.dim; ++a) {
      store(zeros(), copy.to_position + a * to_stride + i);
      for (int c = 0; c < 3; ++c) {
        for (double* const edge : copy.to_edges[a]) {
          if (edge != nullptr) store(zeros(), edge + c * to_stride + i);
        }
      }
    }
  }
}

using CutFunction = MixtureCutResult (*)(const MixtureCut&, std::size_t, std::size_t);
using ListFunction = MixtureParts (*)(const MixtureCell&, std::size_t, double*, double*);

MixtureCutResult cut_any(const MixtureCut& cut, std::size_t begin, std::size_t end) {
  static constexpr CutFunction kByDim[kMixtureDimLimit] = {
      cut_in<1>, cut_in<2>, cut_in<3>, cut_in<4>, cut_in<5>, cut_in<6>, cut_in<7>, cut_in<8>};
  return kByDim[cut.dim - 1](cut, begin, end);
}

MixtureParts list_any(const MixtureCell& cell, std::size_t size, double* mass, double* source) {
  static constexpr ListFunction kByDim[kMixtureDimLimit] = {list_in<1>, list_in<2>, list_in<3>,
                                                            list_in<4>, list_in<5>, list_in<6>,
                                                            list_in<7>, list_in<8>};
  return kByDim[cell.dim - 1](cell, size, mass, source);
}

}  // namespace HWY_NAMESPACE
}  // namespace qsmpc::controller
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace qsmpc::controller {

HWY_EXPORT(cut_any);
HWY_EXPORT(list_any);
HWY_EXPORT(copy_parts);

MixtureCutResult cut_mixture(const MixtureCut& cut, std::size_t begin, std::size_t end) {
  return HWY_DYNAMIC_DISPATCH(cut_any)(cut, begin, end);
}

MixtureParts list_mixture_parts(const MixtureCell& cell, std::size_t size, double* mass,
                                double* source) {
  return HWY_DYNAMIC_DISPATCH(list_any)(cell, size, mass, source);
}

void copy_mixture_parts(const MixtureCopy& copy) { HWY_DYNAMIC_DISPATCH(copy_parts)(copy); }

}  // namespace qsmpc::controller
#endif
