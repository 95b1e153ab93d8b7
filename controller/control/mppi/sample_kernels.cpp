#include "controller/control/mppi/sample_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "controller/control/mppi/sample_kernels.cpp"
#include <hwy/foreach_target.h>

#include "models/simd/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace qsmpc::controller {
namespace HWY_NAMESPACE {

using namespace models::HWY_NAMESPACE;

void draw_loop(const InputDraw& draw, Eigen::Index count, double* drift, double* values) {
  const Vector keep = constant(draw.keep);
  const Vector add = constant(draw.add);
  const Vector nominal = constant(draw.nominal);
  const Vector deviation = constant(draw.deviation);
  const Vector lower = constant(draw.lower);
  const Vector upper = constant(draw.upper);
  for_vectors(count, [&](std::size_t i, auto load_at, auto store_at, std::size_t) HWY_ATTR {
    const Vector moved = keep * load_at(drift + i) + add * load_at(values + i);
    store_at(moved, drift + i);
    store_at(hn::Min(hn::Max(nominal + deviation * moved, lower), upper), values + i);
  });
}

void quadratic_loop(const QuadraticForm& form, double factor,
                    const Eigen::Ref<const Points>& points, Eigen::ArrayXd& totals) {
  const Eigen::Index dim = points.rows();
  const Eigen::Index stride = points.outerStride();
  const double* const x = points.data();
  double* const out = totals.data();
  const Vector scale = constant(factor);
  for_vectors(points.cols(), [&](std::size_t i, auto load_at, auto store_at, std::size_t) HWY_ATTR {
    Vector value = zeros();
    for (Eigen::Index row = 0; row < dim; ++row) {
      const Vector own = load_at(x + row * stride + i) - constant(form.centre[row]);
      Vector weighted = constant(form.matrix(row, row)) * own;
      for (Eigen::Index column = 0; !form.diagonal && column < row; ++column) {
        weighted =
            weighted + constant(2.0 * form.matrix(row, column)) *
                           (load_at(x + column * stride + i) - constant(form.centre[column]));
      }
      value = value + weighted * own;
    }
    store_at(load_at(out + i) + scale * value, out + i);
  });
}

void place_loop(const DiscPlacement& placement, const Points& states, Points& centres) {
  const Eigen::Index stride = states.cols();
  const double* const x = states.data() + placement.x() * stride;
  const double* const y = states.data() + placement.y() * stride;
  const double* const heading = states.data() + placement.heading() * stride;
  double* const centre_x = centres.data() + placement.x() * stride;
  double* const centre_y = centres.data() + placement.y() * stride;
  const Vector bearing = constant(placement.bearing());
  const Vector reach = constant(placement.reach());
  for_vectors(stride, [&](std::size_t i, auto load_at, auto store_at, std::size_t) HWY_ATTR {
    const SineCosine angle = sine_cosine(load_at(heading + i) + bearing);
    store_at(load_at(x + i) + reach * angle.cosine, centre_x + i);
    store_at(load_at(y + i) + reach * angle.sine, centre_y + i);
  });
}

void unsafe_loop(const UnsafeCost& cost, const Eigen::ArrayXd& clearances, double* totals) {
  const double* const s = clearances.data();
  const Vector inverse = constant(1.0 / cost.margin);
  const Vector collision = constant(cost.collision);
  const Vector proximity = constant(cost.proximity);
  for_vectors(
      clearances.size(), [&](std::size_t i, auto load_at, auto store_at, std::size_t) HWY_ATTR {
        const Vector ratio = load_at(s + i) * inverse;
        const Vector short_of_one = hn::Max(constant(1.0) - ratio, zeros());
        const Mask unsafe = hn::Le(ratio, zeros());
        const Vector hinge = hn::IfThenElse(unsafe, constant(0.5) - ratio,
                                            constant(0.5) * short_of_one * short_of_one);
        store_at(load_at(totals + i) + hn::IfThenElseZero(unsafe, collision) + proximity * hinge,
                 totals + i);
      });
}

double product_loop(const double* a, const double* b, Eigen::Index count) {
  Sum sum;
  for_vectors(count, [&](std::size_t i, auto load_at, auto, std::size_t part)
                         HWY_ATTR { sum.add(part, load_at(a + i) * load_at(b + i)); });
  return sum.total();
}

}  // namespace HWY_NAMESPACE
}  // namespace qsmpc::controller
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace qsmpc::controller {

HWY_EXPORT(draw_loop);
HWY_EXPORT(quadratic_loop);
HWY_EXPORT(place_loop);
HWY_EXPORT(unsafe_loop);
HWY_EXPORT(product_loop);

void draw_inputs(const InputDraw& draw, Eigen::Index count, double* drift, double* values) {
  HWY_DYNAMIC_DISPATCH(draw_loop)(draw, count, drift, values);
}

void add_quadratic(const QuadraticForm& form, double factor, const Eigen::Ref<const Points>& points,
                   Eigen::ArrayXd& totals) {
  HWY_DYNAMIC_DISPATCH(quadratic_loop)(form, factor, points, totals);
}

void place_discs(const DiscPlacement& placement, const Points& states, Points& centres) {
  centres = states;
  HWY_DYNAMIC_DISPATCH(place_loop)(placement, states, centres);
}

void add_unsafe_cost(const UnsafeCost& cost, const Eigen::ArrayXd& clearances, double* totals) {
  HWY_DYNAMIC_DISPATCH(unsafe_loop)(cost, clearances, totals);
}

double weighted_total(const double* a, const double* b, Eigen::Index count) {
  return HWY_DYNAMIC_DISPATCH(product_loop)(a, b, count);
}

}  // namespace qsmpc::controller
#endif  // HWY_ONCE
