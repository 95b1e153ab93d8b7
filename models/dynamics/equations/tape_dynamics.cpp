#include "models/dynamics/equations/tape_dynamics.hpp"

#include <array>
#include <utility>

#include "models/constants.hpp"
#include "models/dynamics/equations/tape_jets.hpp"
#include "models/dynamics/equations/tape_program.hpp"
#include "models/dynamics/local_lipschitz.hpp"

namespace qsmpc::models {
namespace {

// Most rows of a batch that a program takes: states, inputs and adjoints.
constexpr std::size_t kMostRows = 2 * static_cast<std::size_t>(kMostCoordinates);

using Rows = std::array<const double*, kMostRows>;
using RowsOut = std::array<double*, kMostRows>;

class TapeDynamics final : public Dynamics {
 public:
  TapeDynamics(SystemDescription description, Tape tape)
      : description_(std::move(description)),
        tape_(std::move(tape)),
        step_(compile(tape_)),
        pullback_(compile(reverse(tape_))),
        everywhere_(bounds_everywhere(tape_)) {}

  [[nodiscard]] const SystemDescription& description() const override { return description_; }

  void step(const BatchView& states, const BatchView& inputs, BatchOut next) const override {
    Rows from{};
    RowsOut to{};
    add_rows(inputs, add_rows(states, 0, from), from);
    add_rows(next, 0, to);
    run(step_, from.data(), to.data(), static_cast<std::size_t>(states.cols()));
  }

  void pullback(const BatchView& states, const BatchView& inputs, const BatchView& next_adjoint,
                BatchOut state_adjoint, BatchOut input_adjoint) const override {
    Rows from{};
    RowsOut to{};
    add_rows(next_adjoint, add_rows(inputs, add_rows(states, 0, from), from), from);
    add_rows(input_adjoint, add_rows(state_adjoint, 0, to), to);
    run(pullback_, from.data(), to.data(), static_cast<std::size_t>(states.cols()));
  }

  /// One pullback for each of the new states.
  void jacobians(const Eigen::Ref<const Eigen::VectorXd>& state,
                 const Eigen::Ref<const Eigen::VectorXd>& input,
                 Eigen::Ref<Eigen::MatrixXd> state_jacobian,
                 Eigen::Ref<Eigen::MatrixXd> input_jacobian) const override {
    using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor,
                                 kMostCoordinates, kMostCoordinates>;
    const Eigen::Index dim = state.size();
    const Square states = state.replicate(1, dim);
    const Square inputs = input.replicate(1, dim);
    const Square adjoints = Square::Identity(dim, dim);
    Square of_states(dim, dim);
    Square of_inputs(input.size(), dim);
    pullback(states, inputs, adjoints, of_states, of_inputs);
    state_jacobian = of_states.transpose();
    input_jacobian = of_inputs.transpose();
  }

  [[nodiscard]] double lipschitz(const Eigen::Ref<const Eigen::MatrixXd>& gain) const override {
    return local_lipschitz(everywhere_, gain);
  }

  [[nodiscard]] DerivativeBounds derivative_bounds(
      const Eigen::Ref<const Eigen::VectorXd>& lower,
      const Eigen::Ref<const Eigen::VectorXd>& upper) const override {
    check_box(description_, lower, upper);
    return derivative_bounds_of(tape_, lower, upper);
  }

 private:
  static DerivativeBounds bounds_everywhere(const Tape& tape) {
    const Eigen::VectorXd infinite = Eigen::VectorXd::Constant(tape.argument_count(), kInfinity);
    return derivative_bounds_of(tape, -infinite, infinite);
  }

  static std::size_t add_rows(const BatchView& batch, std::size_t first, Rows& rows) {
    for (Eigen::Index i = 0; i < batch.rows(); ++i) {
      rows[first++] = batch.data() + i * batch.outerStride();
    }
    return first;
  }
  static std::size_t add_rows(BatchOut& batch, std::size_t first, RowsOut& rows) {
    for (Eigen::Index i = 0; i < batch.rows(); ++i) {
      rows[first++] = batch.data() + i * batch.outerStride();
    }
    return first;
  }

  SystemDescription description_;
  Tape tape_;
  TapeProgram step_;
  TapeProgram pullback_;
  DerivativeBounds everywhere_;
};

}  // namespace

std::unique_ptr<const Dynamics> make_tape_dynamics(SystemDescription description, Tape tape) {
  return std::make_unique<TapeDynamics>(std::move(description), std::move(tape));
}

}  // namespace qsmpc::models
