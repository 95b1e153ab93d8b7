// Theoretical properties of each method's moments, and convergence of the methods to the truth.
#include <algorithm>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "controller/measure/wasserstein.hpp"
#include "tests/support/dubins_closed_form.hpp"
#include "tests/unit/controller/laws/law_cases.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"

namespace qsmpc::controller {
namespace law_accuracy_test {

using namespace testing;

/// Means and covariances of y_i = ½ xᵀ A_i x + b_iᵀ x for x ~ N(m, P), by the formulas.
struct Quadratics {
  std::vector<Eigen::Matrix2d> curvatures;
  std::vector<Eigen::Vector2d> slopes;

  [[nodiscard]] Gaussian moments(const Gaussian& x) const {
    Gaussian moments{.mean = Eigen::Vector2d::Zero(), .covariance = Eigen::Matrix2d::Zero()};
    for (int i = 0; i < 2; ++i) {
      moments.mean[i] = 0.5 * (curvatures[i] * x.covariance).trace() +
                        0.5 * x.mean.dot(curvatures[i] * x.mean) + slopes[i].dot(x.mean);
      const Eigen::Vector2d left = slopes[i] + curvatures[i] * x.mean;
      for (int j = 0; j < 2; ++j) {
        const Eigen::Vector2d right = slopes[j] + curvatures[j] * x.mean;
        moments.covariance(i, j) =
            0.5 * (curvatures[i] * x.covariance * curvatures[j] * x.covariance).trace() +
            left.dot(x.covariance * right);
      }
    }
    return moments;
  }
};

Eigen::Matrix2d symmetric(double first, double cross, double second) {
  return (Eigen::Matrix2d() << first, cross, cross, second).finished();
}

Gaussian plane_belief() {
  return {.mean = Eigen::Vector2d(0.4, -0.7), .covariance = symmetric(0.5, 0.2, 0.3)};
}

const Eigen::Matrix2d kNoise = symmetric(0.05, 0.01, 0.02);

/// Two quadratic forms that share terms.
LawCase quadratic_case() {
  return map_case({"0.3*a^2 + 0.4*a*b + b", "a - 0.2*b^2 + 0.5*a*b"}, plane_belief(), kNoise);
}
Gaussian quadratic_moments() {
  Gaussian moments = Quadratics{.curvatures = {symmetric(0.6, 0.4, 0.0), symmetric(0.0, 0.5, -0.4)},
                                .slopes = {{0.0, 1.0}, {1.0, 0.0}}}
                         .moments(plane_belief());
  moments.covariance += kNoise;
  return moments;
}

const std::vector<UnscentedSettings>& unscented_choices() {
  static const std::vector<UnscentedSettings> choices = {
      {},
      {.alpha = 1e-3, .beta = 2.0, .kappa = 0.0},
      {.alpha = 1.0, .beta = 0.0, .kappa = 1.0},  // κ = 3 − d: the fourth moment along an axis
      {.alpha = 1.0, .beta = 1.0, .kappa = 4.0}};
  return choices;
}

TEST(Unscented, mean_is_exact_on_quadratic_maps_whatever_the_settings) {
  for (const UnscentedSettings& settings : unscented_choices()) {
    const StageLaw law = quadratic_case().laws("unscented", {.unscented = settings}).back();
    // Differences over alpha = 1e-3 of the spread lose six of sixteen digits.
    EXPECT_LE((mean_of(law) - quadratic_moments().mean).norm(), 1e-9);
  }
}

// y = a² + ½ a: along one axis the covariance is exact if α² κ + β = 2.
TEST(Unscented, covariance_is_exact_on_a_quadratic_map_of_one_state_where_theory_says_so) {
  const double variance = 0.4;
  const double mean = 0.3;
  const LawCase made = map_case({"a^2 + 0.5*a"},
                                {.mean = Eigen::VectorXd::Constant(1, mean),
                                 .covariance = Eigen::MatrixXd::Constant(1, 1, variance)},
                                Eigen::MatrixXd::Zero(1, 1));
  const double slope = 2.0 * mean + 0.5;
  const double exact = slope * slope * variance + 2.0 * variance * variance;
  for (const UnscentedSettings& settings :
       {UnscentedSettings{}, UnscentedSettings{.alpha = 1.0, .beta = 0.0, .kappa = 2.0},
        UnscentedSettings{.alpha = 0.5, .beta = 1.0, .kappa = 4.0}}) {
    const StageLaw law = made.laws("unscented", {.unscented = settings}).back();
    EXPECT_NEAR(covariance_of(law)(0, 0), exact, 1e-9);
  }
  // And elsewhere it is off by (α² κ + β − 2) P².
  const StageLaw other =
      made.laws("unscented", {.unscented = {.alpha = 1.0, .beta = 0.0, .kappa = 0.5}}).back();
  EXPECT_NEAR(covariance_of(other)(0, 0), exact - 1.5 * variance * variance, 1e-9);
}

TEST(Unscented, refuses_settings_with_covariances_that_may_be_indefinite) {
  const LawCase made = quadratic_case();
  EXPECT_THROW(
      (void)made.laws("unscented", {.unscented = {.alpha = 1.0, .beta = 0.0, .kappa = -0.5}}),
      std::invalid_argument);
  EXPECT_THROW(
      (void)made.laws("unscented", {.unscented = {.alpha = 1.0, .beta = 2.0, .kappa = -2.0}}),
      std::invalid_argument);
  EXPECT_THROW((void)made.laws("gaussian_mixture",
                               {.unscented = {.alpha = 1.0, .beta = 0.0, .kappa = -1.0}}),
               std::invalid_argument);
}

TEST(Linearised, leaves_a_clamped_input_out_of_the_derivative) {
  LawCase made = linear_case(1);
  made.policy.bounds.upper.setConstant(-0.1);  // below the policy's input at the mean, which is 0
  made.policy.bounds.lower.setConstant(-0.2);
  made.policy.inputs.setConstant(0.0);
  Eigen::Matrix2d by_state;
  by_state << 1.0, 0.2, 0.0, 1.0;
  const Eigen::Matrix2d expected =
      by_state * made.belief.covariance * by_state.transpose() + made.noise;
  EXPECT_LE((covariance_of(made.laws("linearised").back()) - expected).norm(), 1e-12);
}

TEST(PolynomialChaos, moments_are_exact_on_polynomials_of_its_order) {
  for (const int most_nodes : {1, 1000}) {  // sparse grid and product grid
    for (const int order : {2, 3, 5}) {
      const StageLaw law = quadratic_case()
                               .laws("polynomial_chaos", {.order = order, .most_nodes = most_nodes})
                               .back();
      EXPECT_LE((mean_of(law) - quadratic_moments().mean).norm(), 1e-12) << order;
      EXPECT_LE((covariance_of(law) - quadratic_moments().covariance).norm(), 1e-12) << order;
    }
  }
}

TEST(PolynomialChaos, moments_of_a_cube_are_exact_from_order_three_on) {
  const double m = 0.5;
  const double p = 0.3;
  const LawCase made = map_case(
      {"a^3"},
      {.mean = Eigen::VectorXd::Constant(1, m), .covariance = Eigen::MatrixXd::Constant(1, 1, p)},
      Eigen::MatrixXd::Constant(1, 1, 0.1));
  const double mean = m * m * m + 3.0 * m * p;
  const double variance =
      9.0 * std::pow(m, 4) * p + 36.0 * m * m * p * p + 15.0 * std::pow(p, 3) + 0.1;
  for (const int order : {3, 4}) {
    const StageLaw law = made.laws("polynomial_chaos", {.order = order}).back();
    EXPECT_NEAR(mean_of(law)[0], mean, 1e-12);
    EXPECT_NEAR(covariance_of(law)(0, 0), variance, 1e-12);
  }
  // A second-order polynomial misses the variance 6 p³ of the third order.
  const StageLaw coarse = made.laws("polynomial_chaos", {.order = 2}).back();
  EXPECT_NEAR(covariance_of(coarse)(0, 0), variance - 6.0 * std::pow(p, 3), 1e-12);
}

// Without noise nothing is lost between stages: two steps of a quadratic map form one of fourth
// order, with a third moment that a Gaussian does not have.
TEST(PolynomialChaos, keeps_the_shape_of_the_law_from_stage_to_stage) {
  const Gaussian belief{.mean = Eigen::VectorXd::Constant(1, 0.5),
                        .covariance = Eigen::MatrixXd::Constant(1, 1, 0.2)};
  const LawCase made = map_case({"a + 0.4*a^2"}, belief, Eigen::MatrixXd::Zero(1, 1), 2);
  const StageLaw law = made.laws("polynomial_chaos", {.order = 4}).back();
  const StandardDraws draws = quasi_random_draws(1, 4096);
  Points first = std::sqrt(0.2) * draws.normals;
  first.array() += 0.5;
  const Eigen::ArrayXd once = first.row(0).array() + 0.4 * first.row(0).array().square();
  const Eigen::ArrayXd twice = once + 0.4 * once.square();
  EXPECT_LE((law_draws(law, draws).row(0).transpose().array() - twice).abs().maxCoeff(), 1e-11);
}

TEST(MonteCarlo, errors_fall_with_the_root_of_the_number_of_samples) {
  constexpr int kSeeds = 40;
  const LawCase made = linear_case(3);
  const Gaussian exact = linear_moments(made).back();
  const auto square_error = [&](int samples) {
    double sum = 0.0;
    for (int seed = 0; seed < kSeeds; ++seed) {
      const StageLaw law =
          made.laws("monte_carlo", {.samples = samples, .seed = static_cast<std::uint64_t>(seed)})
              .back();
      sum += (mean_of(law) - exact.mean).squaredNorm();
    }
    return sum / kSeeds;
  };
  for (const int samples : {100, 2500}) {
    // The mean of 80 squares of nearly normal numbers: within five standard deviations.
    EXPECT_NEAR(square_error(samples) * samples / exact.covariance.trace(), 1.0,
                5.0 * std::sqrt(2.0 / kSeeds));
  }
}

TEST(MonteCarlo, has_the_same_noise_for_every_policy_and_another_for_another_seed) {
  LawCase made = linear_case(3);
  const auto propagator = make_law_propagator("monte_carlo", {.samples = 50});
  const Points first =
      std::get<DiscreteMeasure>(propagator->propagate(made.problem()).back()).locations;
  made.policy.inputs.setConstant(0.3);
  const Points moved =
      std::get<DiscreteMeasure>(propagator->propagate(made.problem()).back()).locations;
  // The system is linear and the noise frozen: all paths are displaced equally.
  const Points displaced = moved - first;
  EXPECT_GT(displaced.norm(), 0.01);
  EXPECT_LE((displaced.colwise() - Eigen::VectorXd(displaced.col(0))).norm(), 1e-12);
  EXPECT_NE(std::get<DiscreteMeasure>(made.laws("monte_carlo", {.samples = 50, .seed = 9}).back())
                .locations,
            moved);
}

/// A car with a large spread of its heading, in open loop.
LawCase turning_car(double noise) {
  LawCase made{.dynamics = models::make_dynamics("dubins", {{"speed", 1.5}}, 0.1),
               .belief = {.mean = Eigen::Vector3d::Zero(),
                          .covariance = Eigen::Vector3d(0.0025, 0.0025, 0.36).asDiagonal()},
               .noise = noise * Eigen::Vector3d(0.002, 0.002, 0.004).asDiagonal(),
               .policy = {}};
  made.policy = unbounded_policy(*made.dynamics, made.belief.mean, 10, Eigen::MatrixXd::Zero(1, 3));
  made.policy.inputs.setConstant(0.3);
  made.policy.states = nominal_states(*made.dynamics, made.belief.mean, made.policy.inputs);
  return made;
}

/// Mean and covariance at its last stage, in closed form.
Gaussian turning_moments(const LawCase& made) {
  const DubinsProblem car{
      .belief = made.belief, .noise_covariance = made.noise, .cost = {}, .bounds = {}};
  const DubinsMoments moments = dubins_moments(car, made.policy.inputs).back();
  return {.mean = moments.mean,
          .covariance = moments.second - moments.mean * moments.mean.transpose()};
}

/// W2 of the marginals in x and in y to those of so many simulated paths, the larger one.
double larger_marginal_w2(const StageLaw& law, const Points& paths) {
  const Points drawn = law_draws(law, quasi_random_draws(3, paths.cols()));
  double larger = 0.0;
  for (const int axis : {0, 1}) {
    std::vector<double> first(drawn.row(axis).begin(), drawn.row(axis).end());
    std::vector<double> second(paths.row(axis).begin(), paths.row(axis).end());
    std::ranges::sort(first);
    std::ranges::sort(second);
    double square = 0.0;
    for (std::size_t i = 0; i < first.size(); ++i) square += std::pow(first[i] - second[i], 2);
    larger = std::max(larger, std::sqrt(square / static_cast<double>(first.size())));
  }
  return larger;
}

TEST(GaussianMixture, converges_to_the_truth_as_components_are_added) {
  constexpr int kPaths = 100'000;
  for (const double noise : {0.0, 1.0}) {
    const LawCase made = turning_car(noise);
    const Gaussian exact = turning_moments(made);
    const Points paths =
        std::get<DiscreteMeasure>(made.laws("monte_carlo", {.samples = kPaths, .seed = 5}).back())
            .locations;
    // W2 between n paths and their law is about σ √(2.5/n) in one dimension.
    const double floor =
        std::sqrt(2.5 / kPaths * exact.covariance.topLeftCorner<2, 2>().diagonal().maxCoeff());
    double distance_before = std::numeric_limits<double>::infinity();
    std::vector<double> distances;
    std::vector<double> covariances;
    for (const int components : {1, 3, 9, 27}) {
      const StageLaw law = made.laws("gaussian_mixture", {.components = components}).back();
      const double distance = larger_marginal_w2(law, paths);
      const double covariance =
          (covariance_of(law) - exact.covariance).norm() / exact.covariance.norm();
      EXPECT_LT(distance, distance_before + floor) << components << ", noise " << noise;
      distances.push_back(distance);
      distance_before = distance;
      covariances.push_back(covariance);
    }
    EXPECT_LT(distances[3], distances[0] / 6.0) << noise;
    // Nine components have the whole covariance except the loss by merging and tolerances.
    EXPECT_LT(covariances[1], covariances[0] / 4.0) << noise;
    EXPECT_LT(covariances[2], covariances[1] / 4.0) << noise;
    EXPECT_LT(covariances[3], 0.005) << noise;
  }
}

/// The double integrator under a feedback that is clamped on both sides, or on one.
LawCase clamped_case(double lower, double upper) {
  LawCase made = linear_case(6);
  made.policy.bounds = {.lower = Eigen::VectorXd::Constant(1, lower),
                        .upper = Eigen::VectorXd::Constant(1, upper)};
  return made;
}

double covariance_error(const LawCase& made, const std::string& method,
                        const LawSettings& settings = {}) {
  const Eigen::MatrixXd truth =
      covariance_of(made.laws("monte_carlo", {.samples = 50'000, .seed = 3}).back());
  return (covariance_of(made.laws(method, settings).back()) - truth).norm() / truth.norm();
}

TEST(GaussianMixture, is_split_by_a_clamp_that_is_odd_about_the_mean) {
  const LawCase made = clamped_case(-0.2, 0.2);
  EXPECT_GT(std::get<GaussianMixture>(made.laws("gaussian_mixture").back()).size(), 1);
  EXPECT_LT(covariance_error(made, "gaussian_mixture"), 0.5 * covariance_error(made, "unscented"));
}

TEST(Unscented, amplifies_a_clamp_at_the_mean_far_less_than_with_a_tiny_alpha) {
  const LawCase made = clamped_case(-1e6, 0.0);
  EXPECT_LT(covariance_error(made, "unscented"), 1.0);
  EXPECT_GT(covariance_error(made, "unscented", {.unscented = {.alpha = 1e-3}}), 10.0);
}

TEST(GaussianMixture, of_one_component_is_the_unscented_transform) {
  const LawCase made = turning_car(1.0);
  const StageLaw one = made.laws("gaussian_mixture", {.components = 1}).back();
  const StageLaw unscented = made.laws("unscented").back();
  EXPECT_EQ(mean_of(one), mean_of(unscented));
  EXPECT_EQ(covariance_of(one), covariance_of(unscented));
}

TEST(GaussianMixture, is_not_split_where_nothing_bends) {
  for (const StageLaw& law : linear_case().laws("gaussian_mixture")) {
    EXPECT_EQ(std::get<GaussianMixture>(law).size(), 1);
  }
}

TEST(PolynomialChaos, moments_converge_to_the_exact_ones_as_the_order_grows) {
  for (const double noise : {0.0, 1.0}) {
    const LawCase made = turning_car(noise);
    const Gaussian exact = turning_moments(made);
    double before = 1.0;
    for (const int order : {1, 2, 3, 5}) {
      const StageLaw law = made.laws("polynomial_chaos", {.order = order}).back();
      const double covariance =
          (covariance_of(law) - exact.covariance).norm() / exact.covariance.norm();
      EXPECT_LT(covariance, before) << order << ", noise " << noise;
      before = covariance;
    }
    EXPECT_LT(before, 1e-3);
  }
}

}  // namespace law_accuracy_test
}  // namespace qsmpc::controller
