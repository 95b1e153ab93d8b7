#include "controller/certification/higher_order_norms.hpp"

#include "controller/measure/normal/normal_norms.hpp"

namespace qsmpc::controller {
namespace {

HigherOrderNorms norms_of_order(int order) {
  return {.first = normal_power_norm(1, order),
          .first_twice = normal_power_norm(1, 2 * order),
          .fourth = normal_power_norm(4, order),
          .fifth = normal_power_norm(5, order),
          .square = normal_square_norm(order),
          .cube = normal_cube_norm(order)};
}

}  // namespace

const HigherOrderNorms& higher_order_norms(std::size_t k) {
  static const std::array<HigherOrderNorms, kHigherOrders.size()> table = {
      norms_of_order(kHigherOrders[0]), norms_of_order(kHigherOrders[1])};
  return table[k];
}

}  // namespace qsmpc::controller
