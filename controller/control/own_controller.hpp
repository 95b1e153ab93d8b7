// User-defined controllers in C++, outside qsmpc, from a class:
//
//   class Brake {
//    public:
//     explicit Brake(const qsmpc::own::Problem& problem) : inputs_(problem.input_dim()) {}
//     void reset(std::uint64_t seed) {}  // optional
//     qsmpc::own::Answer act(const qsmpc::own::Situation& situation) {
//       return {.input = Eigen::VectorXd::Zero(inputs_)};
//     }
//    private:
//     Eigen::Index inputs_;
//   };
//   QSMPC_REGISTER_CONTROLLER(Brake);
//
// Compile it into a shared library, and name that in a scenario: `controller: {kind: library,
// library: brake.so}`. Needs Eigen and the standard library, but no library of qsmpc. An exception
// ends the drive as a fault of its controller, with the message as the reason.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "controller/control/controller_abi.h"

namespace qsmpc::own {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using VectorView = Eigen::Map<const Eigen::VectorXd>;
using MatrixView = Eigen::Map<const RowMajor>;

/// The resolved scenario; `raw` has all of its fields, with units.
class Problem {
 public:
  explicit Problem(const qsmpc_problem& problem) : raw(problem) {}

  [[nodiscard]] Eigen::Index state_dim() const { return raw.state_dim; }
  [[nodiscard]] Eigen::Index input_dim() const { return raw.input_dim; }
  [[nodiscard]] int horizon() const { return raw.horizon; }
  [[nodiscard]] bool plans() const { return raw.plans != 0; }
  [[nodiscard]] double time_step() const { return raw.time_step; }
  [[nodiscard]] VectorView input_lower() const { return {raw.input_lower, input_dim()}; }
  [[nodiscard]] VectorView input_upper() const { return {raw.input_upper, input_dim()}; }
  [[nodiscard]] VectorView target() const { return {raw.target, state_dim()}; }
  [[nodiscard]] MatrixView noise_covariance() const {
    return {raw.noise_covariance, state_dim(), state_dim()};
  }
  [[nodiscard]] MatrixView cost_state() const { return {raw.cost_state, state_dim(), state_dim()}; }
  [[nodiscard]] MatrixView cost_input() const { return {raw.cost_input, input_dim(), input_dim()}; }
  [[nodiscard]] MatrixView cost_terminal() const {
    return {raw.cost_terminal, state_dim(), state_dim()};
  }
  [[nodiscard]] VectorView bounds_lower() const { return {raw.bounds_lower, state_dim()}; }
  [[nodiscard]] VectorView bounds_upper() const { return {raw.bounds_upper, state_dim()}; }
  /// One obstacle per row.
  [[nodiscard]] MatrixView obstacle_lower() const {
    return {raw.obstacle_lower, raw.obstacle_count, state_dim()};
  }
  [[nodiscard]] MatrixView obstacle_upper() const {
    return {raw.obstacle_upper, raw.obstacle_count, state_dim()};
  }
  /// A constant of the system. Throws std::invalid_argument on an unknown name.
  [[nodiscard]] double parameter(const std::string& name) const {
    for (std::int32_t i = 0; i < raw.parameter_count; ++i) {
      if (name == raw.parameter_names[i]) return raw.parameter_values[i];
    }
    throw std::invalid_argument("the system has no constant " + name);
  }

  const qsmpc_problem& raw;  // NOLINT(cppcoreguidelines-avoid-const-or-ref-data-members)
};

/// What is known when an input is chosen.
class Situation {
 public:
  Situation(const qsmpc_situation& situation, Eigen::Index state_dim)
      : period(situation.period),
        periods_left(situation.periods_left),
        time(situation.time),
        deadline(situation.deadline),
        observation(situation.observation, state_dim),
        mean(situation.mean, state_dim),
        covariance(situation.covariance, state_dim, state_dim) {}

