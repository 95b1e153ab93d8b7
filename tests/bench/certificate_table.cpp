// How conservative the certificates are in hard cases: the ratio of bound to truth at every stage
// of random problems, by class, as a table of median, 90th percentile and maximum; then the same
// for being unsafe at any stage of a plan.
//
//   certificate_table [--problems N] [--paths N] [--seed N] [--class NAME…] [--least T] [--each]
//
// The truth is the rate of unsafe paths in simulation; stages at which it is below T (--least,
// default 1e-4) or above one half do not count. Exits with 1 if a median or 90th percentile exceeds
// the goal of its class.
#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "controller/certification/affine_surrogate.hpp"
#include "controller/certification/certificate.hpp"
#include "controller/certification/error_budget.hpp"
#include "controller/planning/planner.hpp"
#include "models/constants.hpp"
#include "tests/property/random_draws.hpp"
#include "tests/property/random_problem.hpp"
#include "tests/support/simulated_truth.hpp"

namespace qsmpc::testing {
namespace {

enum class Feedback { kOpen, kLqr, kOwn };

Feedback feedback_of(const Problem& problem) {
  if (!problem.settings.closed_loop) return Feedback::kOpen;
  return problem.settings.feedback_gain ? Feedback::kOwn : Feedback::kLqr;
}

/// Makes every obstacle that is bounded along x or the first coordinate 1 mm thin in that
/// direction, keeping its centre; there is at least one.
void make_thin(Problem& problem) {
  for (controller::Obstacle& obstacle : problem.settings.safe_set.obstacles) {
    auto* box = std::get_if<controller::Box>(&obstacle.form);
    if (box == nullptr) continue;
    const double middle = 0.5 * (box->lower[0] + box->upper[0]);
    if (!std::isfinite(middle)) continue;
    box->lower[0] = middle - 0.0005;
    box->upper[0] = middle + 0.0005;
  }
  // Nothing else may be dangerous, and a body is no thinner than its discs.
  problem.settings.safe_set.body.discs.clear();
  const Eigen::Index dim = problem.settings.safe_set.dim();
  problem.settings.safe_set.bounds = {.lower = Eigen::VectorXd::Constant(dim, -kInfinity),
                                      .upper = Eigen::VectorXd::Constant(dim, kInfinity)};
}

/// Sets the belief's heading deviation to 1 to 1.6 rad and keeps the correlations.
void make_heading_wide(Problem& problem, Generator& generator) {
  const int heading = 2;
  Eigen::MatrixXd& covariance = problem.belief.covariance;
  const double wanted = uniform(generator, 1.0, 1.6);
  const double deviation = std::sqrt(covariance(heading, heading));
  if (deviation == 0.0) {
    covariance(heading, heading) = wanted * wanted;
    return;
  }
  covariance.row(heading) *= wanted / deviation;
  covariance.col(heading) *= wanted / deviation;
}

/// The largest standard deviation of a feedback along the plan, in half ranges of its input.
double clamp_load(const controller::PredictedMotion& motion) {
  const std::vector<controller::SurrogateStage> stages = controller::affine_surrogates(motion);
  double most = 0.0;
  for (Eigen::Index k = 0; k < motion.policy.horizon(); ++k) {
    const Eigen::MatrixXd& gain = motion.policy.gains[k];
    const Eigen::VectorXd half = 0.5 * (motion.policy.bounds.upper - motion.policy.bounds.lower);
    for (Eigen::Index b = 0; b < gain.rows(); ++b) {
      const double variance = gain.row(b).dot(stages[static_cast<std::size_t>(k)].law.covariance *
                                              gain.row(b).transpose());
      if (std::isfinite(variance))
        most = std::max(most, std::sqrt(std::max(0.0, variance)) / half[b]);
    }
  }
  return most;
}

bool unicycle(const Problem& problem) { return problem.system.starts_with("dubins"); }

/// One row of the table.
struct ProblemClass {
  std::string name;
  double median_goal;
  double tenth_goal;
  std::function<bool(const Problem&)> fits;
  std::function<void(Problem&, Generator&)> make = {};
  double least_load = 0.0;  ///< of the clamps
};

std::function<bool(const Problem&)> of(const std::string& system, Feedback feedback) {
  return [=](const Problem& problem) {
    return problem.system == system && feedback_of(problem) == feedback;
  };
}

const std::vector<ProblemClass>& problem_classes() {
  const auto thin = [](Problem& problem, Generator&) { make_thin(problem); };
  const auto has_box = [](const Problem& problem) {
    return !problem.settings.safe_set.obstacles.empty();
  };
  static const std::vector<ProblemClass> classes = {
      {"dubins open", 1.1, 5.0, of("dubins", Feedback::kOpen)},
      {"dubins lqr", 2.0, 8.0, of("dubins", Feedback::kLqr)},
      {"dubins own", 3.0, 20.0, of("dubins", Feedback::kOwn)},
      {"dubins_rk4 lqr", 2.0, 8.0, of("dubins_rk4", Feedback::kLqr)},
      {"bicycle open", 1.3, 5.0, of("bicycle", Feedback::kOpen)},
      {"bicycle own", 4.0, 50.0, of("bicycle", Feedback::kOwn)},
      {"cart_pole open", 2.0, 10.0, of("cart_pole", Feedback::kOpen)},
      {"cart_pole lqr", 1.5, 2.5, of("cart_pole", Feedback::kLqr)},
      {"double_integrator own", 1.5, 5.0, of("double_integrator", Feedback::kOwn)},
      {"clamped",
       3.0,
       20.0,
       [](const Problem& problem) { return feedback_of(problem) != Feedback::kOpen; },
       {},
       5.0},
      {"thin open", 3.0, 30.0,
       [=](const Problem& problem) {
         return unicycle(problem) && has_box(problem) && feedback_of(problem) == Feedback::kOpen;
       },
       thin},
      {"thin closed", 5.0, 50.0,
       [=](const Problem& problem) {
         return unicycle(problem) && has_box(problem) && feedback_of(problem) != Feedback::kOpen;
       },
       thin},
      {"wide heading closed", 3.0, 20.0,
       [](const Problem& problem) {
         return unicycle(problem) && feedback_of(problem) != Feedback::kOpen;
       },
       make_heading_wide},
  };
  return classes;
}

struct Options {
  int problems = 24;
  int paths = 200000;
  double least = 1e-4;
  std::uint64_t seed = 20241;
  std::vector<std::string> classes;
  bool each = false;
};

/// The ratios of one class: of the certificate, and of the least of C1 … C4; and for any stage of a
/// plan, of the horizon's bound and of the sum of the stage values.
struct Ratios {
  std::vector<double> value;
  std::vector<double> former;
  std::vector<double> any;
  std::vector<double> sum;
  int ones = 0;  ///< stages certified 1 whose truth is below 0.01
};

double quantile(std::vector<double>& values, double share) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  const auto index = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  return values[index];
}

void add_problem(const Problem& problem, const ProblemClass& row, Generator& generator,
                 const Options& options, int& count, Ratios& ratios) {
  controller::Planner planner(*problem.dynamics, problem.settings);
  const controller::Plan& plan = planner.plan(problem.belief);
  const controller::PredictedMotion motion = controller::motion_of(planner, problem.belief, plan);
  if (row.least_load > 0.0 && clamp_load(motion) < row.least_load) return;
  ++count;
  const std::vector<controller::StageCertificate> certificates =
      controller::certify(motion, problem.settings.safe_set, controller::error_budget(motion),
                          controller::CertificateEffort::kTightest);
  const UnsafeCounts counts = simulate(motion, problem.settings.safe_set, options.paths, generator);
  const double ever = static_cast<double>(counts.any) / options.paths;
  if (ever >= options.least && ever <= 0.5) {
    double sum = 0.0;
    for (const controller::StageCertificate& stage : certificates) sum += stage.value;
    ratios.any.push_back(controller::horizon_bound(certificates) / ever);
    ratios.sum.push_back(std::min(1.0, sum) / ever);
  }
  for (std::size_t k = 0; k < certificates.size(); ++k) {
    const controller::StageCertificate& stage = certificates[k];
    const double truth = static_cast<double>(counts.stages[k]) / options.paths;
    if (truth < 0.01 && stage.value >= 1.0) ++ratios.ones;
    if (truth < options.least || truth > 0.5) continue;
    const double former =
        std::min({stage.of("c1"), stage.of("c2"), stage.of("c3"), stage.of("c4")});
    ratios.value.push_back(stage.value / truth);
    ratios.former.push_back(former / truth);
    if (options.each) {
      std::cout << fmt::format(
          "{:22} {:3} stage {} truth {:9.2e} value {:9.2e} {:9.2f} {} c1 {:8.1e} c2 {:8.1e} c3 "
          "{:8.1e} "
          "c4 {:8.1e} load {:.2f} heading {:.2f} discs {} {}\n",
          row.name, count, k + 1, truth, stage.value, stage.value / truth, stage.kind,
          stage.of("c1"), stage.of("c2"), stage.of("c3"), stage.of("c4"), clamp_load(motion),
          problem.dynamics->state_dim() > 2 ? std::sqrt(problem.belief.covariance(2, 2)) : 0.0,
          problem.settings.safe_set.body.discs.size(), problem.system);
    }
  }
}

/// Prints one row; returns whether it meets its goals.
bool report(const ProblemClass& row, const Options& options) {
  Generator generator(options.seed);
  Ratios ratios;
  int count = 0;
  while (count < options.problems) {
    Problem problem = random_problem(generator);
    if (!row.fits(problem)) continue;
    if (row.make) row.make(problem, generator);
    add_problem(problem, row, generator, options, count, ratios);
  }
  const double median = quantile(ratios.value, 0.5);
  const double tenth = quantile(ratios.value, 0.9);
  const bool kept = median <= row.median_goal && tenth <= row.tenth_goal;
  std::cout << fmt::format(
      "{:22} {:6} {:8.2f} {:8.1f} {:8.0f}   {:8.2f} {:8.1f} {:8.0f}   {:4.1f} {:4.0f} {} {:5} "
      "  {:6.2f} {:7.1f}   {:6.2f} {:7.1f}\n",
      row.name, ratios.value.size(), median, tenth, quantile(ratios.value, 1.0),
      quantile(ratios.former, 0.5), quantile(ratios.former, 0.9), quantile(ratios.former, 1.0),
      row.median_goal, row.tenth_goal, kept ? "kept  " : "missed", ratios.ones,
      quantile(ratios.any, 0.5), quantile(ratios.any, 0.9), quantile(ratios.sum, 0.5),
      quantile(ratios.sum, 0.9));
  std::cout.flush();
  return kept;
}

bool report_all(const Options& options) {
  std::cout
      << "                              value: bound / truth         of C1 to C4             goal"
         "                                any stage         sum of stages"
         "\nclass                  stages   median      90 %    worst     median     90 %    "
         "worst   median, 90 %    certified 1 below 0.01   median    90 %   median    90 %\n";
  bool kept = true;
  for (const ProblemClass& row : problem_classes()) {
    if (!options.classes.empty() && std::find(options.classes.begin(), options.classes.end(),
                                              row.name) == options.classes.end()) {
      continue;
    }
    kept = report(row, options) && kept;
  }
  return kept;
}

}  // namespace
}  // namespace qsmpc::testing

int main(int argc, char** argv) {
  CLI::App app("Bound over truth of random problems, by class");
  qsmpc::testing::Options options;
  app.add_option("--problems", options.problems, "problems per class")->check(CLI::PositiveNumber);
  app.add_option("--paths", options.paths, "simulated paths for the truth")
      ->check(CLI::PositiveNumber);
  app.add_option("--least", options.least, "smallest truth that counts");
  app.add_option("--seed", options.seed, "seed of the problems");
  app.add_option("--class", options.classes, "only these classes");
  app.add_flag("--each", options.each, "print every stage");
  CLI11_PARSE(app, argc, argv);
  return qsmpc::testing::report_all(options) ? 0 : 1;
}
