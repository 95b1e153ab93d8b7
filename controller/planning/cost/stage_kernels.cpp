#include "controller/planning/cost/stage_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "controller/planning/cost/stage_kernels.cpp"
#include <hwy/foreach_target.h>

#include "models/simd/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace qsmpc::controller {
namespace HWY_NAMESPACE {

using namespace models::HWY_NAMESPACE;

const double* row_of(const Points& points, Eigen::Index row, ParticleRange range) {
  return points.data() + row * points.cols() + range.begin;
}

double* row_of(Points& points, Eigen::Index row, ParticleRange range) {
  return points.data() + row * points.cols() + range.begin;
}

std::size_t size_of(ParticleRange range) { return range.end - range.begin; }

void policy_forward(const StagePolicy& policy, const Points& states, ParticleRange range,
                    Points& inputs) {
  const Eigen::Index count = inputs.rows();
  for (Eigen::Index input = 0; input < count; ++input) {
    const Vector constant_part = constant(policy.constant[input]);
    const Vector lower = constant(policy.lower[input]);
    const Vector upper = constant(policy.upper[input]);
    double* const out = row_of(inputs, input, range);
    const double* const x = row_of(states, 0, range);
    const Eigen::Index stride = states.cols();
    const Eigen::Index dim = policy.closed_loop ? states.rows() : 0;
    for_vectors(
        size_of(range), [&](std::size_t i, auto load_at, auto store_at, std::size_t) HWY_ATTR {
          Vector value = constant_part;
          for (Eigen::Index axis = 0; axis < dim; ++axis) {
            value = value +
                    constant(policy.gain[axis * count + input]) * load_at(x + axis * stride + i);
          }
          store_at(hn::Min(hn::Max(value, lower), upper), out + i);
        });
  }
}

void policy_backward(const StagePolicy& policy, const Points& states, const Points& inputs,
                     const Points& input_adjoint, ParticleRange range, Points& state_adjoint,
                     double* sum, double* outer) {
  const Eigen::Index count = inputs.rows();
  const Eigen::Index dim = states.rows();
  const Eigen::Index stride = states.cols();
  const std::size_t size = size_of(range);
  for (Eigen::Index input = 0; input < count; ++input) {
    const Vector lower = constant(policy.lower[input]);
    const Vector upper = constant(policy.upper[input]);
    const double* const u = row_of(inputs, input, range);
    const double* const from = row_of(input_adjoint, input, range);
    double* const to = row_of(state_adjoint, 0, range);
    const double* const x = row_of(states, 0, range);
    Sum total;
    for_vectors(size, [&](std::size_t i, auto load_at, auto store_at, std::size_t part) HWY_ATTR {
      Vector adjoint = load_at(from + i);
      if (policy.closed_loop) {
        const Vector value = load_at(u + i);
        adjoint = hn::IfThenElseZero(hn::And(hn::Gt(value, lower), hn::Lt(value, upper)), adjoint);
        for (Eigen::Index axis = 0; axis < dim; ++axis) {
          double* const at = to + axis * stride + i;
          store_at(load_at(at) + constant(policy.gain[axis * count + input]) * adjoint, at);
        }
      }
      total.add(part, adjoint);
    });
    sum[input] += total.total();
    if (outer == nullptr) continue;
    for (Eigen::Index axis = 0; axis < dim; ++axis) {
      Sum product;
      for_vectors(size, [&](std::size_t i, auto load_at, auto, std::size_t part) HWY_ATTR {
        const Vector value = load_at(u + i);
        const Mask free = hn::And(hn::Gt(value, lower), hn::Lt(value, upper));
        product.add(part,
                    hn::IfThenElseZero(free, load_at(from + i)) * load_at(x + axis * stride + i));
      });
      outer[axis * count + input] += product.total();
    }
  }
}

double quadratic(const QuadraticForm& form, double factor, const Points& points,
                 const Eigen::VectorXd& weights, ParticleRange range, Points& gradient) {
  const Eigen::Index dim = points.rows();
  const Eigen::Index stride = points.cols();
  const double* const x = row_of(points, 0, range);
  double* const out = row_of(gradient, 0, range);
  const double* const rho = weights.data() + range.begin;
  const Vector twice = constant(2.0 * factor);
  Sum sum;
  for_vectors(
      size_of(range), [&](std::size_t i, auto load_at, auto store_at, std::size_t part) HWY_ATTR {
        const Vector weight = twice * load_at(rho + i);
        Vector value = zeros();
        for (Eigen::Index row = 0; row < dim; ++row) {
          const Vector own = load_at(x + row * stride + i) - constant(form.centre[row]);
          Vector weighted = constant(form.matrix(row, row)) * own;
          if (!form.diagonal) {
            for (Eigen::Index column = 0; column < dim; ++column) {
              if (column == row) continue;
              weighted =
                  weighted + constant(form.matrix(row, column)) *
                                 (load_at(x + column * stride + i) - constant(form.centre[column]));
            }
          }
          weighted = weight * weighted;
          value = value + weighted * own;
          store_at(weighted, out + row * stride + i);
        }
        sum.add(part, value);
      });
  return 0.5 * sum.total();
}

void add_rows(const Points& b, ParticleRange range, Points& a) {
  for (Eigen::Index axis = 0; axis < a.rows(); ++axis) {
    const double* const from = row_of(b, axis, range);
    double* const to = row_of(a, axis, range);
    for_vectors(size_of(range),
                [&](std::size_t i, auto load_at, auto store_at, std::size_t)
                    HWY_ATTR { store_at(load_at(to + i) + load_at(from + i), to + i); });
  }
}

/// h of penalty.hpp, and its derivative.
struct Hinge {
  Vector value;
  Vector slope;
};

HWY_INLINE Hinge hinge(Vector signed_distance, Vector inverse_length) {
  const Vector ratio = signed_distance * inverse_length;
  const Vector short_of_one = constant(1.0) - ratio;
  const Mask far = hn::Ge(ratio, constant(1.0));
  const Mask outside = hn::Ge(ratio, zeros());
  const Vector value =
      hn::IfThenElse(outside, constant(0.5) * short_of_one * short_of_one, constant(0.5) - ratio);
  const Vector slope =
      hn::IfThenElse(outside, zeros() - short_of_one * inverse_length, zeros() - inverse_length);
  return {hn::IfThenZeroElse(far, value), hn::IfThenZeroElse(far, slope)};
}

HWY_INLINE Vector positive(Vector value) { return hn::Max(value, zeros()); }

/// Where a point is relative to an obstacle.
struct Relation {
  Vector squared;  // of the distance, if outside
  Vector depth;    // of the nearest face, if inside
  Vector nearest;  // that face's axis, as a position in the list of faces
  Vector outward;  // the sign of its normal
};

class PenaltyLoops {
 public:
  PenaltyLoops(const PenaltyTable& table, const Points& locations, const Eigen::VectorXd& weights,
               ParticleRange range, Points& adjoint)
      : table_(table),
        size_(size_of(range)),
        stride_(locations.cols()),
        x_(row_of(locations, 0, range)),
        weight_(weights.data() + range.begin),
        adjoint_(row_of(adjoint, 0, range)),
        inverse_length_(constant(1.0 / table.penalty.length)) {}

