#include "tests/support/prediction_quality.hpp"

#include <memory>

#include "controller/measure/quantisation/gaussian_quantiser.hpp"
#include "controller/measure/wasserstein.hpp"
#include "controller/prediction/policy.hpp"
#include "controller/prediction/prediction.hpp"
#include "controller/prediction/propagator.hpp"
#include "models/dynamics/dynamics.hpp"
#include "models/linear_algebra.hpp"

namespace qsmpc::testing {
namespace {

constexpr double kCarSpeed = 1.5;          // m/s
constexpr double kYawRate = 0.3;           // rad/s
constexpr double kCarTimeStep = 0.1;       // s
constexpr double kInitialVariance = 0.01;  // m², m², rad²
constexpr int kDim = 3;

std::unique_ptr<const models::Dynamics> make_car() {
  return models::make_dynamics("dubins", {{"speed", kCarSpeed}}, kCarTimeStep);
}

controller::Points normal_points(int count, std::mt19937_64& generator) {
  std::normal_distribution<double> normal;
  return controller::Points::NullaryExpr(kDim, count, [&] { return normal(generator); });
}

controller::DiscreteMeasure uniform_measure(const controller::Points& points) {
  return {.locations = points,
          .weights =
              Eigen::VectorXd::Constant(points.cols(), 1.0 / static_cast<double>(points.cols()))};
}

double squared_distance(const controller::DiscreteMeasure& first,
                        const controller::DiscreteMeasure& second) {
  const double distance = controller::wasserstein2(first, second);
  return distance * distance;
}

}  // namespace

std::vector<controller::DiscreteMeasure> quality_prediction(const QualityProblem& problem,
                                                            const std::string& propagator,
                                                            int points) {
  const std::unique_ptr<const models::Dynamics> car = make_car();
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(kDim);
  const controller::GaussianQuantisation belief = controller::quantise(
      {.mean = zero, .covariance = kInitialVariance * Eigen::MatrixXd::Identity(kDim, kDim)},
      points, controller::QuantiserKind::kLloyd);
  const Eigen::MatrixXd inputs = Eigen::MatrixXd::Constant(1, problem.steps, kYawRate);
  const controller::Policy policy{
      .inputs = inputs,
      .states = controller::nominal_states(*car, zero, inputs),
      .gains = std::vector<Eigen::MatrixXd>(problem.steps, Eigen::MatrixXd::Zero(1, kDim)),
      .bounds = {.lower = Eigen::VectorXd::Constant(1, -kYawRate),
                 .upper = Eigen::VectorXd::Constant(1, kYawRate)}};
  return controller::predict(
             *car,
             *controller::make_propagator(
                 propagator, {.noise = {.mean = zero, .covariance = problem.noise_covariance},
                              .noise_points = points,
                              .compressed_points = points}),
             belief.measure, policy)
      .stages;
}

std::vector<controller::DiscreteMeasure> simulated_states(const QualityProblem& problem, int count,
                                                          unsigned seed, unsigned stream) {
  std::seed_seq sequence{seed, stream};
  std::mt19937_64 generator(sequence);
  const std::unique_ptr<const models::Dynamics> car = make_car();
  const Eigen::MatrixXd root = models::cholesky_factor(problem.noise_covariance);
  const models::StateBatch inputs = models::StateBatch::Constant(1, count, kYawRate);
  models::StateBatch states = std::sqrt(kInitialVariance) * normal_points(count, generator);
  models::StateBatch next(kDim, count);
  std::vector<controller::DiscreteMeasure> result = {uniform_measure(states)};
  for (int step = 0; step < problem.steps; ++step) {
    car->step(states, inputs, next);
    states = next + root * normal_points(count, generator);
    result.push_back(uniform_measure(states));
  }
  return result;
}

std::vector<SquaredDistances> squared_distances(
    const QualityProblem& problem,
    const std::vector<std::vector<controller::DiscreteMeasure>>& predictions,
    const QualitySettings& settings) {
  constexpr unsigned kReferenceStream = 0;
  constexpr unsigned kSampleStream = 1;
  const Eigen::ArrayXd none = Eigen::ArrayXd::Zero(settings.seeds);
  std::vector<SquaredDistances> result(
      problem.steps + 1,
      {.monte_carlo = none, .predictions = std::vector<Eigen::ArrayXd>(predictions.size(), none)});
  for (int seed = 0; seed < settings.seeds; ++seed) {
    const auto reference = simulated_states(problem, settings.reference, seed, kReferenceStream);
    const auto samples = simulated_states(problem, settings.samples, seed, kSampleStream);
    for (int step = 0; step <= problem.steps; ++step) {
      result[step].monte_carlo[seed] = squared_distance(samples[step], reference[step]);
      for (std::size_t i = 0; i < predictions.size(); ++i) {
        result[step].predictions[i][seed] = squared_distance(predictions[i][step], reference[step]);
      }
    }
  }
  return result;
}

}  // namespace qsmpc::testing
