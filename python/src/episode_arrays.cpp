// Episodes as arrays.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "python/src/arrays.hpp"
#include "python/src/episodes.hpp"
#include <nanobind/stl/map.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>

#include "controller/certification/certificate.hpp"
#include "controller/planning/cost/cost_parts.hpp"
#include "models/constants.hpp"

namespace qsmpc::python {
namespace {

namespace nb = nanobind;
using nb::literals::operator""_a;
using harness::StepRecord;
using harness::Trace;

/// A vector of each step as steps x n; NaN where a step has none.
template <class Value>
RowMatrix by_step(const Trace& trace, Eigen::Index width, const Value& value) {
  RowMatrix rows = RowMatrix::Constant(std::ssize(trace.steps), width, kNotANumber);
  for (Eigen::Index k = 0; k < rows.rows(); ++k) {
    const Eigen::VectorXd& vector = value(trace.steps[static_cast<std::size_t>(k)]);
    if (vector.size() == width) rows.row(k) = vector.transpose();
  }
  return rows;
}

/// A number of each step, as a vector.
template <class Value>
Eigen::VectorXd each_step(const Trace& trace, const Value& value) {
  Eigen::VectorXd numbers(std::ssize(trace.steps));
  for (Eigen::Index k = 0; k < numbers.size(); ++k) {
    numbers[k] = value(trace.steps[static_cast<std::size_t>(k)]);
  }
  return numbers;
}

/// A matrix of each step as steps x rows x cols; its columns become rows.
template <class Value>
Array<> matrices(const Trace& trace, Eigen::Index rows, Eigen::Index cols, const Value& value) {
  const auto size = static_cast<std::size_t>(rows * cols);
  std::vector<double> numbers(trace.steps.size() * size, kNotANumber);
  for (std::size_t k = 0; k < trace.steps.size(); ++k) {
    const Eigen::MatrixXd& matrix = value(trace.steps[k]);
    if (matrix.cols() != rows || matrix.rows() != cols) continue;
    Eigen::Map<RowMatrix>(numbers.data() + k * size, rows, cols) = matrix.transpose();
  }
  return array_of(std::move(numbers), {trace.steps.size(), static_cast<std::size_t>(rows),
                                       static_cast<std::size_t>(cols)});
}

Eigen::Index state_dim(const Trace& trace) { return std::ssize(trace.system.states); }
Eigen::Index input_dim(const Trace& trace) { return std::ssize(trace.system.inputs); }

Eigen::VectorXd times_of(const Episode& episode) {
  const Eigen::Index count = episode.view().states().cols();
  return Eigen::VectorXd::LinSpaced(count, 0.0, static_cast<double>(count - 1)) *
         episode.trace().scenario.time_step;
}

Array<> gains_of(const Episode& episode) {
  const Trace& trace = episode.trace();
  const auto stages = static_cast<std::size_t>(episode.view().parts().stages);
  const auto inputs = static_cast<std::size_t>(input_dim(trace));
  const auto states = static_cast<std::size_t>(state_dim(trace));
  const std::size_t size = inputs * states;
  std::vector<double> numbers(trace.steps.size() * stages * size, kNotANumber);
  for (std::size_t k = 0; k < trace.steps.size(); ++k) {
    const auto& gains = trace.steps[k].plan_gains;
    for (std::size_t stage = 0; stage < std::min(stages, gains.size()); ++stage) {
      Eigen::Map<RowMatrix>(numbers.data() + (k * stages + stage) * size, input_dim(trace),
                            state_dim(trace)) = gains[stage];
    }
  }
  return array_of(std::move(numbers), {trace.steps.size(), stages, inputs, states});
}

/// The locations (points x n) and weights of a stage's particles.
std::pair<RowMatrix, Eigen::VectorXd> particles_of(const Episode& episode, std::size_t step,
                                                   std::size_t stage) {
  const auto& steps = episode.trace().steps;
  if (step >= steps.size() || stage >= steps[step].particles.size()) {
    throw nb::index_error("no such step or stage, or the controller has no particles");
  }
  const harness::StageParticles& measure = steps[step].particles[stage];
  return {as_rows(measure.locations), measure.weights};
}

/// steps x stages for each figure by its key, and for the value in force under "value".
std::map<std::string, RowMatrix> certificates_of(const Episode& episode) {
  const Trace& trace = episode.trace();
  const Eigen::Index stages = std::max(episode.view().parts().stages, 1);
  std::map<std::string, RowMatrix> figures;
  const auto fill = [&](const std::string& key, const auto& number) {
    RowMatrix& rows = figures[key];
    rows.setConstant(std::ssize(trace.steps), stages, kNotANumber);
    for (Eigen::Index k = 0; k < rows.rows(); ++k) {
      const auto& all = trace.steps[static_cast<std::size_t>(k)].certificates;
      for (Eigen::Index n = 0; n < std::min(stages, std::ssize(all)); ++n) {
        rows(k, n) = number(all[static_cast<std::size_t>(n)]);
      }
    }
  };
  fill("value", [](const auto& certificate) { return certificate.value; });
  for (const controller::CertificateEntry& entry : controller::certificate_entries()) {
    fill(entry.key, [&](const auto& certificate) { return certificate.of(entry.key); });
  }
  return figures;
}

/// steps x (stages + 1): the 2-Wasserstein error of the particles.
RowMatrix errors_of(const Episode& episode) {
  const Trace& trace = episode.trace();
  const Eigen::Index stages = std::max(episode.view().parts().stages, 1) + 1;
  RowMatrix rows = RowMatrix::Constant(std::ssize(trace.steps), stages, kNotANumber);
  for (Eigen::Index k = 0; k < rows.rows(); ++k) {
    const auto& budgets = trace.steps[static_cast<std::size_t>(k)].budgets;
    for (Eigen::Index n = 0; n < std::min(stages, std::ssize(budgets)); ++n) {
      rows(k, n) = budgets[static_cast<std::size_t>(n)].total;
    }
  }
  return rows;
}

std::map<std::string, Eigen::VectorXd> costs_of(const Episode& episode) {
  std::map<std::string, Eigen::VectorXd> costs;
  for (const controller::CostPartEntry& part : controller::cost_parts()) {
    costs[part.name] =
        each_step(episode.trace(), [&](const StepRecord& step) { return step.cost.of(part.name); });
  }
  return costs;
}

std::map<std::string, Eigen::VectorXd> timings_of(const Episode& episode) {
  const Trace& trace = episode.trace();
  return {
      {"quantise", each_step(trace, [](const auto& s) { return s.timing.quantise; })},
      {"propagate", each_step(trace, [](const auto& s) { return s.timing.propagate; })},
      {"optimise", each_step(trace, [](const auto& s) { return s.timing.optimise; })},
      {"certify", each_step(trace, [](const auto& s) { return s.timing.certify; })},
      {"total", each_step(trace, [](const auto& s) { return s.timing.total; })},
      {"simulate", each_step(trace, [](const auto& s) { return s.timing.simulate; })},
  };
}

/// Times (samples) and generalised positions (samples x nq) of the vehicle between control
/// instants.
std::pair<Eigen::VectorXd, RowMatrix> motion_of(const Episode& episode) {
  const auto& motion = episode.trace().motion;
  const Eigen::Index width = motion.empty() ? 0 : std::ssize(motion.front().qpos);
  Eigen::VectorXd times(std::ssize(motion));
  RowMatrix positions(times.size(), width);
  for (Eigen::Index n = 0; n < times.size(); ++n) {
    const harness::MotionSample& sample = motion[static_cast<std::size_t>(n)];
    times[n] = sample.time;
    positions.row(n) = Eigen::Map<const Eigen::RowVectorXd>(sample.qpos.data(), width);
  }
  return {times, positions};
}

}  // namespace

void add_episode_arrays(nb::class_<Episode>& type) {
  type.def_prop_ro("times", &times_of)
      .def_prop_ro("states", [](const Episode& e) { return as_rows(e.view().states()); })
      .def_prop_ro("clearances", [](const Episode& e) { return e.view().clearances(); })
      .def_prop_ro("residuals", [](const Episode& e) { return as_rows(e.view().residuals()); })
      .def_prop_ro("observations",
                   [](const Episode& e) {
                     return by_step(
                         e.trace(), state_dim(e.trace()),
                         [](const auto& s) -> auto& { return s.observation; });
                   })
      .def_prop_ro("inputs",
                   [](const Episode& e) {
                     return by_step(
                         e.trace(), input_dim(e.trace()),
                         [](const auto& s) -> auto& { return s.input; });
                   })
      .def_prop_ro("disturbances",
                   [](const Episode& e) {
                     return by_step(
                         e.trace(), state_dim(e.trace()),
                         [](const auto& s) -> auto& { return s.disturbance; });
                   })
      .def_prop_ro("belief_means",
                   [](const Episode& e) {
                     return by_step(
                         e.trace(), state_dim(e.trace()),
                         [](const auto& s) -> auto& { return s.belief_mean; });
                   })
      .def_prop_ro(
          "belief_covariances",
          [](const Episode& e) {
            return matrices(
                e.trace(), state_dim(e.trace()), state_dim(e.trace()),
                [](const auto& s) -> auto& { return s.belief_covariance; });
          },
          nb::rv_policy::move)
      .def_prop_ro(
          "plan_inputs",
          [](const Episode& e) {
            return matrices(
                e.trace(), e.view().parts().stages, input_dim(e.trace()),
                [](const auto& s) -> auto& { return s.plan_inputs; });
          },
          nb::rv_policy::move)
      .def_prop_ro(
          "plan_states",
          [](const Episode& e) {
            const Eigen::Index stages = e.view().parts().stages;
            return matrices(
                e.trace(), stages > 0 ? stages + 1 : 0, state_dim(e.trace()),
                [](const auto& s) -> auto& { return s.plan_states; });
          },
          nb::rv_policy::move)
      .def_prop_ro("plan_gains", &gains_of, nb::rv_policy::move)
      .def("particles", &particles_of, "step"_a, "stage"_a)
      .def_prop_ro("certificates", &certificates_of)
      .def_prop_ro("w2_bounds", &errors_of)
      .def_prop_ro("plan_costs", &costs_of)
      .def_prop_ro("timings", &timings_of)
      .def_prop_ro("motion", &motion_of);
}

}  // namespace qsmpc::python
