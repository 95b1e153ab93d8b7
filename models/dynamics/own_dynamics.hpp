// A user-defined system in C++, compiled outside qsmpc into a shared library that a scenario names.
// A complete example:
//
//   #include <qsmpc/models/dynamics/own_dynamics.hpp>
//
//   struct Cart {
//     static qsmpc::own::System system() {
//       return {.name = "cart",
//               .states = {{"position", "m"}, {"velocity", "m/s"}},
//               .inputs = {{"force", "N", -10.0, 10.0}},
//               .parameters = {{"mass", "kg", 2.0}}};
//     }
//     explicit Cart(const qsmpc::own::Setup& setup)
//         : time_step(setup.time_step), mass(setup.parameter("mass")) {}
//
//     template <class Scalar>
//     void step(const Scalar* x, const Scalar* u, Scalar* next) const {
//       next[0] = x[0] + time_step * x[1];
//       next[1] = x[1] + time_step * u[0] / mass;
//     }
//
//     double time_step;  // s
//     double mass;       // kg
//   };
//   QSMPC_REGISTER_DYNAMICS(Cart)
//
// `step` is compiled for double and for a scalar that records the operations on it, from which
// qsmpc generates derivatives, their enclosures and loops over batches. It may use arithmetic and
// the <cmath> functions declared below, but cannot compare values: use min, max, abs or tanh.
//
// This header needs only the standard library and no linking. A constructor rejects parameters by
// throwing std::invalid_argument.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <initializer_list>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "own_dynamics_abi.h"  // installed beside this file

#if defined(__GNUC__) || defined(__clang__)
#define QSMPC_OWN_EXPORT __attribute__((visibility("default"), used))
#define QSMPC_OWN_HIDDEN __attribute__((visibility("hidden")))
#else
#define QSMPC_OWN_EXPORT
#define QSMPC_OWN_HIDDEN
#endif

namespace qsmpc::own {

struct State {
  const char* name;
  const char* unit = "";  ///< SI symbol, e.g. "m/s"
  bool is_angle = false;  ///< whether values 2π apart are equivalent
};

struct Input {
  const char* name;
  const char* unit;
  double lower;  ///< bounds, finite
  double upper;
};

struct Parameter {
  const char* name;
  const char* unit;
  double value;  ///< default; a scenario may give another
};

/// The description of a system. Strings must outlive the library: use literals.
struct System {
  const char* name;
  const char* summary = "";  ///< one line
  std::vector<State> states;
  std::vector<Input> inputs;
  std::vector<Parameter> parameters{};
  /// Names of the states of position in the plane and heading; empty if there are none.
  const char* position_x = "";
  const char* position_y = "";
  const char* heading = "";
};

/// The argument of a model's constructor.
class Setup {
 public:
  Setup(double control_period, const std::vector<Parameter>& parameters, const double* values)
      : time_step(control_period), parameters_(parameters), values_(values) {}

  /// The value of a parameter of the system. Throws std::invalid_argument if there is none.
  [[nodiscard]] double parameter(std::string_view name) const {
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
      if (parameters_[i].name == name) return values_[i];
    }
    throw std::invalid_argument("the system has no parameter '" + std::string(name) + "'");
  }
  /// The same; throws std::invalid_argument unless it is above 0.
  [[nodiscard]] double positive(std::string_view name) const {
    const double value = parameter(name);
    if (value > 0.0) return value;
    throw std::invalid_argument(std::string(name) + " must be above 0");
  }

  double time_step;  ///< s, the control period

 private:
  const std::vector<Parameter>& parameters_;
  const double* values_;
};

/// A number that records the operations on it.
class Recorded {
 public:
  Recorded() = default;
  /// A constant. Implicit, so that constants mix with recorded numbers.
  Recorded(double constant) : constant_(constant) {}  // NOLINT: implicit
  /// Value `number` of a recording.
  Recorded(const qsmpc_recorder* recorder, std::int32_t number)
      : recorder_(recorder), number_(number) {}

  /// The value's number in the recording of `recorder`.
  [[nodiscard]] std::int32_t number_in(const qsmpc_recorder* recorder) const {
    if (recorder_ != nullptr) return number_;
    return noted(recorder, QSMPC_CONSTANT, 0, 0, constant_);
  }

