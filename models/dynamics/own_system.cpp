#include "models/dynamics/own_system.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <random>
#include <stdexcept>
#include <utility>

#include "models/constants.hpp"
#include "models/dynamics/equations/expression.hpp"
#include "models/dynamics/equations/tape_dynamics.hpp"
#include "models/dynamics/parameter_checks.hpp"

namespace qsmpc::models {
namespace {

constexpr std::size_t kMessageSize = 512;  // bytes
// The recording and the step perform the same sums, but their sines differ in the last place.
constexpr double kRounding = 1e-9;
constexpr int kComparedPoints = 16;

std::string text_of(const char* text) { return text == nullptr ? "" : text; }

void check_name(const char* section, const std::string& name) {
  if (is_expression_name(name)) return;
  throw EquationError({.section = section,
                       .name = name,
                       .found = "the name '" + name + "'",
                       .expected = "a letter, then letters, digits and _"});
}

int index_of(std::int32_t index, std::int32_t count) { return index < count ? index : -1; }

/// Owns a model of the library.
class OwnModel {
 public:
  OwnModel(const qsmpc_system& system, const EquationSystem& described, double time_step,
           std::shared_ptr<const void> owner)
      : owner_(std::move(owner)), system_(system) {
    std::vector<double> values;
    for (const auto& parameter : described.parameters) values.push_back(parameter.value);
    std::array<char, kMessageSize> message{};
    model_ = system.create(values.data(), time_step, message.data(), message.size());
    message.back() = '\0';
    if (model_ != nullptr) return;
    const std::string words = message.data();
    throw std::invalid_argument(described.name + ": " +
                                (words.empty() ? "the library rejects its parameters" : words));
  }
  ~OwnModel() { system_.destroy(model_); }
  OwnModel(const OwnModel&) = delete;
  OwnModel& operator=(const OwnModel&) = delete;

  [[nodiscard]] const qsmpc_system& system() const { return system_; }

  void step(const Dynamics::BatchView& states, const Dynamics::BatchView& inputs,
            Dynamics::BatchOut next) const {
    std::array<const double*, kMostCoordinates> x{};
    std::array<const double*, kMostCoordinates> u{};
    std::array<double*, kMostCoordinates> y{};
    for (Eigen::Index i = 0; i < states.rows(); ++i) {
      x[i] = states.data() + i * states.outerStride();
      y[i] = next.data() + i * next.outerStride();
    }
    for (Eigen::Index i = 0; i < inputs.rows(); ++i) {
      u[i] = inputs.data() + i * inputs.outerStride();
    }
    const auto count = static_cast<std::size_t>(states.cols());
    // A failed step gives NaN, which the planner and the plant treat as a fault.
    if (system_.step(model_, count, x.data(), u.data(), y.data()) != 0)
      next.setConstant(kNotANumber);
  }

  [[nodiscard]] Tape recorded() const;

