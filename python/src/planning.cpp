// Plans from any belief, and certificates of any plans, without a plant.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "python/src/arrays.hpp"
#include "python/src/calls.hpp"
#include "python/src/module.hpp"
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "controller/measure/measures.hpp"
#include "controller/planning/cost/cost_parts.hpp"
#include "controller/surroundings/obstacle_forecast.hpp"
#include "harness/assembly/assembly.hpp"
#include "harness/control/answered_decision.hpp"
#include "harness/episode/drive.hpp"

namespace qsmpc::python {
namespace {

namespace nb = nanobind;
using nb::literals::operator""_a;
using harness::Scenario;
using harness::StepRecord;

/// A belief, the observation, and the time.
struct Moment {
  controller::Gaussian belief;
  Eigen::VectorXd observation;
  Eigen::Index period = 0;
  Eigen::Index periods_left = 0;
  double deadline = std::numeric_limits<double>::infinity();  // from now, s
  std::optional<int> waypoints_passed{};
  std::optional<std::vector<controller::PlacesByStage>> obstacles{};  // moving ones
};

controller::Situation situation_of(const Moment& moment, const Scenario& scenario) {
  using Clock = std::chrono::steady_clock;
  controller::Situation situation{.period = moment.period,
                                  .time = static_cast<double>(moment.period) * scenario.time_step,
                                  .belief = moment.belief,
                                  .observation = moment.observation,
                                  .periods_left = moment.periods_left};
  if (moment.waypoints_passed) {
    if (*moment.waypoints_passed < 0) {
      throw std::invalid_argument("waypoints_passed must be at least 0");
    }
    situation.progress = *moment.waypoints_passed;
  }
  if (std::isfinite(moment.deadline)) {
    situation.deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                            std::chrono::duration<double>(moment.deadline));
  }
  return situation;
}

Moment moment_of(const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance,
                 const Eigen::VectorXd& observation, Eigen::Index period, Eigen::Index periods_left,
                 double deadline, std::optional<std::vector<controller::PlacesByStage>> obstacles,
                 std::optional<int> waypoints_passed) {
  Moment moment{.belief = {.mean = mean, .covariance = covariance},
                .observation = observation,
                .period = period,
                .periods_left = periods_left,
                .deadline = deadline,
                .waypoints_passed = waypoints_passed,
                .obstacles = std::move(obstacles)};
  controller::check_gaussian(moment.belief);
  if (period < 0) throw std::invalid_argument("period must be at least 0");
  return moment;
}

std::unique_ptr<const Scenario> within_memory(Scenario scenario) {
  refuse_beyond_memory(scenario);
  return std::make_unique<const Scenario>(std::move(scenario));
}

/// The controller of a scenario, outside any drive.
class Planner {
 public:
  explicit Planner(Scenario scenario)
      : scenario_(within_memory(std::move(scenario))),
        drive_(*scenario_),
        controller_(harness::make_controller(drive_.scenario(), drive_.model())) {}

  void reset(std::uint64_t seed) { controller_->reset(seed); }

  StepRecord decide(const Moment& moment, bool certify) {
    if (moment.obstacles) drive_.know_obstacles(*moment.obstacles);
    const controller::Situation situation = situation_of(moment, *scenario_);
    const controller::Decision& decision = controller_->decide(situation);
    return drive_.record_of(situation, decision, certify);
  }

 private:
  std::unique_ptr<const Scenario> scenario_;
  harness::Drive drive_;
  std::unique_ptr<controller::Controller> controller_;
};

/// Certifies inputs and plans from any source.
class Certifier {
 public:
  explicit Certifier(Scenario scenario)
      : scenario_(std::make_unique<const Scenario>(std::move(scenario))), drive_(*scenario_) {}

  /// inputs: stages x input_dim; gains: stages x input_dim x state_dim.
  StepRecord plan(const RowMatrix& inputs,
                  std::optional<nb::ndarray<const double, nb::ndim<3>, nb::c_contig>> gains,
                  const Moment& moment) {
    Scenario planned = *scenario_;
    planned.controller.outside.plans = true;
    planned.controller.horizon = static_cast<int>(inputs.rows());
    harness::ControllerAnswer answer;
    answer.policy.inputs = inputs.transpose();
    for (std::size_t k = 0; gains && k < gains->shape(0); ++k) {
      const auto high = static_cast<Eigen::Index>(gains->shape(1));
      const auto wide = static_cast<Eigen::Index>(gains->shape(2));
      const double* const first = gains->data() + static_cast<Eigen::Index>(k) * high * wide;
      answer.policy.gains.emplace_back(Eigen::Map<const RowMatrix>(first, high, wide));
    }
    return certified(planned, std::move(answer), moment);
  }

  StepRecord input(const Eigen::VectorXd& input, const Moment& moment) {
    Scenario held = *scenario_;
    held.controller.outside.plans = false;
    return certified(held, {.input = input}, moment);
  }

