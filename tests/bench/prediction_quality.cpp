// Table 5-1 of the reference thesis, extended by what is attainable: the W2 distance of a
// prediction with 100 points and of 100 Monte Carlo samples to a Monte Carlo reference.
//
//   prediction_quality [--seeds N] [--reference N] [--law N] [--propagator NAME]
//
// Defaults: 20 seeds, 2,000 samples, 50,000 for "ideal", moment_matched. The thesis prints its
// noise covariance as diag(0.01, 0.01, 0.001); its numbers, which grow like squares, fit 0.015 I to
// 0.02 I better, so all three are shown. "ideal" is a 100-point quantiser of the step's true law,
// made by Lloyd's method from samples of it: about as close as 100 points can be expected to come
// to a reference that they do not know. Exits with 1 if the prediction is not closer than the
// samples at some step.
#include "tests/support/prediction_quality.hpp"

#include <cmath>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "controller/measure/compression/compression.hpp"

namespace qsmpc::testing {
namespace {

// Table 5-1, as printed. They grow in proportion to the step, as squares of W2 do.
const std::vector<double> kPublishedSamples = {0.00688, 0.01027, 0.02308, 0.02394, 0.04091,
                                               0.04543, 0.06080, 0.06177, 0.07279, 0.08266};
const std::vector<double> kPublishedPrediction = {0.00233, 0.00619, 0.01031, 0.01621, 0.02429,
                                                  0.03149, 0.03824, 0.04543, 0.05733, 0.06838};

struct Options {
  QualitySettings quality;
  int law = 50000;  // samples for the ideal points
  std::string propagator = "moment_matched";
};

std::vector<controller::DiscreteMeasure> ideal_points(const QualityProblem& problem, int samples) {
  constexpr int kRounds = 60;
  constexpr int kPoints = 100;
  constexpr unsigned kSeed = 1000000;  // differs from those of the references
  std::vector<controller::DiscreteMeasure> result;
  for (const controller::DiscreteMeasure& law : simulated_states(problem, samples, kSeed, 0)) {
    result.push_back(controller::compress(law, kPoints, kRounds).measure);
  }
  return result;
}

double deviation(const Eigen::ArrayXd& values) {
  if (values.size() < 2) return 0.0;
  return std::sqrt((values - values.mean()).square().sum() /
                   static_cast<double>(values.size() - 1));
}

/// `distances`: of the prediction, the propagator "compressed" and the ideal points. squared:
/// prints means of W2², otherwise means of W2.
void print_rows(const std::string& quantity, const std::vector<SquaredDistances>& distances,
                bool squared) {
  std::cout << fmt::format(
      "\n{:4}  step   MC-100      (sd)  prediction  compressed   ideal | ratio  published  ideal\n",
      quantity);
  for (std::size_t step = 0; step < distances.size(); ++step) {
    const auto scaled = [&](const Eigen::ArrayXd& squares) -> Eigen::ArrayXd {
      return squared ? squares : squares.sqrt();
    };
    const Eigen::ArrayXd samples = scaled(distances[step].monte_carlo);
    const double mean = samples.mean();
    const double prediction = scaled(distances[step].predictions[0]).mean();
    const double compressed = scaled(distances[step].predictions[1]).mean();
    const double ideal = scaled(distances[step].predictions[2]).mean();
    // Ratios of single runs; ratios of W2 are the square roots of those of W2².
    const double printed = kPublishedPrediction[step] / kPublishedSamples[step];
    const double published = squared ? printed : std::sqrt(printed);
    std::cout << fmt::format(
        "{:10}  {:.5f}  {:.5f}     {:.5f}     {:.5f} {:.5f} | {:.3f}      {:.3f}  {:.3f}{}\n", step,
        mean, deviation(samples), prediction, compressed, ideal, prediction / mean, published,
        ideal / mean, prediction / mean < published ? "" : "  not better than published");
  }
}

/// Prints the table for one covariance; returns whether the prediction is closer at every step.
bool report(const Eigen::Vector3d& variances, const Options& options) {
  const QualityProblem problem{.noise_covariance = variances.asDiagonal()};
  const std::vector<SquaredDistances> distances = squared_distances(
      problem,
      {quality_prediction(problem, options.propagator), quality_prediction(problem, "compressed"),
       ideal_points(problem, options.law)},
      options.quality);
  std::cout << fmt::format(
      "\nNoise covariance diag({}, {}, {}); {} seeds, reference of {} samples, {}\n", variances[0],
      variances[1], variances[2], options.quality.seeds, options.quality.reference,
      options.propagator);
  print_rows("W2^2", distances, /*squared=*/true);
  print_rows("W2", distances, /*squared=*/false);
  bool nearer = true;
  for (const SquaredDistances& step : distances) {
    nearer = nearer && step.predictions[0].mean() < step.monte_carlo.mean();
  }
  return nearer;
}

}  // namespace
}  // namespace qsmpc::testing

int main(int argc, char** argv) {
  qsmpc::testing::Options options;
  CLI::App app("Distance of predictions and of Monte Carlo samples to a Monte Carlo reference");
  app.add_option("--seeds", options.quality.seeds, "Seeds to average over")
      ->check(CLI::PositiveNumber);
  app.add_option("--reference", options.quality.reference, "Samples of the reference")
      ->check(CLI::PositiveNumber);
  app.add_option("--law", options.law, "Samples of the true law for the ideal points")
      ->check(CLI::PositiveNumber);
  app.add_option("--propagator", options.propagator, "Propagator for the prediction");
  CLI11_PARSE(app, argc, argv);
  bool nearer = true;
  try {
    for (const Eigen::Vector3d& variances :
         {Eigen::Vector3d(0.01, 0.01, 0.001), Eigen::Vector3d(0.015, 0.015, 0.015),
          Eigen::Vector3d(0.02, 0.02, 0.02)}) {
      nearer = qsmpc::testing::report(variances, options) && nearer;
    }
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return EXIT_FAILURE;
  }
  return nearer ? EXIT_SUCCESS : EXIT_FAILURE;
}