  friend Recorded operator+(const Recorded& a) { return a; }
  friend Recorded operator-(const Recorded& a) { return of(QSMPC_NEGATE, a, -a.constant_); }
  friend Recorded operator+(const Recorded& a, const Recorded& b) {
    return of(QSMPC_ADD, a, b, a.constant_ + b.constant_);
  }
  friend Recorded operator-(const Recorded& a, const Recorded& b) {
    return of(QSMPC_SUBTRACT, a, b, a.constant_ - b.constant_);
  }
  friend Recorded operator*(const Recorded& a, const Recorded& b) {
    return of(QSMPC_MULTIPLY, a, b, a.constant_ * b.constant_);
  }
  friend Recorded operator/(const Recorded& a, const Recorded& b) {
    return of(QSMPC_DIVIDE, a, b, a.constant_ / b.constant_);
  }
  Recorded& operator+=(const Recorded& other) { return *this = *this + other; }
  Recorded& operator-=(const Recorded& other) { return *this = *this - other; }
  Recorded& operator*=(const Recorded& other) { return *this = *this * other; }
  Recorded& operator/=(const Recorded& other) { return *this = *this / other; }

  friend Recorded sqrt(const Recorded& a) { return of(QSMPC_SQRT, a, std::sqrt(a.constant_)); }
  friend Recorded sin(const Recorded& a) { return of(QSMPC_SIN, a, std::sin(a.constant_)); }
  friend Recorded cos(const Recorded& a) { return of(QSMPC_COS, a, std::cos(a.constant_)); }
  friend Recorded tan(const Recorded& a) { return of(QSMPC_TAN, a, std::tan(a.constant_)); }
  friend Recorded asin(const Recorded& a) { return of(QSMPC_ASIN, a, std::asin(a.constant_)); }
  friend Recorded acos(const Recorded& a) { return of(QSMPC_ACOS, a, std::acos(a.constant_)); }
  friend Recorded atan(const Recorded& a) { return of(QSMPC_ATAN, a, std::atan(a.constant_)); }
  friend Recorded exp(const Recorded& a) { return of(QSMPC_EXP, a, std::exp(a.constant_)); }
  friend Recorded log(const Recorded& a) { return of(QSMPC_LOG, a, std::log(a.constant_)); }
  friend Recorded sinh(const Recorded& a) { return of(QSMPC_SINH, a, std::sinh(a.constant_)); }
  friend Recorded cosh(const Recorded& a) { return of(QSMPC_COSH, a, std::cosh(a.constant_)); }
  friend Recorded tanh(const Recorded& a) { return of(QSMPC_TANH, a, std::tanh(a.constant_)); }
  friend Recorded abs(const Recorded& a) { return of(QSMPC_ABS, a, std::abs(a.constant_)); }
  friend Recorded fabs(const Recorded& a) { return abs(a); }
  friend Recorded atan2(const Recorded& y, const Recorded& x) {
    return of(QSMPC_ATAN2, y, x, std::atan2(y.constant_, x.constant_));
  }
  friend Recorded pow(const Recorded& a, const Recorded& b) {
    return of(QSMPC_POWER, a, b, std::pow(a.constant_, b.constant_));
  }
  friend Recorded min(const Recorded& a, const Recorded& b) {
    return of(QSMPC_MIN, a, b, std::fmin(a.constant_, b.constant_));
  }
  friend Recorded max(const Recorded& a, const Recorded& b) {
    return of(QSMPC_MAX, a, b, std::fmax(a.constant_, b.constant_));
  }

 private:
  static std::int32_t noted(const qsmpc_recorder* recorder, std::int32_t operation, std::int32_t a,
                            std::int32_t b, double constant) {
    const std::int32_t number = recorder->record(recorder->context, operation, a, b, constant);
    if (number < 0) throw std::runtime_error("the step is too long");
    return number;
  }
  static Recorded of(std::int32_t operation, const Recorded& a, double constant) {
    if (a.recorder_ == nullptr) return {constant};
    return {a.recorder_, noted(a.recorder_, operation, a.number_, 0, 0.0)};
  }
  static Recorded of(std::int32_t operation, const Recorded& a, const Recorded& b,
                     double constant) {
    const qsmpc_recorder* const recorder = a.recorder_ != nullptr ? a.recorder_ : b.recorder_;
    if (recorder == nullptr) return {constant};
    const std::int32_t first = a.number_in(recorder);
    const std::int32_t second = b.number_in(recorder);
    return {recorder, noted(recorder, operation, first, second, 0.0)};
  }

  const qsmpc_recorder* recorder_ = nullptr;  // null for a constant
  std::int32_t number_ = 0;
  double constant_ = 0.0;
};

/// The table entry of `Model`. Hidden, like the functions below: two libraries in one program must
/// not share it.
template <class Model>
class QSMPC_OWN_HIDDEN Registration {
 public:
  static const qsmpc_system* entry() {
    static const Registration registration;
    return &registration.entry_;
  }

