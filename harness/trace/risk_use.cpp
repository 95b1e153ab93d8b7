#include "harness/trace/risk_use.hpp"

#include <algorithm>
#include <string>

#include "controller/certification/certificate.hpp"
#include "controller/planning/solvers/ocp_solver.hpp"

namespace qsmpc::harness {
namespace {

void count_period(double certified, CertifiedRisk& risk) {
  risk.certified = std::max(risk.certified, certified);
  if (certified > risk.limit) ++risk.exceeded;
}

double worst_stage(const StepRecord& step) {
  double worst = 0.0;
  for (const controller::StageCertificate& stage : step.certificates) {
    worst = std::max(worst, stage.value);
  }
  return worst;
}

}  // namespace

bool exceeds_limits(const StepRecord& step, const Scenario::Risk& limits) {
  const std::string exceeded =
      controller::solver_status_name(controller::SolverStatus::kRiskExceeded);
  return step.solver_status == exceeded || worst_stage(step) > limits.stage ||
         controller::horizon_bound(step.certificates) > limits.plan;
}

RiskUse risk_use(const Trace& trace) {
  const Scenario::Risk& limits = trace.scenario.risk;
  RiskUse use{.stage = {.limit = limits.stage},
              .plan = {.limit = limits.plan},
              .mission = {.limit = limits.mission}};
  double spent = 0.0;
  for (const StepRecord& step : trace.steps) {
    if (step.certificates.empty()) continue;
    spent += step.certificates.front().value;
    count_period(worst_stage(step), use.stage);
    count_period(controller::horizon_bound(step.certificates), use.plan);
    count_period(spent, use.mission);
    if (exceeds_limits(step, limits) || spent > limits.mission) ++use.exceeded_periods;
  }
  return use;
}

}  // namespace qsmpc::harness
