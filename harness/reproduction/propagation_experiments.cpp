// Fig. 4-1 and 4-2: prediction by points, compared with samples and without compression.

#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <fmt/format.h>

#include "controller/measure/quantisation/gaussian_quantiser.hpp"
#include "harness/assembly/assembly.hpp"
#include "harness/elapsed.hpp"
#include "harness/figures/palette.hpp"
#include "harness/reproduction/experiments.hpp"
#include "harness/reproduction/turn_prediction.hpp"

namespace qsmpc::harness {
namespace {

// ---- Fig. 4-1

constexpr int kTurnStages = 40;
constexpr int kShownEvery = 10;
constexpr std::int64_t kPictureSamples = 2000;

/// Position and its spread at one stage.
struct PositionSpread {
  Eigen::Vector2d mean;
  Eigen::Matrix2d covariance;
  [[nodiscard]] double deviation() const { return std::sqrt(covariance.trace()); }
};

PositionSpread position_spread(const controller::DiscreteMeasure& measure) {
  return {.mean = controller::mean_of(measure).head<2>(),
          .covariance = controller::covariance_of(measure).topLeftCorner<2, 2>()};
}

void add_turn_rows(const PredictionReport& report, const std::vector<controller::Points>& samples,
                   ExperimentResult& result) {
  for (int stage = 0; stage <= kTurnStages; stage += kShownEvery) {
    const auto k = static_cast<std::size_t>(stage);
    const PositionSpread points = position_spread(report.prediction.stages[k]);
    const PositionSpread sampled = position_spread(equally_weighted(samples[k]));
    const double time = stage * report.scenario.time_step;
    result.rows.push_back(
        {.quantity = fmt::format("distance of the mean positions, {:.0f} s", time),
         .unit = "m",
         .here = (points.mean - sampled.mean).norm(),
         .note = fmt::format("the samples’ own error is about {:.1g}",
                             sampled.deviation() / std::sqrt(kPictureSamples)),
         .place = TablePlace{.table = "",
                             .row = "distance of the mean positions",
                             .column = fmt::format("{:.0f} s", time)}});
    result.rows.push_back(
        {.quantity = fmt::format("spread of the points over that of the samples, "
                                 "{:.0f} s",
                                 time),
         .here = points.deviation() / sampled.deviation(),
         .note = "of the points alone; the spread lost within their cells is known",
         .place = TablePlace{.table = "",
                             .row = "spread of the points over that of the samples",
                             .column = fmt::format("{:.0f} s", time)}});
  }
}

// ---- Fig. 4-2

constexpr int kNoisyStages = 5;
constexpr int kNoiseParts = 8;  // points that represent the noise in Fig. 4-2
constexpr std::int64_t kTruthSamples = 200'000;
constexpr double kPublishedPoints = 3.28e6;
constexpr const char* kAfterSteps = "After 5 steps";
constexpr double kPublishedCompressed = 100.0;
// Common to all panels of Fig. 4-2, around the 95 % ellipse.
constexpr MapRectangle kCloudArea{.x_lower = -0.4, .x_upper = 1.9, .y_lower = -0.9, .y_upper = 1.0};

/// Adds every noise point to every point, stage after stage, without compression (Eq. 4-5).
controller::DiscreteMeasure without_compression(const PredictionReport& report,
                                                const controller::DiscreteMeasure& noise) {
  const auto model = model_of(report.scenario);
  controller::DiscreteMeasure measure = report.prediction.stages.front();
  for (int stage = 0; stage < kNoisyStages; ++stage) {
    const Eigen::Index count = measure.size();
    controller::Points next(measure.locations.rows(), count);
    models::StateBatch inputs(report.policy.inputs.rows(), count);
    controller::policy_inputs(report.policy, stage, measure.locations, inputs);
    model->step(measure.locations, inputs, next);
    controller::DiscreteMeasure product{
        .locations = controller::Points(next.rows(), count * noise.size()),
        .weights = Eigen::VectorXd(count * noise.size())};
    for (Eigen::Index j = 0; j < noise.size(); ++j) {
      product.locations.middleCols(j * count, count) =
          next.colwise() + Eigen::VectorXd(noise.locations.col(j));
      product.weights.segment(j * count, count) = noise.weights[j] * measure.weights;
    }
    measure = std::move(product);
  }
  return measure;
}

struct Compressed {
  const char* propagator;
  const char* what;
};
constexpr std::array<Compressed, 3> kCompressed{{{"soft", "the thesis’s soft compression"},
                                                 {"compressed", "hard compression"},
                                                 {"mixture", "this program’s mixture"}}};

/// Adds rows for the share of the true law's variance that `measure` has, and for the error of its
/// mean.
void add_moment_rows(const std::string& what, const controller::DiscreteMeasure& measure,
                     const controller::DiscreteMeasure& truth, ExperimentResult& result) {
  const auto place = [&what](const char* row) {
    return TablePlace{.table = kAfterSteps, .row = row, .column = what};
  };
  result.rows.push_back({.quantity = "variance after 5 steps over the true one, " + what,
                         .here = controller::covariance_of(measure).trace() /
                                 controller::covariance_of(truth).trace(),
                         .note = "traces; the truth from 200,000 samples",
                         .place = place("variance over the true one")});
  result.rows.push_back({.quantity = "distance of the mean from the true one, " + what,
                         .here = (controller::mean_of(measure) - controller::mean_of(truth)).norm(),
                         .place = place("distance of the mean from the true one")});
}

MapCloud cloud_of(const controller::DiscreteMeasure& measure) {
  return {.colour = kBlue, .points = measure.locations.topRows<2>(), .weights = measure.weights};
}

MapEllipse ellipse_of(const controller::DiscreteMeasure& measure) {
  const PositionSpread spread = position_spread(measure);
  return {.colour = kOrange, .mean = spread.mean, .covariance = spread.covariance};
}

PlaneMap empty_map(const std::string& title) {
  return {.title = title, .x_label = "x (m)", .y_label = "y (m)"};
}

/// Every kShownEvery-th of `stages`, `period` seconds apart.
PlaneMap turn_map(const std::string& title, const std::vector<controller::DiscreteMeasure>& stages,
                  double period) {
  PlaneMap map = empty_map(title);
  for (int stage = 0; stage <= kTurnStages; stage += kShownEvery) {
    const controller::DiscreteMeasure& measure = stages[static_cast<std::size_t>(stage)];
    map.clouds.push_back(cloud_of(measure));
    MapEllipse ellipse = ellipse_of(measure);
    ellipse.label = fmt::format("{:.0f} s", stage * period);
    map.ellipses.push_back(std::move(ellipse));
  }
  return map;
}

PlaneMap cloud_map(const std::string& title, const controller::DiscreteMeasure& measure) {
  PlaneMap map = empty_map(title);
  map.area = kCloudArea;
  map.clouds.push_back(cloud_of(measure));
  map.ellipses.push_back(ellipse_of(measure));
  return map;
}

}  // namespace

ExperimentResult propagation_along_a_turn(Laboratory& laboratory) {
  laboratory.at_work("a belief along a turn");
  ExperimentResult result;
  const PredictionReport report = on_a_turn(kTurnStages, {"controller.propagate_noise=false"});
  const std::vector<controller::Points> samples =
      samples_of(report, {.count = kPictureSamples, .with_noise = false}, laboratory.run());
  add_turn_rows(report, samples, result);
  std::vector<controller::DiscreteMeasure> sampled;
  sampled.reserve(samples.size());
  for (const controller::Points& points : samples) sampled.push_back(equally_weighted(points));
  const double period = report.scenario.time_step;
  result.figures = {
      {.file = "figure-4-1.svg",
       .title = "A belief along a turn",
       .caption = "50 and 95 % ellipses from the mean and covariance of what is drawn.",
       .panels = {turn_map("100 points", report.prediction.stages, period),
                  turn_map("2,000 samples", sampled, period)}}};
  return result;
}

ExperimentResult propagation_with_noise(Laboratory& laboratory) {
  laboratory.at_work("points without compression");
  ExperimentResult result;
  const std::string parts = fmt::format("controller.quantisation.noise={}", kNoiseParts);
  const PredictionReport first = on_a_turn(kNoisyStages, {parts});
  const auto start = std::chrono::steady_clock::now();
  const controller::GaussianQuantisation noise = controller::quantise(
      {.mean = Eigen::VectorXd::Zero(first.scenario.disturbance.covariance.rows()),
       .covariance = first.scenario.disturbance.covariance},
      kNoiseParts);
  const controller::DiscreteMeasure all = without_compression(first, noise.measure);
  const double naive_ms = milliseconds_since(start);
  // From this many samples, the moments are known to a few per mille.
  const controller::DiscreteMeasure truth =
      equally_weighted(samples_of(first, {.count = kTruthSamples}, laboratory.run()).back());
  result.rows = {
      {.quantity = "points after 5 steps, nothing compressed",
       .published = kPublishedPoints,
       .here = static_cast<double>(all.size()),
       .place = TablePlace{.table = kAfterSteps, .row = "points", .column = "nothing compressed"}},
      {.quantity = "time of these 5 steps", .unit = "ms", .here = naive_ms}};
  add_moment_rows("nothing compressed", all, truth, result);
  std::vector<Panel> maps{cloud_map("All points, nothing compressed", all)};
  for (const Compressed& compressed : kCompressed) {
    laboratory.at_work(compressed.what);
    const PredictionReport report = on_a_turn(
        kNoisyStages, {parts, std::string("controller.propagator=") + compressed.propagator});
    const controller::DiscreteMeasure& last = report.prediction.stages.back();
    result.rows.push_back(
        {.quantity = fmt::format("points after 5 steps, {}", compressed.what),
         .published = kPublishedCompressed,
         .here = static_cast<double>(last.size()),
         .place = TablePlace{.table = kAfterSteps, .row = "points", .column = compressed.what}});
    add_moment_rows(compressed.what, last, truth, result);
    maps.emplace_back(cloud_map(fmt::format("100 points, {}", compressed.what), last));
  }
  result.figures = {
      {.file = "figure-4-2.svg",
       .title = "Positions after 5 steps with noise",
       .caption = "50 and 95 % ellipses from the mean and covariance of what is drawn.",
       .panels = maps}};
  return result;
}

}  // namespace qsmpc::harness
