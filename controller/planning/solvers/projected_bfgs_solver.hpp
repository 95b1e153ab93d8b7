// A dense quasi-Newton method that handles the bounds directly: its steps minimise the quadratic
// model over the box. It allocates only when the size of the problem changes, and keeps the
// curvature between calls.
#pragma once

#include <Eigen/Core>

#include "controller/planning/solvers/box_qp.hpp"
#include "controller/planning/solvers/metered_cost.hpp"
#include "controller/planning/solvers/ocp_solver.hpp"

namespace qsmpc::controller {

class ProjectedBfgsSolver final : public OcpSolver {
 public:
  const SolverResult& minimise(const OcpProblem& problem, const Eigen::VectorXd& start,
                               const SolverOptions& options) override;
  void forget() override { known_ = Curvature::kNone; }
  void shift(const StageLayout& layout) override;

 private:
  enum class Curvature {
    kNone,       ///< as after `forget`
    kInherited,  ///< from an earlier problem, not yet tried on this one
    kInitial,    ///< a guess from the bounds' ranges, not yet scaled
    kLearnt,
  };
  enum class Search { kDescended, kFailed, kStopped };

  void resize(Eigen::Index n);
  SolverStatus run(const OcpProblem& problem, const SolverOptions& options, MeteredCost& cost);
  void reset_curvature(const OcpProblem& problem);
  [[nodiscard]] bool find_step(const OcpProblem& problem);
  [[nodiscard]] Search search(const OcpProblem& problem, const SolverOptions& options,
                              MeteredCost& cost);
  void learn();
  [[nodiscard]] double attainable(const OcpProblem& problem) const;

  Curvature known_ = Curvature::kNone;
  SolverResult result_;
  bool fitting_ = false;  // the last step was a full step, and the model right about its end
  BoxQp model_;
  Eigen::MatrixXd hessian_;   // B
  Eigen::VectorXd scale_;     // of the entries: the bounds' ranges
  Eigen::VectorXd z_;         // the current point, the best
  Eigen::VectorXd gradient_;  // there
  Eigen::VectorXd below_;     // room to the bounds: lower − z ≤ 0 ≤ upper − z
  Eigen::VectorXd above_;
  Eigen::VectorXd step_;
  Eigen::VectorXd trial_;
  Eigen::VectorXd trial_gradient_;
  Eigen::VectorXd moved_;   // s
  Eigen::VectorXd change_;  // y
  Eigen::VectorXd curved_;  // Bs
};

}  // namespace qsmpc::controller
