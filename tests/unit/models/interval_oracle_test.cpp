// Interval arithmetic compared with 200-bit MPFI: it encloses the exact range tightly.
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <mpfi.h>

#include "models/dynamics/interval.hpp"

namespace qsmpc::models {
namespace interval_oracle_test {

constexpr int kBits = 200;
constexpr int kRepetitions = 4000;
// Relative to the larger end: functions move each end outwards by a few units in the last place.
constexpr double kSlack = 1e-14;

/// An owning wrapper of an MPFI interval.
class Exact {
 public:
  Exact() { mpfi_init2(value_, kBits); }
  explicit Exact(const Interval& interval) : Exact() {
    mpfi_interv_d(value_, interval.lower(), interval.upper());
  }
  Exact(const Exact&) = delete;
  Exact& operator=(const Exact&) = delete;
  Exact(Exact&&) = delete;
  Exact& operator=(Exact&&) = delete;
  ~Exact() { mpfi_clear(value_); }

  mpfi_ptr get() { return value_; }
  /// Whether `interval` contains all of it.
  [[nodiscard]] bool is_within(const Interval& interval) const {
    return mpfr_cmp_d(&value_->left, interval.lower()) >= 0 &&
           mpfr_cmp_d(&value_->right, interval.upper()) <= 0;
  }
  [[nodiscard]] double lower() const { return mpfr_get_d(&value_->left, MPFR_RNDD); }
  [[nodiscard]] double upper() const { return mpfr_get_d(&value_->right, MPFR_RNDU); }

 private:
  mpfi_t value_;
};

struct Function {
  std::string name;
  std::function<Interval(const Interval&)> ours;
  int (*exact)(mpfi_ptr, mpfi_srcptr);
  double lowest = -1e3;  ///< of the arguments
  double highest = 1e3;
};

std::vector<Function> functions() {
  return {{"inverse", [](const Interval& a) { return inverse(a); }, mpfi_inv, 1e-3, 1e3},
          {"square", [](const Interval& a) { return square(a); }, mpfi_sqr},
          {"sqrt", [](const Interval& a) { return sqrt(a); }, mpfi_sqrt, 0.0, 1e6},
          {"sin", [](const Interval& a) { return sin(a); }, mpfi_sin},
          {"cos", [](const Interval& a) { return cos(a); }, mpfi_cos},
          {"tan", [](const Interval& a) { return tan(a); }, mpfi_tan, -1.5, 1.5},
          {"exp", [](const Interval& a) { return exp(a); }, mpfi_exp, -300.0, 300.0},
          {"log", [](const Interval& a) { return log(a); }, mpfi_log, 1e-6, 1e6},
          {"asin", [](const Interval& a) { return asin(a); }, mpfi_asin, -1.0, 1.0},
          {"acos", [](const Interval& a) { return acos(a); }, mpfi_acos, -1.0, 1.0},
          {"atan", [](const Interval& a) { return atan(a); }, mpfi_atan},
          {"sinh", [](const Interval& a) { return sinh(a); }, mpfi_sinh, -30.0, 30.0},
          {"cosh", [](const Interval& a) { return cosh(a); }, mpfi_cosh, -30.0, 30.0},
          {"tanh", [](const Interval& a) { return tanh(a); }, mpfi_tanh},
          {"abs", [](const Interval& a) { return abs(a); }, mpfi_abs}};
}

/// Of any width from a single number to the whole range; often near zero or a whole number.
Interval random_interval(std::mt19937_64& generator, double lowest, double highest) {
  std::uniform_real_distribution<double> within(lowest, highest);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  double lower = within(generator);
  if (share(generator) < 0.3) lower = std::round(lower);
  if (share(generator) < 0.2) lower *= 1e-6;
  const double width = (highest - lowest) * std::pow(10.0, -16.0 * share(generator));
  double upper = share(generator) < 0.1 ? lower : lower + width;
  lower = std::clamp(lower, lowest, highest);
  upper = std::clamp(upper, lower, highest);
  return {lower, upper};
}

void expect_enclosed(const Interval& ours, const Exact& exact, double scale,
                     const std::string& what) {
  EXPECT_TRUE(exact.is_within(ours))
      << what << ": [" << ours.lower() << ", " << ours.upper() << "]";
  EXPECT_LE(exact.lower() - ours.lower(), kSlack * scale) << what;
  EXPECT_LE(ours.upper() - exact.upper(), kSlack * scale) << what;
}

TEST(IntervalOracle, functions_enclose_the_exact_range_closely) {
  std::mt19937_64 generator(21);
  for (const Function& function : functions()) {
    for (int repetition = 0; repetition < kRepetitions; ++repetition) {
      const Interval a = random_interval(generator, function.lowest, function.highest);
      Exact argument(a);
      Exact result;
      function.exact(result.get(), argument.get());
      const double size = std::max(std::abs(result.lower()), std::abs(result.upper()));
      // Values about 1, such as sines far from zero, are as accurate as values of that size can be.
      expect_enclosed(function.ours(a), result, std::max(1.0, size),
                      function.name + " of [" + std::to_string(a.lower()) + ", " +
                          std::to_string(a.upper()) + "]");
    }
  }
}

TEST(IntervalOracle, operations_enclose_the_exact_range_closely) {
  std::mt19937_64 generator(22);
  struct Operation {
    std::string name;
    std::function<Interval(const Interval&, const Interval&)> ours;
    int (*exact)(mpfi_ptr, mpfi_srcptr, mpfi_srcptr);
    double least_second = -1e3;
  };
  const std::vector<Operation> operations = {
      {"sum", [](const Interval& a, const Interval& b) { return a + b; }, mpfi_add},
      {"difference", [](const Interval& a, const Interval& b) { return a - b; }, mpfi_sub},
      {"product", [](const Interval& a, const Interval& b) { return a * b; }, mpfi_mul},
      {"quotient", [](const Interval& a, const Interval& b) { return a / b; }, mpfi_div, 1e-3},
      {"atan2", [](const Interval& a, const Interval& b) { return atan2(a, b); }, mpfi_atan2,
       1e-3}};
  for (const Operation& operation : operations) {
    for (int repetition = 0; repetition < kRepetitions; ++repetition) {
      const Interval a = random_interval(generator, -1e3, 1e3);
      const Interval b = random_interval(generator, operation.least_second, 1e3);
      Exact first(a);
      Exact second(b);
      Exact result;
      operation.exact(result.get(), first.get(), second.get());
      const double size = std::max(std::abs(result.lower()), std::abs(result.upper()));
      expect_enclosed(operation.ours(a, b), result, std::max(1.0, size), operation.name);
    }
  }
}

}  // namespace interval_oracle_test
}  // namespace qsmpc::models