 private:
  Registration() : system_(Model::system()) {
    for (const State& state : system_.states) {
      states_.push_back({state.name, state.unit, state.is_angle ? 1 : 0, 0.0, 0.0});
    }
    for (const Input& input : system_.inputs) {
      inputs_.push_back({input.name, input.unit, 0, input.lower, input.upper});
    }
    for (const Parameter& parameter : system_.parameters) {
      parameters_.push_back({parameter.name, parameter.unit, parameter.value});
    }
    entry_ = {system_.name,
              system_.summary,
              states_.data(),
              inputs_.data(),
              parameters_.data(),
              static_cast<std::int32_t>(states_.size()),
              static_cast<std::int32_t>(inputs_.size()),
              static_cast<std::int32_t>(parameters_.size()),
              state_called(system_.position_x),
              state_called(system_.position_y),
              state_called(system_.heading),
              create,
              destroy,
              step,
              record};
  }

  [[nodiscard]] std::int32_t state_called(std::string_view name) const {
    for (std::size_t i = 0; i < system_.states.size(); ++i) {
      if (system_.states[i].name == name) return static_cast<std::int32_t>(i);
    }
    return -1;
  }

  static const System& described() {
    static const System system = Model::system();
    return system;
  }

  static void* create(const double* parameters, double time_step, char* message,
                      std::size_t message_size) {
    try {
      return new Model(Setup(time_step, described().parameters, parameters));
    } catch (const std::exception& error) {
      std::strncpy(message, error.what(), message_size - 1);
      message[message_size - 1] = '\0';
    } catch (...) {
      message[0] = '\0';
    }
    return nullptr;
  }

  static void destroy(void* model) { delete static_cast<Model*>(model); }

  static std::int32_t step(const void* model, std::size_t count, const double* const* states,
                           const double* const* inputs, double* const* next) {
    try {
      std::vector<double> x(described().states.size());
      std::vector<double> u(described().inputs.size());
      std::vector<double> y(x.size());
      for (std::size_t particle = 0; particle < count; ++particle) {
        for (std::size_t i = 0; i < x.size(); ++i) x[i] = states[i][particle];
        for (std::size_t i = 0; i < u.size(); ++i) u[i] = inputs[i][particle];
        static_cast<const Model*>(model)->template step<double>(x.data(), u.data(), y.data());
        for (std::size_t i = 0; i < y.size(); ++i) next[i][particle] = y[i];
      }
      return 0;
    } catch (...) {
      return 1;
    }
  }

  static std::int32_t record(const void* model, const qsmpc_recorder* recorder,
                             std::int32_t* next) {
    try {
      std::vector<Recorded> x;
      std::vector<Recorded> u;
      std::int32_t number = 0;
      while (x.size() < described().states.size()) x.emplace_back(recorder, number++);
      while (u.size() < described().inputs.size()) u.emplace_back(recorder, number++);
      std::vector<Recorded> y(x.size(), Recorded(std::numeric_limits<double>::quiet_NaN()));
      static_cast<const Model*>(model)->template step<Recorded>(x.data(), u.data(), y.data());
      for (std::size_t i = 0; i < y.size(); ++i) next[i] = y[i].number_in(recorder);
      return 0;
    } catch (...) {
      return 1;
    }
  }

  System system_;
  std::vector<qsmpc_coordinate> states_;
  std::vector<qsmpc_coordinate> inputs_;
  std::vector<qsmpc_parameter> parameters_;
  qsmpc_system entry_{};
};

/// The systems of the library, in order of registration.
QSMPC_OWN_HIDDEN inline std::vector<const qsmpc_system*>& registered_systems() {
  static std::vector<const qsmpc_system*> systems;
  return systems;
}

QSMPC_OWN_HIDDEN inline bool add_system(const qsmpc_system* system) {
  registered_systems().push_back(system);
  return true;
}

QSMPC_OWN_HIDDEN inline const qsmpc_dynamics_table* table() {
  static qsmpc_dynamics_table table{};
  const auto& systems = registered_systems();
  table = {QSMPC_DYNAMICS_VERSION, static_cast<std::uint32_t>(systems.size()), systems.data()};
  return &table;
}

}  // namespace qsmpc::own

/// The symbol that qsmpc looks up in the library.
extern "C" QSMPC_OWN_EXPORT inline const qsmpc_dynamics_table* qsmpc_dynamics() {
  return qsmpc::own::table();
}

/// Registers a system of the library. Use it once per system, outside any namespace.
#define QSMPC_REGISTER_DYNAMICS(Model)                             \
  [[maybe_unused]] static const bool qsmpc_is_registered_##Model = \
      qsmpc::own::add_system(qsmpc::own::Registration<Model>::entry());