  PenaltyValue smooth() {
    PenaltyValue value;
    for (const PenaltyTable::Face& face : table_.bounds) value.box += smooth_bound(face);
    for (const auto& obstacle : table_.obstacles) value.obstacle += smooth_obstacle(obstacle);
    return value;
  }

  PenaltyValue thesis() {
    PenaltyValue value;
    for (const PenaltyTable::Face& face : table_.bounds) value.box += thesis_bound(face);
    if (!table_.obstacles.empty()) value.obstacle = thesis_obstacles();
    return value;
  }

 private:
  template <class LoadAt>
  HWY_INLINE Vector coordinate(const LoadAt& load_at, int axis, std::size_t i) const {
    return load_at(x_ + axis * stride_ + i);
  }

  template <class LoadAt, class StoreAt>
  HWY_INLINE void add(const LoadAt& load_at, const StoreAt& store_at, int axis, std::size_t i,
                      Vector value) {
    double* const at = adjoint_ + axis * stride_ + i;
    store_at(load_at(at) + value, at);
  }

  double smooth_bound(const PenaltyTable::Face& face) {
    const Vector scale = constant(table_.penalty.box);
    Sum sum;
    for_vectors(size_, [&](std::size_t i, auto load_at, auto store_at, std::size_t part) HWY_ATTR {
      const Vector x = coordinate(load_at, face.axis, i);
      const Hinge low = hinge(x - constant(face.lower), inverse_length_);
      const Hinge high = hinge(constant(face.upper) - x, inverse_length_);
      const Vector weight = scale * load_at(weight_ + i);
      sum.add(part, weight * (low.value + high.value));
      add(load_at, store_at, face.axis, i, weight * (low.slope - high.slope));
    });
    return sum.total();
  }

