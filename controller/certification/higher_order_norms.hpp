// Norms of normal variables that enter the bounds of higher order than the mean square.
#pragma once

#include "controller/measure/normal/norm_orders.hpp"

namespace qsmpc::controller {

/// The norms of polynomials of a standard normal Z that bounds of order p = kHigherOrders[k] need.
struct HigherOrderNorms {
  double first;        ///< ‖Z‖_p
  double first_twice;  ///< ‖Z‖_2p
  double fourth;       ///< ‖Z⁴‖_p
  double fifth;        ///< ‖Z⁵‖_p
  double square;       ///< ‖Z² − 1‖_p
  double cube;         ///< ‖Z³ − 3Z‖_p
};

/// The norms of order kHigherOrders[k], computed once. k < kHigherOrders.size().
[[nodiscard]] const HigherOrderNorms& higher_order_norms(std::size_t k);

}  // namespace qsmpc::controller
