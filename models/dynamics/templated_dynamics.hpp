// Turns a one-step function, written once for any scalar, into a full Dynamics: batch evaluation,
// reverse mode, Jacobians and enclosures of the derivatives. A new system is a struct with
//
//   static constexpr int kStateDim, kInputDim;
//   template <class Scalar> void step(const Scalar* x, const Scalar* u, Scalar* next) const;
//   SystemDescription description() const;
//   double lipschitz(const Eigen::Ref<const Eigen::MatrixXd>& gain) const;
//
// and one line in the table of dynamics.cpp. A hot system may derive from TemplatedDynamics and
// override `step` and `pullback`; the tests compare the overrides with the functions derived here.
#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

#include "models/dynamics/dynamics.hpp"
#include "models/dynamics/interval.hpp"
#include "models/dynamics/second_order_jet.hpp"

namespace qsmpc::models {

template <class Model>
class TemplatedDynamics : public Dynamics {
 public:
  static constexpr int kStateDim = Model::kStateDim;
  static constexpr int kInputDim = Model::kInputDim;

  explicit TemplatedDynamics(Model model)
      : model_(std::move(model)), description_(model_.description()) {}

  [[nodiscard]] const SystemDescription& description() const final { return description_; }

  void step(const BatchView& states, const BatchView& inputs, BatchOut next) const override {
    for (Eigen::Index i = 0; i < states.cols(); ++i) {
      const Eigen::Matrix<double, kStateDim, 1> x = states.col(i);
      const Eigen::Matrix<double, kInputDim, 1> u = inputs.col(i);
      Eigen::Matrix<double, kStateDim, 1> y;
      model_.template step<double>(x.data(), u.data(), y.data());
      next.col(i) = y;
    }
  }

  void pullback(const BatchView& states, const BatchView& inputs, const BatchView& next_adjoint,
                BatchOut state_adjoint, BatchOut input_adjoint) const override {
    for (Eigen::Index i = 0; i < states.cols(); ++i) {
      const Jacobian jacobian = differentiate(states.col(i), inputs.col(i));
      const Eigen::Matrix<double, kStateDim, 1> adjoint = next_adjoint.col(i);
      state_adjoint.col(i) = jacobian.template leftCols<kStateDim>().transpose() * adjoint;
      input_adjoint.col(i) = jacobian.template rightCols<kInputDim>().transpose() * adjoint;
    }
  }

  void jacobians(const Eigen::Ref<const Eigen::VectorXd>& state,
                 const Eigen::Ref<const Eigen::VectorXd>& input,
                 Eigen::Ref<Eigen::MatrixXd> state_jacobian,
                 Eigen::Ref<Eigen::MatrixXd> input_jacobian) const override {
    const Jacobian jacobian = differentiate(state, input);
    state_jacobian = jacobian.template leftCols<kStateDim>();
    input_jacobian = jacobian.template rightCols<kInputDim>();
  }

  [[nodiscard]] double lipschitz(const Eigen::Ref<const Eigen::MatrixXd>& gain) const final {
    return model_.lipschitz(gain);
  }

  [[nodiscard]] DerivativeBounds derivative_bounds(
      const Eigen::Ref<const Eigen::VectorXd>& lower,
      const Eigen::Ref<const Eigen::VectorXd>& upper) const final {
    check_box(description_, lower, upper);
    Jet z[kArguments];
    Jet next[kStateDim];
    for (int a = 0; a < kArguments; ++a) z[a] = Jet::variable(Interval(lower[a], upper[a]), a);
    model_.template step<Jet>(z, z + kStateDim, next);
    DerivativeBounds bounds{Eigen::MatrixXd(kStateDim, kArguments),
                            Eigen::MatrixXd(kStateDim, kArguments),
                            std::vector(kStateDim, Eigen::MatrixXd(kArguments, kArguments)),
                            std::vector(kStateDim, Eigen::MatrixXd(kArguments, kArguments))};
    for (int i = 0; i < kStateDim; ++i) {
      for (int a = 0; a < kArguments; ++a) {
        bounds.jacobian_lower(i, a) = next[i].gradient(a).lower();
        bounds.jacobian_upper(i, a) = next[i].gradient(a).upper();
        for (int b = 0; b < kArguments; ++b) {
          bounds.hessian_lower[i](a, b) = next[i].hessian(a, b).lower();
          bounds.hessian_upper[i](a, b) = next[i].hessian(a, b).upper();
        }
      }
    }
    return bounds;
  }

 protected:
  [[nodiscard]] const Model& model() const { return model_; }

 private:
  static constexpr int kArguments = kStateDim + kInputDim;
  using Jacobian = Eigen::Matrix<double, kStateDim, kArguments>;
  using Jet = SecondOrderJet<kArguments>;
  using Dual = Eigen::AutoDiffScalar<Eigen::Matrix<double, kArguments, 1>>;

  /// [∂f/∂x, ∂f/∂u] by forward-mode differentiation.
  [[nodiscard]] Jacobian differentiate(const Eigen::Matrix<double, kStateDim, 1>& state,
                                       const Eigen::Matrix<double, kInputDim, 1>& input) const {
    Dual x[kStateDim];
    Dual u[kInputDim];
    Dual y[kStateDim];
    for (int i = 0; i < kStateDim; ++i) x[i] = Dual(state[i], kArguments, i);
    for (int i = 0; i < kInputDim; ++i) u[i] = Dual(input[i], kArguments, kStateDim + i);
    model_.template step<Dual>(x, u, y);
    Jacobian jacobian;
    for (int i = 0; i < kStateDim; ++i) jacobian.row(i) = y[i].derivatives().transpose();
    return jacobian;
  }

  Model model_;
  SystemDescription description_;
};

}  // namespace qsmpc::models
