#include "harness/mismatch/parameter_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <stdexcept>

#include <Eigen/LU>
#include <Eigen/QR>
#include <unsupported/Eigen/NonLinearOptimization>
#include <unsupported/Eigen/NumericalDiff>

#include "harness/assembly/assembly.hpp"
#include "harness/errors.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/text/printable.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {
namespace {

// Error, in deviations, that stands for constants that the model rejects or cannot predict with.
constexpr double kRejected = 1e6;
// Columns of the Jacobian that are dependent to this relative precision, that of its finite
// differences, are so.
constexpr double kDependent = 1e-6;

Eigen::MatrixXd predicted_ends(const models::Dynamics& model, const Eigen::MatrixXd& states,
                               const Eigen::MatrixXd& inputs) {
  models::StateBatch ends(states.rows(), states.cols());
  model.step(models::StateBatch(states), models::StateBatch(inputs), ends);
  return ends;
}

Eigen::VectorXd rms(const Eigen::MatrixXd& errors) {
  return errors.rowwise().squaredNorm().array().sqrt() /
         std::sqrt(static_cast<double>(errors.cols()));
}

/// The errors in deviations, as a function of the constants: the interface that Eigen's solver asks
/// for.
class WeightedErrors {
 public:
  using Scalar = double;
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;
  // NOLINTNEXTLINE(readability-identifier-naming,cppcoreguidelines-use-enum-class): Eigen's names
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  WeightedErrors(const Scenario& scenario, const std::vector<std::string>& names,
                 const PlantPeriods& periods)
      : scenario_(scenario), names_(names), periods_(periods) {
    const Eigen::VectorXd before = rms(errors(start()));
    const Eigen::VectorXd variances = scenario.disturbance.covariance.diagonal();
    weights_.resize(before.size());
    for (Eigen::Index i = 0; i < before.size(); ++i) {
      const double scale = variances[i] > 0.0 ? std::sqrt(variances[i]) : before[i];
      weights_[i] = scale > 0.0 ? 1.0 / scale : 1.0;
    }
  }

  [[nodiscard]] Eigen::Index states() const { return weights_.size(); }
  [[nodiscard]] int inputs() const { return static_cast<int>(names_.size()); }
  [[nodiscard]] int values() const { return static_cast<int>(periods_.ends.size()); }

  int operator()(const Eigen::VectorXd& constants, Eigen::VectorXd& values) const {
    try {
      values = (weights_.asDiagonal() * errors(constants)).reshaped();
      if (values.allFinite()) return 0;
    } catch (const std::invalid_argument&) {  // such as a negative mass
    }
    values.setConstant(this->values(), kRejected);
    return 0;
  }

  [[nodiscard]] Eigen::VectorXd start() const {
    Eigen::VectorXd constants(inputs());
    for (Eigen::Index i = 0; i < constants.size(); ++i) {
      constants[i] = scenario_.model.parameters.at(names_[static_cast<std::size_t>(i)]);
    }
    return constants;
  }

  /// state_dim x n. Throws as `model_of`.
  [[nodiscard]] Eigen::MatrixXd errors(const Eigen::VectorXd& constants) const {
    Scenario changed = scenario_;
    for (Eigen::Index i = 0; i < constants.size(); ++i) {
      changed.model.parameters.at(names_[static_cast<std::size_t>(i)]) = constants[i];
    }
    return periods_.ends - predicted_ends(*model_of(changed), periods_.states, periods_.inputs);
  }

 private:
  const Scenario& scenario_;
  const std::vector<std::string>& names_;
  const PlantPeriods& periods_;
  Eigen::VectorXd weights_;
};

void check_names(const Scenario& scenario, const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const auto& [name, value] : scenario.model.parameters) known.push_back(name);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::ranges::find(known, names[i]) == known.end()) {
      throw InputError(
          {.key = "--parameter",
           .found = printable(names[i], 100),
           .expected = known.empty() ? "a model with constants" : expected_names(names[i], known)});
    }
    if (std::find(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(i), names[i]) !=
        names.begin() + static_cast<std::ptrdiff_t>(i)) {
      throw InputError(
          {.key = "--parameter", .found = names[i] + " twice", .expected = "each once"});
    }
  }
}