 private:
  StepRecord certified(const Scenario& scenario, harness::ControllerAnswer answer,
                       const Moment& moment) {
    harness::AnsweredDecision decision(scenario, drive_.model());
    try {
      harness::complete_answer(answer, decision.shape());
    } catch (const harness::WrongAnswer& wrong) {
      throw std::invalid_argument("found " + wrong.found + ", expected " + wrong.expected);
    }
    if (moment.obstacles) drive_.know_obstacles(*moment.obstacles);
    const controller::Situation situation = situation_of(moment, *scenario_);
    controller::check_situation(situation, drive_.model().state_dim());
    return without_lock(
        [&] { return drive_.record_of(situation, decision.take(answer, situation, 0.0)); });
  }

  std::unique_ptr<const Scenario> scenario_;
  harness::Drive drive_;
};

Array<> gains_of(const StepRecord& record) {
  if (record.plan_gains.empty()) return array_of<double>({}, {0, 0, 0});
  const Eigen::MatrixXd& first = record.plan_gains.front();
  std::vector<double> numbers(record.plan_gains.size() * static_cast<std::size_t>(first.size()));
  double* at = numbers.data();
  for (const Eigen::MatrixXd& gain : record.plan_gains) {
    Eigen::Map<RowMatrix>(at, gain.rows(), gain.cols()) = gain;
    at += gain.size();
  }
  return array_of(std::move(numbers),
                  {record.plan_gains.size(), static_cast<std::size_t>(first.rows()),
                   static_cast<std::size_t>(first.cols())});
}

std::map<std::string, Eigen::VectorXd> certificates_of(const StepRecord& record) {
  std::map<std::string, Eigen::VectorXd> figures;
  const Eigen::Index stages = std::ssize(record.certificates);
  for (const controller::CertificateEntry& entry : controller::certificate_entries()) {
    figures[entry.key].resize(stages);
  }
  figures["value"].resize(stages);
  for (Eigen::Index n = 0; n < stages; ++n) {
    const auto& certificate = record.certificates[static_cast<std::size_t>(n)];
    figures["value"][n] = certificate.value;
    for (const controller::CertificateEntry& entry : controller::certificate_entries()) {
      figures[entry.key][n] = certificate.of(entry.key);
    }
  }
  return figures;
}

Eigen::VectorXd errors_of(const StepRecord& record) {
  Eigen::VectorXd errors(std::ssize(record.budgets));
  for (Eigen::Index n = 0; n < errors.size(); ++n) {
    errors[n] = record.budgets[static_cast<std::size_t>(n)].total;
  }
  return errors;
}

std::map<std::string, double> costs_of(const StepRecord& record) {
  std::map<std::string, double> costs;
  for (const controller::CostPartEntry& part : controller::cost_parts()) {
    costs[part.name] = record.cost.of(part.name);
  }
  return costs;
}

std::pair<RowMatrix, Eigen::VectorXd> particles_of(const StepRecord& record, std::size_t stage) {
  if (stage >= record.particles.size()) throw nb::index_error("that stage has no particles");
  return {as_rows(record.particles[stage].locations), record.particles[stage].weights};
}

void add_plan_class(nb::module_& module) {
  nb::class_<StepRecord>(module, "Plan")
      .def_ro("input", &StepRecord::input)
      .def_prop_ro("inputs", [](const StepRecord& r) { return as_rows(r.plan_inputs); })
      .def_prop_ro("states", [](const StepRecord& r) { return as_rows(r.plan_states); })
      .def_prop_ro("gains", &gains_of, nb::rv_policy::move)
      .def_ro("belief_mean", &StepRecord::belief_mean)
      .def_ro("belief_covariance", &StepRecord::belief_covariance)
      .def_ro("status", &StepRecord::solver_status)
      .def_ro("evaluations", &StepRecord::iterations)
      .def_ro("fallback", &StepRecord::fallback)
      .def_ro("believed", &StepRecord::believed)
      .def_prop_ro("costs", &costs_of)
      .def_prop_ro("certificates", &certificates_of)
      .def_prop_ro("horizon_bound",
                   [](const StepRecord& r) { return controller::horizon_bound(r.certificates); })
      .def_prop_ro("w2_bounds", &errors_of)
      .def_prop_ro("particle_stages", [](const StepRecord& r) { return r.particles.size(); })
      .def("particles", &particles_of, "stage"_a)
      .def_prop_ro("solve_ms", [](const StepRecord& r) { return r.timing.total; });
}

}  // namespace

void add_planning(nb::module_& module) {
  add_plan_class(module);
  nb::class_<Moment>(module, "Moment")
      .def_static("of", &moment_of, "mean"_a, "covariance"_a, "observation"_a, "period"_a,
                  "periods_left"_a, "deadline"_a, "obstacles"_a.none(),
                  "waypoints_passed"_a.none() = nb::none());
  nb::class_<Planner>(module, "Planner")
      .def(nb::init<Scenario>(), "scenario"_a)
      .def("reset", &Planner::reset, "seed"_a)
      .def(
          "decide",
          [](Planner& planner, const Moment& moment, bool certify) {
            return without_lock([&] { return planner.decide(moment, certify); });
          },
          "moment"_a, "certify"_a);
  nb::class_<Certifier>(module, "Certifier")
      .def(nb::init<Scenario>(), "scenario"_a)
      .def("plan", &Certifier::plan, "inputs"_a, "gains"_a.none(), "moment"_a)
      .def("input", &Certifier::input, "input"_a, "moment"_a);
}

}  // namespace qsmpc::python
