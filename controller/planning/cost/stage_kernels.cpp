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
                 const Eigen::VectorXd& weights, ParticleRange range, Points& gradient,
                 GradientUse use) {
  const bool adds = use == GradientUse::kAdd;
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
          double* const at = out + row * stride + i;
          store_at(adds ? load_at(at) + weighted : weighted, at);
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

}  // namespace HWY_NAMESPACE
}  // namespace qsmpc::controller
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace qsmpc::controller {

HWY_EXPORT(policy_forward);
HWY_EXPORT(policy_backward);
HWY_EXPORT(quadratic);
HWY_EXPORT(add_rows);

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
                          const Eigen::VectorXd& weights, ParticleRange range, Points& gradient,
                          GradientUse use) {
  return HWY_DYNAMIC_DISPATCH(quadratic)(form, factor, points, weights, range, gradient, use);
}

void add_points(const Points& b, ParticleRange range, Points& a) {
  HWY_DYNAMIC_DISPATCH(add_rows)(b, range, a);
}

}  // namespace qsmpc::controller
#endif