  template <class LoadAt>
  HWY_INLINE Relation relation(const std::vector<PenaltyTable::Face>& obstacle,
                               const LoadAt& load_at, std::size_t i) const {
    Relation result{zeros(), constant(std::numeric_limits<double>::infinity()), zeros(), zeros()};
    for (std::size_t k = 0; k < obstacle.size(); ++k) {
      const Vector x = coordinate(load_at, obstacle[k].axis, i);
      const Vector below = x - constant(obstacle[k].lower);
      const Vector above = constant(obstacle[k].upper) - x;
      const Vector least = hn::Min(below, above);
      const Vector gap = positive(zeros() - least);
      result.squared = result.squared + gap * gap;
      const Mask nearer = hn::Lt(least, result.depth);
      result.depth = hn::IfThenElse(nearer, least, result.depth);
      result.nearest = hn::IfThenElse(nearer, constant(static_cast<double>(k)), result.nearest);
      result.outward = hn::IfThenElse(
          nearer, hn::IfThenElse(hn::Lt(below, above), constant(-1.0), constant(1.0)),
          result.outward);
    }
    return result;
  }

  double smooth_obstacle(const std::vector<PenaltyTable::Face>& obstacle) {
    const VectorTag d;
    const Vector scale = constant(table_.penalty.obstacle);
    Sum sum;
    for_vectors(size_, [&](std::size_t i, auto load_at, auto store_at, std::size_t part) HWY_ATTR {
      const Relation at = relation(obstacle, load_at, i);
      const Mask inside = hn::Eq(at.squared, zeros());
      const Vector distance = hn::Sqrt(at.squared);
      const Hinge value =
          hinge(hn::IfThenElse(inside, zeros() - at.depth, distance), inverse_length_);
      const Vector weight = scale * load_at(weight_ + i);
      sum.add(part, weight * value.value);
      // Most particles are far from most obstacles.
      if (hn::AllTrue(d, hn::Eq(value.slope, zeros()))) return;
      const Vector push = weight * value.slope;
      const Vector per_distance = push / distance;
      for (std::size_t k = 0; k < obstacle.size(); ++k) {
        const Vector x = coordinate(load_at, obstacle[k].axis, i);
        const Vector beyond =
            positive(x - constant(obstacle[k].upper)) - positive(constant(obstacle[k].lower) - x);
        const Mask nearest = hn::Eq(at.nearest, constant(static_cast<double>(k)));
        const Vector out = hn::IfThenElse(inside, hn::IfThenElseZero(nearest, push * at.outward),
                                          per_distance * beyond);
        add(load_at, store_at, obstacle[k].axis, i,
            hn::IfThenZeroElse(hn::Eq(value.slope, zeros()), out));
      }
    });
    return sum.total();
  }

  /// How far x is outside the face's interval, and the derivative of it (Eq. 4-10).
  HWY_INLINE Hinge excess(const PenaltyTable::Face& face, Vector x) const {
    const Vector below = positive(constant(face.lower) - x);
    const Vector above = positive(x - constant(face.upper));
    return {below + above,
            hn::IfThenElse(hn::Gt(above, zeros()), constant(1.0),
                           hn::IfThenElseZero(hn::Gt(below, zeros()), constant(-1.0)))};
  }

  double thesis_bound(const PenaltyTable::Face& face) {
    const Vector scale = constant(table_.penalty.box);
    Sum sum;
    for_vectors(size_, [&](std::size_t i, auto load_at, auto store_at, std::size_t part) HWY_ATTR {
      const Vector x = coordinate(load_at, face.axis, i);
      const Hinge out = excess(face, x);
      const Vector weight = scale * load_at(weight_ + i);
      // NaN must not be lost in the comparisons.
      sum.add(part, weight * (out.value + (x - x)));
      add(load_at, store_at, face.axis, i, weight * out.slope);
    });
    return sum.total();
  }

