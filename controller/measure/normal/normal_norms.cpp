#include "controller/measure/normal/normal_norms.hpp"

#include <cmath>

#include <boost/math/special_functions/binomial.hpp>
#include <boost/math/special_functions/factorials.hpp>

namespace qsmpc::controller {
namespace {

/// E Z^power for an even power.
double moment(int power) {
  return power == 0 ? 1.0 : boost::math::double_factorial<double>(static_cast<unsigned>(power - 1));
}

/// (E (Z^high − shift Z^low)^order)^{1/order}, by the binomial theorem.
double norm_of_difference(int high, int low, double shift, int order) {
  double sum = 0.0;
  for (int k = 0; k <= order; ++k) {
    const double choose = boost::math::binomial_coefficient<double>(static_cast<unsigned>(order),
                                                                    static_cast<unsigned>(k));
    sum += choose * std::pow(-shift, k) * moment(high * (order - k) + low * k);
  }
  return std::pow(sum, 1.0 / order);
}

}  // namespace

double normal_power_norm(int power, int order) {
  return std::pow(moment(power * order), 1.0 / order);
}

double normal_square_norm(int order) { return norm_of_difference(2, 0, 1.0, order); }

double normal_cube_norm(int order) { return norm_of_difference(3, 1, 3.0, order); }

}  // namespace qsmpc::controller
