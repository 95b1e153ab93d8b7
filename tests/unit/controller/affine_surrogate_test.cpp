#include "controller/certification/affine_surrogate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "models/dynamics/dubins.hpp"
#include "models/dynamics/templated_dynamics.hpp"
#include "tests/unit/controller/planner_fixture.hpp"
#include "tests/unit/controller/random_measures.hpp"

namespace qsmpc::testing {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kSamples = 10000;

/// A prescribed plan with all that its motion refers to.
struct Case {
  std::string name;
  std::shared_ptr<const Dynamics> dynamics;
  Gaussian belief;
  PlannerSettings settings;
  std::shared_ptr<Planner> planner;
  Plan plan;

  [[nodiscard]] PredictedMotion motion() const { return motion_of(*planner, belief, plan); }
};

/// How a case's inputs are fed back: not at all, by LQR, or by this gain.
struct Feedback {
  bool closed_loop = false;
  std::optional<Eigen::MatrixXd> gain = std::nullopt;
};

Case make_case(const std::string& name, std::shared_ptr<const Dynamics> dynamics,
               const Gaussian& belief, const Eigen::MatrixXd& noise, const Eigen::VectorXd& input,
               const Feedback& feedback, int horizon = 8) {
  const int dim = dynamics->state_dim();
  PlannerSettings settings;
  settings.horizon = horizon;
  settings.closed_loop = feedback.closed_loop;
  settings.feedback_gain = feedback.gain;
  settings.state_points = 8;  // the surrogates do not depend on the particles
  settings.noise_points = 4;
  settings.compressed_points = 8;
  settings.noise_covariance = noise;
  settings.cost = {.state = Eigen::MatrixXd::Identity(dim, dim),
                   .input = 0.1 * Eigen::MatrixXd::Identity(input.size(), input.size()),
                   .terminal = Eigen::MatrixXd::Identity(dim, dim),
                   .target = Eigen::VectorXd::Zero(dim)};
  settings.safe_set = unbounded_safe_set(dim);
  settings.bounds = {.lower = dynamics->description().input_lower,
                     .upper = dynamics->description().input_upper};
  Case result{.name = name,
              .dynamics = dynamics,
              .belief = belief,
              .settings = settings,
              .planner = std::make_shared<Planner>(*dynamics, settings),
              .plan = {}};
  result.plan = result.planner->prescribe(belief, input.replicate(1, horizon));
  return result;
}

Gaussian around(const Eigen::VectorXd& mean, const Eigen::VectorXd& deviation) {
  return {.mean = mean, .covariance = deviation.cwiseAbs2().asDiagonal()};
}

Case dubins(const Feedback& feedback, double input = 0.3, double width = 0.1) {
  return make_case("dubins", dubins_car(),
                   around(Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(width)),
                   Eigen::Vector3d(0.01, 0.01, 0.001).asDiagonal(),
                   Eigen::VectorXd::Constant(1, input), feedback);
}

/// Everything correlated with everything.
Case skewed_dubins(const Feedback& feedback, Generator& generator) {
  return make_case(
      "skewed dubins", dubins_car(),
      {.mean = Eigen::Vector3d(1.0, 2.0, 0.7), .covariance = random_spd(generator, 3, 0.02)},
      random_spd(generator, 3, 0.01), Eigen::VectorXd::Constant(1, 0.4), feedback);
}

Case double_integrator(const Feedback& feedback, double input = 0.5, double width = 0.1) {
  return make_case("double integrator", make_dynamics("double_integrator", {}, 0.1),
                   around(Eigen::Vector2d(1.0, 0.2), Eigen::Vector2d(width, width)),
                   Eigen::Vector2d(1e-4, 1e-3).asDiagonal(), Eigen::VectorXd::Constant(1, input),
                   feedback);
}

Case bicycle(const Feedback& feedback, double speed = 10.0, double width = 1.0) {
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(6);
  mean[3] = speed;
  Eigen::VectorXd deviation(6);
  deviation << 0.1, 0.1, 0.03, 0.2, 0.1, 0.05;
  Eigen::VectorXd noise(6);
  noise << 0.03, 0.03, 0.01, 0.05, 0.03, 0.02;
  return make_case("bicycle", make_dynamics("bicycle", {}, 0.1), around(mean, width * deviation),
                   noise.cwiseAbs2().asDiagonal(), Eigen::Vector2d(0.2, 0.03), feedback);
}

Case cart_pole(const Feedback& feedback, double width = 1.0) {
  Eigen::Vector4d deviation(0.05, 0.05, 0.02, 0.05);
  return make_case("cart-pole", make_dynamics("cart_pole", {}, 0.05),
                   around(Eigen::Vector4d(0.0, 0.1, 0.05, 0.0), width * deviation),
                   (0.02 * Eigen::Vector4d::Ones()).cwiseAbs2().asDiagonal(),
                   Eigen::VectorXd::Constant(1, 1.0), feedback);
}

/// Paths of the state and of its surrogate under the same draws; stages 0 … horizon.
struct Pairs {
  std::vector<Points> state;
  std::vector<Points> surrogate;
  std::vector<Points> noise;  ///< of the step that leads to the stage; at 0 what the belief drew
};

Pairs simulate_pairs(const PredictedMotion& motion, const std::vector<SurrogateStage>& stages,
                     Generator& generator) {
  NormalSampler belief(motion.belief.covariance);
  NormalSampler noise(motion.noise_covariance);
  const Eigen::Index dim = motion.belief.mean.size();
  const auto draws = [&](NormalSampler& sampler) {
    Points result(dim, kSamples);
    for (int i = 0; i < kSamples; ++i) result.col(i) = sampler(generator);
    return result;
  };
  Pairs pairs;
  pairs.noise.push_back(draws(belief));
  pairs.state.push_back(pairs.noise[0].colwise() + motion.belief.mean);
  pairs.surrogate.push_back(pairs.state[0]);
  for (Eigen::Index k = 0; k < motion.policy.horizon(); ++k) {
    pairs.noise.push_back(draws(noise));
    Points inputs(motion.policy.inputs.rows(), kSamples);
    Points next(dim, kSamples);
    policy_inputs(motion.policy, k, pairs.state[k], inputs);
    motion.dynamics.step(pairs.state[k], inputs, next);
    pairs.state.push_back(next + pairs.noise.back());
    const Points offset = pairs.surrogate[k].colwise() - stages[k].law.mean;
    pairs.surrogate.push_back(((stages[k].transition * offset).colwise() + stages[k + 1].law.mean) +
                              pairs.noise.back());
  }
  return pairs;
}

Eigen::VectorXd root_mean_squares(const Points& values) {
  return (values.rowwise().squaredNorm() / static_cast<double>(values.cols())).cwiseSqrt();
}

Eigen::MatrixXd sample_covariance(const Points& first, const Points& second) {
  const Points a = first.colwise() - first.rowwise().mean();
  const Points b = second.colwise() - second.rowwise().mean();
  return a * b.transpose() / static_cast<double>(a.cols());
}

/// All systems, open loop, regulated, and with gains that nobody would choose; some of them
/// saturated more often than not.
std::vector<Case> all_cases(Generator& generator) {
  const Feedback lqr{.closed_loop = true};
  const auto gain = [](const Eigen::MatrixXd& matrix) {
    return Feedback{.closed_loop = true, .gain = matrix};
  };
  return {dubins({}),
          skewed_dubins({}, generator),
          dubins(lqr),
          skewed_dubins(lqr, generator),
          dubins(gain(Eigen::RowVector3d(4.0, -6.0, -8.0)), 1.5, 0.3),
          double_integrator({}),
          double_integrator(lqr),
          double_integrator(lqr, 1.9, 0.5),
          double_integrator(gain(random_matrix(generator, 1, 2, 10.0))),
          bicycle({}),
          bicycle(lqr),
          bicycle(gain(random_matrix(generator, 2, 6, 0.05))),
          cart_pole({}),
          cart_pole(lqr),
          cart_pole(gain(Eigen::RowVector4d(3.0, 4.0, 40.0, 8.0)))};
}

TEST(AffineSurrogate, law_is_that_of_simulated_paths) {
  Generator generator(111);
  for (const Case& one : all_cases(generator)) {
    const PredictedMotion motion = one.motion();
    const std::vector<SurrogateStage> stages = affine_surrogates(motion);
    const Pairs pairs = simulate_pairs(motion, stages, generator);
    ASSERT_EQ(stages.size(), 9U);
    for (std::size_t k = 0; k < stages.size(); ++k) {
      const Gaussian& law = stages[k].law;
      const Eigen::MatrixXd covariance = sample_covariance(pairs.surrogate[k], pairs.surrogate[k]);
      const Eigen::VectorXd mean = pairs.surrogate[k].rowwise().mean();
      const Eigen::VectorXd deviation = law.covariance.diagonal().cwiseSqrt();
      // Five standard errors; that of a covariance is at most √2 of the deviations' product.
      const double five = 5.0 / std::sqrt(kSamples);
      for (Eigen::Index i = 0; i < mean.size(); ++i) {
        EXPECT_NEAR(mean[i], law.mean[i], five * deviation[i]) << one.name << k;
        for (Eigen::Index j = 0; j < mean.size(); ++j) {
          EXPECT_NEAR(covariance(i, j), law.covariance(i, j),
                      1.5 * five * deviation[i] * deviation[j])
              << one.name << k;
        }
      }
      EXPECT_EQ(law.covariance, law.covariance.transpose());
    }
  }
}

TEST(AffineSurrogate, error_and_region_bound_what_simulated_states_do) {
  Generator generator(112);
  for (const Case& one : all_cases(generator)) {
    const PredictedMotion motion = one.motion();
    const std::vector<SurrogateStage> stages = affine_surrogates(motion);
    const Pairs pairs = simulate_pairs(motion, stages, generator);
    EXPECT_EQ(stages[0].error, Eigen::VectorXd::Zero(stages[0].error.size()));
    EXPECT_EQ(stages[0].leaving, 0.0);
    for (std::size_t k = 0; k < stages.size(); ++k) {
      const Eigen::VectorXd distance = root_mean_squares(pairs.state[k] - pairs.surrogate[k]);
      for (Eigen::Index i = 0; i < distance.size(); ++i) {
        // Squares of second and third order in normal variables: their sample's root is within 10
        // %. Sums of numbers of order one are rounded even where nothing separates the two.
        EXPECT_LE(distance[i], 1.1 * stages[k].error[i] + 1e-14)
            << one.name << ", stage " << k << ", coordinate " << i;
      }
      for (std::size_t order = 0; order < kHigherOrders.size(); ++order) {
        const Points offset = pairs.state[k] - pairs.surrogate[k];
        const double p = kHigherOrders[order];
        const Eigen::VectorXd norms =
            offset.array().abs().pow(p).rowwise().mean().pow(1.0 / p).matrix();
        for (Eigen::Index i = 0; i < norms.size(); ++i) {
          // Sample means of these powers are below the truth more often than above it.
          EXPECT_LE(norms[i], 1.1 * stages[k].higher[order][i] + 1e-14)
              << one.name << ", stage " << k << ", coordinate " << i << ", order " << p;
        }
      }
      EXPECT_LE(stages[k].leaving, 1e-5);
      EXPECT_GE(stages[k].leaving, k == 0 ? 0.0 : stages[k - 1].leaving);
      // 1e-5 of 10,000 paths are a tenth of a path.
      const auto below = pairs.state[k].colwise() - stages[k].region.lower;
      const auto above = (-pairs.state[k]).colwise() + stages[k].region.upper;
      const auto inside =
          (below.array() >= 0.0).colwise().all() && (above.array() >= 0.0).colwise().all();
      EXPECT_EQ(inside.count(), kSamples) << one.name << ", stage " << k;
    }
  }
}

TEST(AffineSurrogate, error_is_tight_where_the_step_is_nearly_affine) {
  Generator generator(113);
  struct Expected {
    Case one;
    double ratio;
  };
  // Open loop the unicycle's error is exact. Elsewhere the last stage's error is at most this many
  // times what simulated paths show.
  const Feedback lqr{.closed_loop = true};
  for (const Expected& expected : std::vector<Expected>{{dubins({}), 1.1},
                                                        {skewed_dubins({}, generator), 1.15},
                                                        {dubins(lqr), 1.2},
                                                        {skewed_dubins(lqr, generator), 2.0},
                                                        {bicycle({}), 3.0},
                                                        {bicycle(lqr), 5.0}}) {
    const PredictedMotion motion = expected.one.motion();
    const std::vector<SurrogateStage> stages = affine_surrogates(motion);
    const Pairs pairs = simulate_pairs(motion, stages, generator);
    const Eigen::VectorXd distance = root_mean_squares(pairs.state.back() - pairs.surrogate.back());
    for (Eigen::Index i = 0; i < 2; ++i) {
      EXPECT_LE(stages.back().error[i], expected.ratio * distance[i]) << expected.one.name << i;
    }
  }
}

TEST(AffineSurrogate, known_example_has_the_known_error) {
  // Belief N(0, 0.01 I), u = 0.3, noise diag(0.01, 0.01, 0.001), 0.15 m a step: 0.0104 at stage 8.
  const Case one = dubins({});
  const std::vector<SurrogateStage> stages = affine_surrogates(one.motion());
  ASSERT_EQ(stages.size(), 9U);
  EXPECT_NEAR(stages.back().error.norm(), 0.0104, 5e-5);  // as printed
  EXPECT_EQ(stages.back().error[Dubins::kHeading], 0.0);
  EXPECT_EQ(stages.back().leaving, 0.0);
}

TEST(AffineSurrogate, is_the_state_of_an_affine_system_that_never_saturates) {
  const Case one = double_integrator({});
  for (const SurrogateStage& stage : affine_surrogates(one.motion())) {
    EXPECT_EQ(stage.error, Eigen::Vector2d::Zero());
    EXPECT_EQ(stage.leaving, 0.0);
    EXPECT_EQ(stage.region.lower, Eigen::Vector2d::Constant(-kInfinity));
    EXPECT_EQ(stage.region.upper, Eigen::Vector2d::Constant(kInfinity));
  }
}

TEST(AffineSurrogate, regions_are_charged_for) {
  // A region that not everything is certain to be in costs, also where the error needs none.
  Generator generator(114);
  for (const Case& one : all_cases(generator)) {
    const std::vector<SurrogateStage> stages = affine_surrogates(one.motion());
    for (std::size_t k = 0; k + 1 < stages.size(); ++k) {
      const bool everything = (stages[k].region.lower.array() == -kInfinity).all() &&
                              (stages[k].region.upper.array() == kInfinity).all();
      if (!everything) {
        EXPECT_GT(stages[k + 1].leaving, stages[k].leaving) << one.name << k;
      }
    }
  }
}

TEST(AffineSurrogate, car_at_rest_is_its_surrogate) {
  const Case one = make_case("car at rest", make_dynamics("dubins", {{"speed", 0.0}}, 0.1),
                             dubins_belief(), 0.01 * Eigen::Matrix3d::Identity(),
                             Eigen::VectorXd::Constant(1, 0.3), {.closed_loop = true});
  const std::vector<SurrogateStage> stages = affine_surrogates(one.motion());
  EXPECT_LT(stages.back().leaving, 1e-5);
  EXPECT_LT(stages.back().error.maxCoeff(), 1e-3);
}

void expect_lost(const SurrogateStage& stage) {
  EXPECT_TRUE((stage.error.array() == kInfinity).all());
  EXPECT_EQ(stage.leaving, 1.0);
  EXPECT_TRUE((stage.region.lower.array() == -kInfinity).all());
  EXPECT_TRUE((stage.region.upper.array() == kInfinity).all());
  EXPECT_EQ(stage.transition.size(), 0);
}

TEST(AffineSurrogate, pole_in_reach_loses_everything) {
  // The bicycle's first pole is at −15.2 m/s: five and a half deviations of 5 m/s reach it.
  const Case one = bicycle({}, 10.0, 25.0);
  const std::vector<SurrogateStage> stages = affine_surrogates(one.motion());
  for (std::size_t k = 1; k < stages.size(); ++k) expect_lost(stages[k]);
}

TEST(AffineSurrogate, error_that_explodes_ends_as_lost_and_is_never_nan) {
  Generator generator(1);
  const Case one = bicycle({true, random_matrix(generator, 2, 6, 3.0)});
  bool lost = false;
  for (const SurrogateStage& stage : affine_surrogates(one.motion())) {
    EXPECT_FALSE(stage.error.array().isNaN().any());
    EXPECT_FALSE(std::isnan(stage.leaving));
    lost = lost || stage.leaving == 1.0;
    if (lost) expect_lost(stage);
  }
  EXPECT_TRUE(lost);
}

TEST(AffineSurrogate, system_without_derivative_bounds_loses_everything) {
  const Case one = make_case("fragile car", std::make_shared<FragileCar>(), dubins_belief(),
                             0.01 * Eigen::Matrix3d::Identity(), Eigen::VectorXd::Zero(1), {});
  const std::vector<SurrogateStage> stages = affine_surrogates(one.motion());
  for (std::size_t k = 1; k < stages.size(); ++k) expect_lost(stages[k]);
}

TEST(AffineSurrogate, plan_that_is_not_finite_loses_everything) {
  for (Case one : {dubins({}), double_integrator({}), bicycle({}), cart_pole({})}) {
    one.plan.policy.states.rightCols(6).setConstant(std::nan(""));
    const std::vector<SurrogateStage> stages = affine_surrogates(one.motion());
    for (std::size_t k = 0; k < 4; ++k) EXPECT_LT(stages[k].leaving, 1e-5) << one.name;
    for (std::size_t k = 4; k < stages.size(); ++k) expect_lost(stages[k]);
  }
}

/// x⁺ = x + T u³: affine in the state, and not in the input.
struct CubicInput {
  static constexpr int kStateDim = 1;
  static constexpr int kInputDim = 1;
  template <class Scalar>
  void step(const Scalar* x, const Scalar* u, Scalar* next) const {
    next[0] = x[0] + 0.1 * (u[0] * u[0] * u[0]);
  }
  [[nodiscard]] SystemDescription description() const {
    SystemDescription description;
    description.name = "cubic input";
    description.states = {{"x", "m"}};
    description.inputs = {{"u", "m^(1/3)"}};
    description.input_lower = Eigen::VectorXd::Constant(1, -10.0);
    description.input_upper = Eigen::VectorXd::Constant(1, 10.0);
    return description;
  }
  [[nodiscard]] double lipschitz(const Eigen::Ref<const Eigen::MatrixXd>&) const {
    return kInfinity;
  }
};

TEST(AffineSurrogate, curvature_in_an_input_needs_the_core) {
  // The second derivative is bounded on the core's inputs only.
  const Case one =
      make_case("cubic input", std::make_shared<TemplatedDynamics<CubicInput>>(CubicInput{}),
                around(Eigen::VectorXd::Zero(1), Eigen::VectorXd::Ones(1)),
                0.01 * Eigen::MatrixXd::Ones(1, 1), Eigen::VectorXd::Constant(1, 0.2),
                {.closed_loop = true, .gain = -Eigen::MatrixXd::Ones(1, 1)});
  const std::vector<SurrogateStage> stages = affine_surrogates(one.motion());
  EXPECT_GT(stages[1].error[0], 0.0);
  EXPECT_GT(stages[1].leaving, 0.0);
}

TEST(Smoothing, is_a_part_of_the_surrogate) {
  Generator generator(115);
  for (const Case& one : all_cases(generator)) {
    const PredictedMotion motion = one.motion();
    const std::vector<SurrogateStage> stages = affine_surrogates(motion);
    const Eigen::Index dim = motion.belief.mean.size();
    for (Eigen::Index k = 1; k < static_cast<Eigen::Index>(stages.size()); ++k) {
      for (Eigen::Index axis = 0; axis < dim; ++axis) {
        const std::vector<Eigen::Index> axes = {0, axis};
        const Eigen::MatrixXd smoothing = smoothing_covariance(motion, k, axes);
        const Eigen::MatrixXd& covariance = stages[k].law.covariance;
        const auto least = [](const Eigen::MatrixXd& matrix) {
          return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues()[0];
        };
        EXPECT_GE(least(smoothing), -1e-15) << one.name;
        // n is independent of the rest in the coordinates of `axes`, and only there.
        const Eigen::MatrixXd rest = covariance - smoothing;
        EXPECT_GE(least(rest(axes, axes)), -1e-14 * covariance.trace())
            << one.name << ", stage " << k << ", axis " << axis;
        EXPECT_GT(smoothing(0, 0), 0.0);
      }
    }
  }
}

TEST(Smoothing, has_the_known_form_for_the_known_example) {
  // Nothing is correlated: open loop all of the belief and of the noise in the position counts;
  // with feedback what two noises bring, at first the belief and one.
  const std::vector<Eigen::Index> position = {0, 1};
  const std::vector<Eigen::Index> all = {0, 1, 2};
  const Eigen::Matrix3d noise = Eigen::Vector3d(0.01, 0.01, 0.001).asDiagonal();
  Eigen::Matrix3d planar = noise;
  planar(2, 2) = 0.0;
  const Case open = dubins({});
  const Case closed = dubins({.closed_loop = true});
  for (Eigen::Index k = 1; k <= 8; ++k) {
    const double steps = static_cast<double>(k);
    for (const auto& axes : {position, all}) {
      EXPECT_LE((smoothing_covariance(open.motion(), k, axes) - (steps + 1.0) * planar).norm(),
                1e-15);
    }
    EXPECT_LE((smoothing_covariance(closed.motion(), k, position) - 2.0 * planar).norm(), 1e-15);
    EXPECT_EQ(smoothing_covariance(closed.motion(), k, all), noise);
    EXPECT_EQ(smoothing_covariance(closed.motion(), k, {2}), noise);
  }
  const Case cart = cart_pole({});
  EXPECT_EQ(smoothing_covariance(cart.motion(), 3, {0}), cart.settings.noise_covariance);
}

TEST(Smoothing, leaves_out_what_moves_a_restricted_heading) {
  Generator generator(117);
  const Case one = skewed_dubins({}, generator);
  const auto beside = [](const Eigen::MatrixXd& covariance) {
    const Eigen::Vector2d cross = covariance.col(2).head<2>();
    return Eigen::Matrix2d(covariance.topLeftCorner<2, 2>() -
                           cross * cross.transpose() / covariance(2, 2));
  };
  const Eigen::Matrix2d expected =
      beside(one.belief.covariance) + 3.0 * beside(one.settings.noise_covariance);
  const Eigen::MatrixXd smoothing = smoothing_covariance(one.motion(), 3, {0, 2});
  EXPECT_LE((smoothing.topLeftCorner<2, 2>() - expected).norm(), 1e-15);
  EXPECT_EQ(smoothing.row(2), Eigen::RowVector3d::Zero());
}

/// What of the positions in `draws` is independent of their headings, under `covariance`.
Points beside_heading(const Points& draws, const Eigen::MatrixXd& covariance) {
  const Eigen::Vector2d slope = covariance.col(2).head<2>() / covariance(2, 2);
  return draws.topRows(2) - slope * draws.row(2);
}

TEST(Smoothing, is_independent_of_the_error_and_of_the_rest) {
  // n put together from the draws themselves, beside z − n and the error of the position, and
  // beside the squares of the two: none may be correlated.
  Generator generator(116);
  for (const bool closed_loop : {false, true}) {
    const Case one = skewed_dubins({.closed_loop = closed_loop}, generator);
    const PredictedMotion motion = one.motion();
    const std::vector<SurrogateStage> stages = affine_surrogates(motion);
    const Pairs pairs = simulate_pairs(motion, stages, generator);
    for (Eigen::Index k = 1; k <= 8; ++k) {
      Points part = pairs.noise[k].topRows(2);
      const Eigen::Index first = closed_loop ? std::max<Eigen::Index>(k - 1, 0) : 0;
      for (Eigen::Index j = k - 1; j >= first; --j) {
        part += beside_heading(pairs.noise[j],
                               j == 0 ? motion.belief.covariance : motion.noise_covariance);
      }
      const Eigen::Matrix2d expected =
          smoothing_covariance(motion, k, {0, 1}).topLeftCorner<2, 2>();
      const double five = 5.0 / std::sqrt(kSamples);
      EXPECT_LE((sample_covariance(part, part) - expected).cwiseAbs().maxCoeff(),
                1.5 * five * expected.diagonal().maxCoeff());
      Points others(8, kSamples);
      others << pairs.surrogate[k].topRows(2) - part,
          (pairs.state[k] - pairs.surrogate[k]).topRows(2), Points::Zero(4, kSamples);
      others.bottomRows(4) = others.topRows(4).cwiseAbs2();
      const Eigen::MatrixXd both = sample_covariance(part, others);
      const Eigen::VectorXd spread = sample_covariance(others, others).diagonal().cwiseSqrt();
      for (Eigen::Index i = 0; i < 2; ++i) {
        for (Eigen::Index j = 0; j < others.rows(); ++j) {
          EXPECT_LE(std::abs(both(i, j)), five * std::sqrt(expected(i, i)) * spread[j])
              << closed_loop << ", stage " << k << ", " << j;
        }
      }
    }
  }
}

}  // namespace
}  // namespace qsmpc::testing