  double thesis_obstacles() {
    const Vector scale = constant(table_.penalty.obstacle);
    Sum sum;
    for_vectors(size_, [&](std::size_t i, auto load_at, auto store_at, std::size_t part) HWY_ATTR {
      Vector largest = zeros();
      Vector at = constant(-1.0);
      for (std::size_t n = 0; n < table_.obstacles.size(); ++n) {
        Vector outside = zeros();
        for (const PenaltyTable::Face& face : table_.obstacles[n]) {
          outside = outside + excess(face, coordinate(load_at, face.axis, i)).value;
        }
        const Vector indicator = constant(1.0) - hn::Min(outside, constant(1.0));
        const Mask larger = hn::Gt(indicator, largest);
        largest = hn::IfThenElse(larger, indicator, largest);
        at = hn::IfThenElse(larger, constant(static_cast<double>(n)), at);
      }
      const Vector weight = scale * load_at(weight_ + i);
      sum.add(part, weight * largest);
      for (std::size_t n = 0; n < table_.obstacles.size(); ++n) {
        const Mask chosen = hn::Eq(at, constant(static_cast<double>(n)));
        for (const PenaltyTable::Face& face : table_.obstacles[n]) {
          const Vector slope = excess(face, coordinate(load_at, face.axis, i)).slope;
          add(load_at, store_at, face.axis, i,
              hn::IfThenElseZero(chosen, zeros() - weight * slope));
        }
      }
    });
    return sum.total();
  }

  const PenaltyTable& table_;
  std::size_t size_;
  Eigen::Index stride_;
  const double* x_;
  const double* weight_;
  double* adjoint_;
  Vector inverse_length_;
};

PenaltyValue penalty_loops(const PenaltyTable& table, const Points& locations,
                           const Eigen::VectorXd& weights, ParticleRange range, Points& adjoint) {
  for (Eigen::Index axis = 0; axis < adjoint.rows(); ++axis) {
    double* const to = row_of(adjoint, axis, range);
    std::fill(to, to + size_of(range), 0.0);
  }
  PenaltyLoops loops(table, locations, weights, range, adjoint);
  return table.penalty.shape == PenaltyShape::kThesis ? loops.thesis() : loops.smooth();
}

}  // namespace HWY_NAMESPACE
}  // namespace qsmpc::controller
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace qsmpc::controller {

HWY_EXPORT(policy_forward);
HWY_EXPORT(policy_backward);
HWY_EXPORT(quadratic);
HWY_EXPORT(add_rows);
HWY_EXPORT(penalty_loops);

void apply_policy(const StagePolicy& policy, const Points& states, ParticleRange range,
                  Points& inputs) {
  HWY_DYNAMIC_DISPATCH(policy_forward)(policy, states, range, inputs);
}

void pullback_policy(const StagePolicy& policy, const Points& states, const Points& inputs,
                     const Points& input_adjoint, ParticleRange range, Points& state_adjoint,
                     double* sum, double* outer) {
  HWY_DYNAMIC_DISPATCH(policy_backward)
  (policy, states, inputs, input_adjoint, range, state_adjoint, sum, outer);
}

QuadraticForm::QuadraticForm(const Eigen::MatrixXd& symmetric, const Eigen::VectorXd& about)
    : matrix(symmetric), centre(about), diagonal(symmetric.isDiagonal(0.0)) {}

double weighted_quadratic(const QuadraticForm& form, double factor, const Points& points,
                          const Eigen::VectorXd& weights, ParticleRange range, Points& gradient) {
  return HWY_DYNAMIC_DISPATCH(quadratic)(form, factor, points, weights, range, gradient);
}

void add_points(const Points& b, ParticleRange range, Points& a) {
  HWY_DYNAMIC_DISPATCH(add_rows)(b, range, a);
}

PenaltyValue penalise(const PenaltyTable& table, const Points& locations,
                      const Eigen::VectorXd& weights, ParticleRange range, Points& adjoint) {
  return HWY_DYNAMIC_DISPATCH(penalty_loops)(table, locations, weights, range, adjoint);
}

}  // namespace qsmpc::controller
#endif