/// Refuses constants that have no effect, or effects that others also have.
void check_determined(const Eigen::MatrixXd& jacobian, const std::vector<std::string>& names) {
  Eigen::MatrixXd directions = jacobian;
  for (Eigen::Index i = 0; i < directions.cols(); ++i) {
    const double norm = directions.col(i).norm();
    if (!(norm > 0.0)) {
      throw InputError({.key = "--parameter",
                        .found = names[static_cast<std::size_t>(i)],
                        .expected = "a constant that makes a difference in these drives"});
    }
    directions.col(i) /= norm;
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(directions);
  qr.setThreshold(kDependent);
  if (qr.rank() < directions.cols()) {
    const auto last = qr.colsPermutation().indices()[directions.cols() - 1];
    throw InputError({.key = "--parameter",
                      .found = names[static_cast<std::size_t>(last)],
                      .expected = "constants whose effects these drives can tell apart"});
  }
}

/// Of the fitted constants, by the least squares' normal equations, with a separate variance of the
/// errors of each state.
Eigen::MatrixXd covariance_of(const WeightedErrors& errors, const Eigen::VectorXd& constants,
                              const Eigen::MatrixXd& jacobian) {
  Eigen::VectorXd values(errors.values());
  errors(constants, values);
  const Eigen::Index states = errors.states();
  const Eigen::VectorXd deviations = rms(values.reshaped(states, values.size() / states));
  Eigen::MatrixXd scaled = jacobian;
  for (Eigen::Index row = 0; row < scaled.rows(); ++row)
    scaled.row(row) *= deviations[row % states];
  const Eigen::MatrixXd inverse = (jacobian.transpose() * jacobian).inverse();
  return inverse * (scaled.transpose() * scaled) * inverse;
}

}  // namespace

void PlantPeriods::add(const Trace& trace) {
  std::vector<const StepRecord*> steps;
  for (const StepRecord& step : trace.steps) {
    if (step.residual.size() > 0 && step.residual.allFinite()) steps.push_back(&step);
  }
  const Eigen::Index old = states.cols();
  const Eigen::Index count = std::ssize(steps);
  if (count == 0) return;
  states.conservativeResize(steps.front()->state.size(), old + count);
  inputs.conservativeResize(steps.front()->input.size(), old + count);
  ends.conservativeResize(states.rows(), old + count);
  for (Eigen::Index k = 0; k < count; ++k) {
    states.col(old + k) = steps[static_cast<std::size_t>(k)]->state;
    inputs.col(old + k) = steps[static_cast<std::size_t>(k)]->input;
    ends.col(old + k) = steps[static_cast<std::size_t>(k)]->residual;
  }
  ends.rightCols(count) +=
      predicted_ends(*model_of(trace.scenario), states.rightCols(count), inputs.rightCols(count));
}

ParameterFit fit_parameters(const Scenario& scenario, const std::vector<std::string>& names,
                            const PlantPeriods& periods) {
  check_names(scenario, names);
  if (periods.ends.size() <= std::ssize(names)) {
    throw InputError({.key = "folder",
                      .found = std::to_string(periods.ends.cols()) + " periods",
                      .expected = "drives with more of them"});
  }
  const WeightedErrors errors(scenario, names, periods);
  const Eigen::NumericalDiff<WeightedErrors, Eigen::Central> differentiated(errors);
  Eigen::VectorXd constants = errors.start();
  const Eigen::VectorXd start = constants;
  Eigen::MatrixXd jacobian(errors.values(), errors.inputs());
  differentiated.df(constants, jacobian);
  check_determined(jacobian, names);

  Eigen::NumericalDiff<WeightedErrors, Eigen::Central> minimised(errors);
  Eigen::LevenbergMarquardt<Eigen::NumericalDiff<WeightedErrors, Eigen::Central>> solver(minimised);
  const auto outcome = solver.minimize(constants);
  if (outcome == Eigen::LevenbergMarquardtSpace::TooManyFunctionEvaluation ||
      outcome == Eigen::LevenbergMarquardtSpace::ImproperInputParameters) {
    throw InputError({.key = "--parameter",
                      .found = "no minimum after " + std::to_string(solver.nfev) + " evaluations",
                      .expected = "constants near those of the plant to begin with"});
  }

  differentiated.df(constants, jacobian);
  check_determined(jacobian, names);
  const Eigen::MatrixXd covariance = covariance_of(errors, constants, jacobian);
  ParameterFit fit{.rms_before = rms(errors.errors(start)),
                   .rms_after = rms(errors.errors(constants))};
  for (Eigen::Index i = 0; i < constants.size(); ++i) {
    fit.parameters.push_back({.name = names[static_cast<std::size_t>(i)],
                              .before = start[i],
                              .fitted = constants[i],
                              .deviation = std::sqrt(covariance(i, i))});
  }
  return fit;
}

}  // namespace qsmpc::harness