  std::int64_t period;        ///< of the drive, from 0
  std::int64_t periods_left;  ///< including this one, at most
  double time;                ///< s
  double deadline;            ///< s from now
  VectorView observation;     ///< observation of the present state
  VectorView mean;            ///< of the state, predicted before the observation
  MatrixView covariance;
};

struct Answer {
  Eigen::VectorXd input{};             ///< input_dim; ignored when plans are requested
  Eigen::MatrixXd plan_inputs{};       ///< input_dim x horizon
  std::vector<RowMajor> plan_gains{};  ///< one input_dim x state_dim per stage; empty: zero
  const char* status = nullptr;        ///< see qsmpc_answer
  int evaluations = 0;
};

namespace detail {

inline void put(const char* text, char* error, std::size_t size) {
  if (size == 0) return;
  const std::size_t length = std::min(std::char_traits<char>::length(text), size - 1);
  std::copy_n(text, length, error);
  error[length] = '\0';
}

/// The table's functions for a class.
template <class Own>
class Adapter {
 public:
  static void* create(const qsmpc_problem* problem, char* error, std::size_t size) {
    void* made = nullptr;
    guarded(error, size, [&] { made = new Adapter(*problem); });
    return made;
  }
  static void reset(void* self, std::uint64_t seed) {
    if constexpr (requires(Own & own) { own.reset(seed); }) of(self).own_.reset(seed);
  }
  static std::int32_t act(void* self, const qsmpc_situation* situation, qsmpc_answer* answer,
                          char* error, std::size_t size) {
    return guarded(error, size, [&] {
      Adapter& adapter = of(self);
      adapter.take(adapter.own_.act(Situation(*situation, adapter.problem_.state_dim())), *answer);
    });
  }
  static void destroy(void* self) { delete &of(self); }

 private:
  explicit Adapter(const qsmpc_problem& problem) : problem_(problem), own_(problem_) {}

  static Adapter& of(void* self) { return *static_cast<Adapter*>(self); }

  template <class Work>
  static std::int32_t guarded(char* error, std::size_t size, const Work& work) {
    try {
      work();
      return 0;
    } catch (const std::exception& exception) {
      put(exception.what(), error, size);
    } catch (...) {
      put("an unknown exception", error, size);
    }
    return 1;
  }

  void take(const Answer& made, qsmpc_answer& answer) {
    const Eigen::Index inputs = problem_.input_dim();
    status_ = made.status == nullptr ? "" : made.status;
    answer.status = status_.empty() ? nullptr : status_.c_str();
    answer.evaluations = made.evaluations;
    if (!problem_.plans()) {
      answer.input_count = static_cast<std::int32_t>(made.input.size());
      std::copy_n(made.input.data(), std::min(made.input.size(), inputs), answer.input);
      return;
    }
    require(made.plan_inputs.rows() == inputs && made.plan_inputs.cols() == problem_.horizon(),
            "plan_inputs are not input_dim x horizon");
    // Column-major with one stage per column has the same memory order as row-major with one per
    // row.
    std::copy_n(made.plan_inputs.data(), made.plan_inputs.size(), answer.plan_inputs);
    if (made.plan_gains.empty()) return;
    require(std::ssize(made.plan_gains) == problem_.horizon(), "plan_gains are not one per stage");
    double* out = answer.plan_gains;
    for (const RowMajor& gain : made.plan_gains) {
      require(gain.rows() == inputs && gain.cols() == problem_.state_dim(),
              "plan_gains are not input_dim x state_dim");
      out = std::copy_n(gain.data(), gain.size(), out);
    }
  }

  static void require(bool holds, const char* message) {
    if (!holds) throw std::invalid_argument(message);
  }

  Problem problem_;
  Own own_;
  std::string status_;
};

}  // namespace detail
}  // namespace qsmpc::own

/// Makes the class the controller of the shared library, which has exactly one. Use at namespace
/// scope.
#define QSMPC_REGISTER_CONTROLLER(Class)                                                       \
  extern "C" __attribute__((visibility("default"))) const qsmpc_controller_table*              \
  qsmpc_controller(void) {                                                                     \
    using QsmpcAdapter = qsmpc::own::detail::Adapter<Class>;                                   \
    static const qsmpc_controller_table table = {QSMPC_CONTROLLER_ABI, #Class,                 \
                                                 QsmpcAdapter::create, QsmpcAdapter::reset,    \
                                                 QsmpcAdapter::act,    QsmpcAdapter::destroy}; \
    return &table;                                                                             \
  }                                                                                            \
  static_assert(true, "so that a semicolon may follow")
