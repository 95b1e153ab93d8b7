// The terms of the expected cost.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "controller/planning/cost/cost_parts.hpp"
#include "controller/planning/cost/penalty.hpp"
#include "controller/planning/cost/quadratic_cost.hpp"
#include "controller/planning/cost/stage_term.hpp"
#include "controller/regions/safe_set.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::controller {

/// What the cost depends on besides the prediction; refers to objects that must outlive it.
struct HorizonCostTerms {
  const models::Dynamics& dynamics;
  const SafeSet& safe_set;
  const QuadraticCost& cost;
  const Penalty& penalty;
  const Eigen::MatrixXd& noise_covariance;   ///< zero if the prediction omits the noise
  const Eigen::MatrixXd& within_covariance;  ///< of the belief's quantiser, for stage 0
};

/// One term. A new one is a file with a class, a line in the table and, if it is a separate part,
/// an entry in cost_parts().
struct CostTermEntry {
  std::string name;
  std::string part;  ///< a name from cost_parts()
  /// Returns nullptr where the problem has no such term. Keeps the references in `terms`.
  std::unique_ptr<StageTerm> (*make)(const HorizonCostTerms& terms) = nullptr;
};

/// The table of terms, in the order in which they are added at each place.
[[nodiscard]] const std::vector<CostTermEntry>& cost_terms();

// The factories in the table. The quadratic terms share a file, and so do the printed ones.
[[nodiscard]] std::unique_ptr<StageTerm> make_state_term(const HorizonCostTerms& terms);
[[nodiscard]] std::unique_ptr<StageTerm> make_input_term(const HorizonCostTerms& terms);
[[nodiscard]] std::unique_ptr<StageTerm> make_terminal_term(const HorizonCostTerms& terms);
[[nodiscard]] std::unique_ptr<StageTerm> make_bounds_term(const HorizonCostTerms& terms);
[[nodiscard]] std::unique_ptr<StageTerm> make_obstacle_term(const HorizonCostTerms& terms);
[[nodiscard]] std::unique_ptr<StageTerm> make_printed_bounds_term(const HorizonCostTerms& terms);
[[nodiscard]] std::unique_ptr<StageTerm> make_printed_obstacle_term(const HorizonCostTerms& terms);

}  // namespace qsmpc::controller
