// NLopt's sequential quadratic programming, for problems with many inequality constraints: it keeps
// a working set of the few that matter, and adds others once they are violated.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "controller/planning/solvers/metered_cost.hpp"
#include "controller/planning/solvers/nlopt_run.hpp"
#include "controller/planning/solvers/ocp_solver.hpp"

namespace qsmpc::controller {

class SlsqpSolver final : public OcpSolver {
 public:
  const SolverResult& minimise(const OcpProblem& problem, const Eigen::VectorXd& start,
                               const SolverOptions& options) override;

 private:
  // A point with its cost and the largest violation of the constraints evaluated there.
  struct Point {
    Eigen::VectorXd z;
    double value = 0.0;
    double violation = 0.0;
    Eigen::VectorXd gradient;
  };
  // The last answer to NLopt, cached so that asking again costs nothing.
  struct Answer {
    Point point;
    bool evaluated = false;  // whether cost and gradient are known
    bool complete = false;   // whether the working set is known as well
    Eigen::VectorXd constraints;
    Eigen::MatrixXd constraint_gradients;  // n x working set
  };

  bool assess(const OcpProblem& problem, const Eigen::VectorXd& z, MeteredCost& cost);
  [[nodiscard]] bool begin(const OcpProblem& problem, MeteredCost& cost);
  NloptEnd run(const OcpProblem& problem, const SolverOptions& options, MeteredCost& cost);
  [[nodiscard]] bool check_all(const OcpProblem& problem, Point& point);
  std::size_t enlarge(const OcpProblem& problem, double threshold);
  void drop_inactive();
  void thin();
  [[nodiscard]] SolverStatus stopped_as(const MeteredCost& cost) const;
  SolverStatus rounds(const OcpProblem& problem, const SolverOptions& options, MeteredCost& cost);

  SolverResult result_;
  Point best_;     // of the points at which all constraints were evaluated
  Point reached_;  // the best point of a run, judged by the working set only
  Answer answer_;
  bool trouble_ = false;  // a constraint was not finite
  double tolerance_ = 0.0;
  Eigen::VectorXd scale_;  // of the decisions: the bounds' ranges
  std::vector<int> working_;
  std::vector<int> candidates_;
  Eigen::VectorXd all_;  // values of all constraints at the last point where they were evaluated
};

}  // namespace qsmpc::controller