 private:
  std::shared_ptr<const void> owner_;  // outlives the model
  const qsmpc_system& system_;
  void* model_ = nullptr;
};

std::optional<Tape::Operation> operation_of(std::int32_t code) {
  switch (code) {
    case QSMPC_SQRT:
      return Tape::Operation::kSqrt;
    case QSMPC_SIN:
      return Tape::Operation::kSin;
    case QSMPC_COS:
      return Tape::Operation::kCos;
    case QSMPC_TAN:
      return Tape::Operation::kTan;
    case QSMPC_ASIN:
      return Tape::Operation::kAsin;
    case QSMPC_ACOS:
      return Tape::Operation::kAcos;
    case QSMPC_ATAN:
      return Tape::Operation::kAtan;
    case QSMPC_EXP:
      return Tape::Operation::kExp;
    case QSMPC_LOG:
      return Tape::Operation::kLog;
    case QSMPC_SINH:
      return Tape::Operation::kSinh;
    case QSMPC_COSH:
      return Tape::Operation::kCosh;
    case QSMPC_TANH:
      return Tape::Operation::kTanh;
    case QSMPC_ABS:
      return Tape::Operation::kAbs;
    case QSMPC_ATAN2:
      return Tape::Operation::kAtan2;
    case QSMPC_MIN:
      return Tape::Operation::kMin;
    case QSMPC_MAX:
      return Tape::Operation::kMax;
    default:
      return std::nullopt;
  }
}

std::int32_t put(Tape& tape, std::int32_t code, Tape::Id a, Tape::Id b, double constant) {
  switch (code) {
    case QSMPC_CONSTANT:
      return tape.constant(constant);
    case QSMPC_NEGATE:
      return tape.negate(a);
    case QSMPC_ADD:
      return tape.add(a, b);
    case QSMPC_SUBTRACT:
      return tape.subtract(a, b);
    case QSMPC_MULTIPLY:
      return tape.multiply(a, b);
    case QSMPC_DIVIDE:
      return tape.divide(a, b);
    case QSMPC_POWER:
      return tape.power(a, b);
    case QSMPC_ATAN2:
    case QSMPC_MIN:
    case QSMPC_MAX:
      return tape.binary(operation_of(code).value(), a, b);
    default: {
      const std::optional<Tape::Operation> operation = operation_of(code);
      return operation ? tape.unary(*operation, a) : -1;
    }
  }
}

/// The callback of a recording; the context is a Tape.
std::int32_t note(void* context, std::int32_t code, std::int32_t a, std::int32_t b,
                  double constant) {
  Tape& tape = *static_cast<Tape*>(context);
  const auto is_value = [&](std::int32_t id) { return id >= 0 && id < std::ssize(tape.nodes()); };
  if (!is_value(a) || !is_value(b)) return -1;
  try {
    return put(tape, code, a, b, constant);
  } catch (const std::exception&) {  // the tape would be too long
    return -1;
  }
}

Tape OwnModel::recorded() const {
  Tape tape(system_.state_count + system_.input_count);
  const qsmpc_recorder recorder{&tape, note};
  std::vector<std::int32_t> next(static_cast<std::size_t>(system_.state_count), -1);
  bool is_good = system_.record(model_, &recorder, next.data()) == 0;
  for (const std::int32_t id : next) is_good = is_good && id >= 0 && id < std::ssize(tape.nodes());
  if (!is_good)
    throw std::invalid_argument(text_of(system_.name) + ": its step cannot be recorded");
  tape.outputs.assign(next.begin(), next.end());
  return tape;
}

/// Only steps are known.
class PlainDynamics final : public Dynamics {
 public:
  PlainDynamics(SystemDescription description, std::unique_ptr<const OwnModel> model)
      : description_(std::move(description)), model_(std::move(model)) {}

  [[nodiscard]] const SystemDescription& description() const override { return description_; }

  void step(const BatchView& states, const BatchView& inputs, BatchOut next) const override {
    model_->step(states, inputs, next);
  }

  void pullback(const BatchView& states, const BatchView& inputs, const BatchView& next_adjoint,
                BatchOut state_adjoint, BatchOut input_adjoint) const override {
    StateBatch x = states;
    StateBatch u = inputs;
    for (int i = 0; i < state_dim(); ++i) {
      state_adjoint.row(i) = slope(x, u, x, i).cwiseProduct(next_adjoint).colwise().sum();
    }
    for (int i = 0; i < input_dim(); ++i) {
      input_adjoint.row(i) = slope(x, u, u, i).cwiseProduct(next_adjoint).colwise().sum();
    }
  }

  void jacobians(const Eigen::Ref<const Eigen::VectorXd>& state,
                 const Eigen::Ref<const Eigen::VectorXd>& input,
                 Eigen::Ref<Eigen::MatrixXd> state_jacobian,
                 Eigen::Ref<Eigen::MatrixXd> input_jacobian) const override {
    StateBatch x = state;
    StateBatch u = input;
    for (int i = 0; i < state_dim(); ++i) state_jacobian.col(i) = slope(x, u, x, i).col(0);
    for (int i = 0; i < input_dim(); ++i) input_jacobian.col(i) = slope(x, u, u, i).col(0);
  }

  [[nodiscard]] double lipschitz(const Eigen::Ref<const Eigen::MatrixXd>& /*gain*/) const override {
    return kInfinity;
  }

