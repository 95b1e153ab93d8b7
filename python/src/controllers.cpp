#include "python/src/controllers.hpp"

#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "python/src/arrays.hpp"
#include "python/src/calls.hpp"
#include "python/src/module.hpp"
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "controller/planning/solvers/ocp_solver.hpp"
#include "controller/surroundings/obstacle_forecast.hpp"
#include "harness/control/controller_answer.hpp"

namespace qsmpc::python {
namespace {

namespace nb = nanobind;
using controller::Situation;

/// The controller's own copy of the situation.
struct ToldSituation {
  Eigen::Index period = 0;
  double time = 0.0;
  Eigen::VectorXd observation;
  Eigen::VectorXd belief_mean;
  Eigen::MatrixXd belief_covariance;
  Eigen::Index periods_left = 0;
  double deadline = std::numeric_limits<double>::infinity();
  std::optional<double> progress{};                    // number of waypoints passed
  std::vector<controller::PlacesByStage> obstacles{};  // moving ones
};

ToldSituation told(const Situation& now) {
  ToldSituation situation{.period = now.period,
                          .time = now.time,
                          .observation = now.observation,
                          .belief_mean = now.belief.mean,
                          .belief_covariance = now.belief.covariance,
                          .periods_left = now.periods_left};
  situation.progress = now.progress;
  if (now.deadline != std::chrono::steady_clock::time_point::max()) {
    const std::chrono::duration<double> left = now.deadline - std::chrono::steady_clock::now();
    situation.deadline = left.count();
  }
  if (now.obstacles != nullptr) {
    for (std::size_t n = 0; n < now.obstacles->size(); ++n) {
      situation.obstacles.push_back(now.obstacles->of(n));
    }
  }
  return situation;
}

/// Numbers from any array or nested list that NumPy accepts.
nb::ndarray<nb::numpy, const double, nb::c_contig> numbers(const nb::handle& value,
                                                           std::size_t dimensions,
                                                           const char* what) {
  const nb::object numpy = nb::module_::import_("numpy");
  nb::object array = numpy.attr("ascontiguousarray")(value, numpy.attr("float64"));
  auto typed = nb::cast<nb::ndarray<nb::numpy, const double, nb::c_contig>>(array);
  // A single input may be given as a number in place of an array of one.
  if (typed.ndim() == dimensions) return typed;
  throw harness::WrongAnswer{
      std::string(what) + " with " + std::to_string(typed.ndim()) + " dimensions",
      std::to_string(dimensions)};
}

Eigen::VectorXd vector_of(const nb::handle& value, const char* what) {
  const auto array = numbers(value, 1, what);
  return Eigen::Map<const Eigen::VectorXd>(array.data(), static_cast<Eigen::Index>(array.size()));
}

controller::SolverStatus status_of(const std::string& name) {
  using controller::SolverStatus;
  for (int n = 0; n <= static_cast<int>(SolverStatus::kNumericalTrouble); ++n) {
    const auto status = static_cast<SolverStatus>(n);
    if (name == controller::solver_status_name(status)) return status;
  }
  throw harness::WrongAnswer{"plan.status " + name, "a solver status, e.g. converged"};
}

nb::object member(const nb::handle& plan, const char* name) {
  if (nb::isinstance<nb::dict>(plan)) return plan.attr("get")(name);
  return nb::getattr(plan, name, nb::none());
}

harness::ControllerAnswer plan_answer(const nb::handle& plan) {
  harness::ControllerAnswer answer;
  const nb::object inputs = member(plan, "inputs");
  if (inputs.is_none()) throw harness::WrongAnswer{"a plan without inputs", "plan.inputs"};
  const auto rows = numbers(inputs, 2, "plan.inputs");
  answer.policy.inputs =
      Eigen::Map<const RowMatrix>(rows.data(), static_cast<Eigen::Index>(rows.shape(0)),
                                  static_cast<Eigen::Index>(rows.shape(1)))
          .transpose();
  if (const nb::object gains = member(plan, "gains"); !gains.is_none()) {
    const auto all = numbers(gains, 3, "plan.gains");
    const auto high = static_cast<Eigen::Index>(all.shape(1));
    const auto wide = static_cast<Eigen::Index>(all.shape(2));
    for (std::size_t k = 0; k < all.shape(0); ++k) {
      const double* const first = all.data() + static_cast<Eigen::Index>(k) * high * wide;
      answer.policy.gains.emplace_back(Eigen::Map<const RowMatrix>(first, high, wide));
    }
  }
  if (const nb::object status = member(plan, "status"); !status.is_none()) {
    answer.status = status_of(text_of(status));
  }
  if (const nb::object count = member(plan, "evaluations"); !count.is_none()) {
    answer.evaluations = nb::cast<int>(count);
  }
  return answer;
}

/// An answer is an array (the input), `{"input": …}`, `{"plan": …}`, or a plan object.
harness::ControllerAnswer answer_of(const nb::object& value, bool plans) {
  if (nb::isinstance<nb::dict>(value)) {
    const nb::object plan = value.attr("get")("plan");
    const nb::object input = value.attr("get")("input");
    if (plans && !plan.is_none()) return plan_answer(plan);
    if (!plans && !input.is_none()) return {.input = vector_of(input, "input")};
    if (plans && value.attr("get")("inputs").is_valid() && !value.attr("get")("inputs").is_none()) {
      return plan_answer(value);
    }
  } else if (plans && nb::hasattr(value, "inputs")) {
    return plan_answer(value);
  } else if (!plans && !value.is_none()) {
    return {.input = vector_of(value, "input")};
  }
  throw harness::WrongAnswer{text_of(nb::repr(value)),
                             plans ? "a plan: inputs, one row per stage" : "an array of inputs"};
}

/// Holds a Python object, and releases it under the interpreter's lock.
std::shared_ptr<nb::object> kept(nb::object object) {
  return {new nb::object(std::move(object)), [](nb::object* held) {
            const nb::gil_scoped_acquire lock;
            delete held;  // NOLINT(cppcoreguidelines-owning-memory)
          }};
}

/// Calls `work` with the lock; Python exceptions become std::runtime_error with their message.
template <class Work>
auto asked(const Work& work) {
  const nb::gil_scoped_acquire lock;
  try {
    return work();
  } catch (nb::python_error& error) {
    throw std::runtime_error(words_of(error));
  } catch (const nb::cast_error&) {
    throw std::runtime_error("an answer that contains something other than numbers");
  }
}

std::string name_of(const nb::object& object) {
  const nb::handle named = nb::hasattr(object, "__name__") ? nb::handle(object) : object.type();
  return text_of(nb::getattr(named, "__name__"));
}

}  // namespace

harness::ControllerObject controller_object(const nb::object& object) {
  const bool acts = nb::hasattr(object, "act");
  const nb::object function = acts ? nb::getattr(object, "act") : object;
  if (PyCallable_Check(function.ptr()) == 0) {
    throw nb::type_error(
        "a controller must be an object with act(situation), or a function of the situation");
  }
  harness::ControllerObject controller{.name = name_of(object)};
  const nb::object asked_for_plans = nb::getattr(object, "plans", nb::none());
  controller.plans = PyObject_IsTrue(asked_for_plans.ptr()) == 1;
  const bool plans = controller.plans;
  controller.act = [held = kept(function), plans](const Situation& now) {
    return asked([&] { return answer_of((*held)(told(now)), plans); });
  };
  if (nb::hasattr(object, "reset")) {
    controller.reset = [held = kept(nb::getattr(object, "reset"))](std::uint64_t seed) {
      asked([&] { (*held)(seed); });
    };
  }
  return controller;
}

void add_controllers(nb::module_& module) {
  using controller::ObstaclePlace;
  nb::class_<ObstaclePlace>(module, "ObstaclePlace",
                            "One of the ways in which an obstacle may have moved at a stage.")
      .def_ro("weight", &ObstaclePlace::weight, "Its probability.")
      .def_ro("offset", &ObstaclePlace::offset,
              "Mean offset from the shape's place in the scenario, m.")
      .def_ro("turn", &ObstaclePlace::turn, "Rotation about the shape's centre, rad.")
      .def_ro("covariance", &ObstaclePlace::covariance, "Covariance of the offset, m².");
  nb::class_<ToldSituation>(module, "Situation", "What a controller receives once per period.")
      .def_ro("period", &ToldSituation::period, "Number of the period in the drive, from 0.")
      .def_ro("time", &ToldSituation::time, "Start of the period, s.")
      .def_ro("observation", &ToldSituation::observation, "The current state as observed.")
      .def_ro("belief_mean", &ToldSituation::belief_mean,
              "Mean of the state, predicted before the observation.")
      .def_ro("belief_covariance", &ToldSituation::belief_covariance, "Its covariance.")
      .def_ro("periods_left", &ToldSituation::periods_left,
              "Periods left at most, including this one.")
      .def_ro("deadline", &ToldSituation::deadline,
              "Time left for the answer, s; infinite without a deadline.")
      .def_prop_ro(
          "waypoints_passed",
          [](const ToldSituation& s) -> std::optional<int> {
            if (!s.progress) return std::nullopt;
            return static_cast<int>(*s.progress);
          },
          "Number of waypoints that the mean has passed; None in a scenario without waypoints.")
      .def_ro(
          "obstacles", &ToldSituation::obstacles,
          "Predicted places of each moving obstacle, by stage from 0 (now) to the horizon, and by "
          "way.");
}

}  // namespace qsmpc::python
