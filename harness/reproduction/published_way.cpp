#include "harness/reproduction/published_way.hpp"

#include <cmath>
#include <memory>

#include "controller/certification/error_budget.hpp"
#include "controller/certification/published_certificate.hpp"
#include "controller/certification/worst_case.hpp"
#include "controller/measure/quantisation/gaussian_quantiser.hpp"
#include "controller/planning/planner.hpp"
#include "harness/assembly/assembly.hpp"

namespace qsmpc::harness {
namespace {

/// Adds every point of `noise` to every point of `states` (Eq. 4-5).
controller::DiscreteMeasure product_of(const controller::Points& states,
                                       const Eigen::VectorXd& weights,
                                       const controller::DiscreteMeasure& noise) {
  controller::DiscreteMeasure product{
      .locations = controller::Points(states.rows(), states.cols() * noise.size()),
      .weights = Eigen::VectorXd(states.cols() * noise.size())};
  for (Eigen::Index i = 0; i < states.cols(); ++i) {
    const Eigen::Index first = i * noise.size();
    product.locations.middleCols(first, noise.size()) =
        noise.locations.colwise() + Eigen::VectorXd(states.col(i));
    product.weights.segment(first, noise.size()) = weights[i] * noise.weights;
  }
  return product;
}

}  // namespace

WorstCase worst_cases(const controller::DiscreteMeasure& measure,
                      const controller::UnsafeSet& unsafe, const Radii& radii) {
  return {.published = controller::thesis_probability(measure, unsafe.bounds(), radii.published),
          .distance = controller::linear_transport_probability(measure, unsafe, radii.sound),
          .sound = controller::worst_case_probability(measure, unsafe, radii.sound)};
}

std::vector<NextStepView> next_step_views(const Trace& trace) {
  Scenario scenario = trace.scenario;
  scenario.controller.propagate_noise = true;
  scenario.controller.propagator = "compressed";
  const Eigen::MatrixXd& covariance = scenario.disturbance.covariance;
  const std::unique_ptr<const models::Dynamics> model = model_of(scenario);
  controller::Planner planner(*model, planner_settings(scenario));
  const controller::GaussianQuantisation noise = controller::quantise(
      {.mean = Eigen::VectorXd::Zero(model->state_dim()), .covariance = covariance},
      scenario.controller.quantisation.noise);
  std::vector<NextStepView> views;
  for (const StepRecord& step : trace.steps) {
    const controller::Gaussian belief{.mean = step.belief_mean,
                                      .covariance = step.belief_covariance};
    const controller::Plan& plan = planner.prescribe(belief, step.plan_inputs);
    const controller::PredictedMotion motion = controller::motion_of(planner, belief, plan);
    const std::vector<controller::StageBudget> budgets = controller::error_budget(motion);
    const double published = controller::thesis_radii(motion, budgets)[1];
    const controller::DiscreteMeasure product = product_of(
        plan.prediction.stepped.front(), plan.prediction.stages.front().weights, noise.measure);
    views.push_back(
        {.plain = worst_cases(product, scenario.safe_set,
                              {.sound = std::hypot(budgets[1].before_noise, noise.w2),
                               .published = published - plan.prediction.maps[0].compression_w2}),
         .compressed = worst_cases(plan.prediction.stages[1], scenario.safe_set,
                                   {.sound = budgets[1].total, .published = published})});
  }
  return views;
}

}  // namespace qsmpc::harness