 private:
  /// The central difference of the step with respect to row `row` of `moved`, which is `x` or `u`.
  [[nodiscard]] StateBatch slope(StateBatch& x, StateBatch& u, StateBatch& moved, int row) const {
    constexpr double kStep = 6e-6;  // cube root of the rounding error
    const Eigen::RowVectorXd before = moved.row(row);
    const Eigen::RowVectorXd by = kStep * before.cwiseAbs().cwiseMax(1.0);
    StateBatch high(x.rows(), x.cols());
    StateBatch low(x.rows(), x.cols());
    moved.row(row) = before + by;
    model_->step(x, u, high);
    moved.row(row) = before - by;
    model_->step(x, u, low);
    moved.row(row) = before;
    return (high - low).array().rowwise() / (2.0 * by).array();
  }

  SystemDescription description_;
  std::unique_ptr<const OwnModel> model_;
};

/// Throws std::invalid_argument if the two steps differ at one of several random points within the
/// input bounds.
void compare(const Dynamics& recorded, const OwnModel& model) {
  const SystemDescription& system = recorded.description();
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto draw = [&] { return uniform(generator); };
  const StateBatch x = StateBatch::NullaryExpr(recorded.state_dim(), kComparedPoints, draw);
  StateBatch u = StateBatch::NullaryExpr(recorded.input_dim(), kComparedPoints, draw);
  const Eigen::VectorXd half = 0.5 * (system.input_upper - system.input_lower);
  u = (half.asDiagonal() * u).colwise() + 0.5 * (system.input_upper + system.input_lower);
  StateBatch one(x.rows(), x.cols());
  StateBatch other(x.rows(), x.cols());
  recorded.step(x, u, one);
  model.step(x, u, other);
  for (Eigen::Index i = 0; i < one.size(); ++i) {
    const double here = one.data()[i];
    const double there = other.data()[i];
    if (!std::isfinite(here) && !std::isfinite(there)) continue;
    if (std::abs(here - there) <= kRounding * (1.0 + std::abs(there))) continue;
    throw std::invalid_argument(
        system.name +
        ": the recorded step differs from the step: it depends on something "
        "other than states and inputs, or on comparisons of them");
  }
}

}  // namespace

EquationSystem own_system_of(const qsmpc_system& system) {
  EquationSystem own;
  own.name = text_of(system.name);
  own.summary = text_of(system.summary);
  own.input_lower.resize(std::max(system.input_count, 0));
  own.input_upper.resize(std::max(system.input_count, 0));
  const auto coordinate = [](const char* section, const qsmpc_coordinate& one) {
    check_name(section, text_of(one.name));
    return Coordinate{text_of(one.name), text_of(one.unit), one.is_angle != 0};
  };
  for (int i = 0; i < system.state_count; ++i) {
    own.states.push_back(coordinate("states", system.states[i]));
  }
  for (int i = 0; i < system.input_count; ++i) {
    const qsmpc_coordinate& input = system.inputs[i];
    own.inputs.push_back(coordinate("inputs", input));
    own.input_lower[i] = input.lower;
    own.input_upper[i] = input.upper;
    const bool is_good = std::isfinite(input.lower) && std::isfinite(input.upper);
    if (is_good && input.lower < input.upper) continue;
    throw EquationError({.section = "inputs",
                         .name = own.inputs.back().name,
                         .found = "bounds that are not an interval",
                         .expected = "finite bounds, lower < upper"});
  }
  for (int i = 0; i < system.parameter_count; ++i) {
    const qsmpc_parameter& parameter = system.parameters[i];
    check_name("parameters", text_of(parameter.name));
    own.parameters.push_back({text_of(parameter.name), parameter.value, text_of(parameter.unit)});
  }
  own.position_x = index_of(system.position_x, system.state_count);
  own.position_y = index_of(system.position_y, system.state_count);
  own.heading = index_of(system.heading, system.state_count);
  own.differentiable = system.record != nullptr;
  check_sizes(own);
  return own;
}

std::unique_ptr<const Dynamics> make_own_dynamics(const qsmpc_system& system,
                                                  const EquationSystem& described, double time_step,
                                                  std::shared_ptr<const void> owner) {
  check_time_step(described.name, time_step);
  auto model = std::make_unique<OwnModel>(system, described, time_step, std::move(owner));
  if (system.record == nullptr) {
    return std::make_unique<PlainDynamics>(description_of(described), std::move(model));
  }
  try {
    auto dynamics = make_tape_dynamics(description_of(described), model->recorded());
    compare(*dynamics, *model);
    return dynamics;
  } catch (const std::length_error&) {
    throw std::invalid_argument(described.name + ": its step is too long");
  }
}

}  // namespace qsmpc::models
