// The computation of `qsmpc fit`: constants of a model with which it predicts what a plant did in
// recorded drives.
//
//   PlantPeriods periods;
//   for (const std::string& folder : folders) periods.add(read_folder(folder));
//   const ParameterFit fit = fit_parameters(scenario, {"lag", "slip"}, periods);
//   fit.parameters[0].fitted;
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "harness/scenario/scenario.hpp"
#include "harness/trace/trace.hpp"

namespace qsmpc::harness {

/// Control periods of a plant, one per column.
struct PlantPeriods {
  Eigen::MatrixXd states{};  ///< in which the periods begin, state_dim x n
  Eigen::MatrixXd inputs{};  ///< input_dim x n
  Eigen::MatrixXd ends{};  ///< states that the plant reaches without the disturbance, state_dim x n

  /// Appends the periods of a drive; those that the plant did not complete are left out. Throws as
  /// `model_of`.
  void add(const Trace& trace);
};

struct FittedParameter {
  std::string name;
  double before = 0.0;  ///< in the scenario
  double fitted = 0.0;
  double deviation = 0.0;  ///< standard error, if errors of the prediction are independent
};

struct ParameterFit {
  std::vector<FittedParameter> parameters{};
  Eigen::VectorXd rms_before;  ///< of the model's error in a period, by state
  Eigen::VectorXd rms_after;
};

/// The constants `names` of the scenario's model that minimise, over all periods, the sum of
/// squared errors of its prediction, each state's relative to the standard deviation of its
/// disturbance (where that is 0: to the error's root mean square before the fit), by the method of
/// Levenberg and Marquardt from the scenario's values.
///
/// Throws InputError if a name is unknown or repeated, if there are fewer errors than constants, if
/// the periods do not determine a constant, or if no minimum is found.
[[nodiscard]] ParameterFit fit_parameters(const Scenario& scenario,
                                          const std::vector<std::string>& names,
                                          const PlantPeriods& periods);

}  // namespace qsmpc::harness
