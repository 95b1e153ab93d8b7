// A random vector as a polynomial of independent standard normals, in orthonormal Hermite
// polynomials:
//
//   x = Σ_α c_α h_α(ξ),  h_α(ξ) = Π_i He_{α_i}(ξ_i)/√(α_i!),  |α| ≤ order,  ξ ~ N(0, I).
//
// Since E h_α h_β is 1 where α = β and 0 elsewhere, moments are sums over the coefficients.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "controller/measure/measures.hpp"

#pragma GCC visibility push(default)

namespace qsmpc::controller {

/// All multi-indices of a total degree of at most `order`, in ascending degree: the constant is
/// term 0, and the polynomial ξ_i is term 1 + i.
class HermiteBasis {
 public:
  /// Throws std::invalid_argument unless germs ≥ 1, order ≥ 1, and there are at most kMostTerms
  /// terms.
  HermiteBasis(Eigen::Index germs, int order);

  static constexpr Eigen::Index kMostTerms = 20'000;

  [[nodiscard]] Eigen::Index germs() const { return exponents_.rows(); }
  [[nodiscard]] Eigen::Index terms() const { return exponents_.cols(); }
  [[nodiscard]] int order() const { return order_; }
  /// α of every term, germs x terms.
  [[nodiscard]] const Eigen::MatrixXi& exponents() const { return exponents_; }

  /// h_α at the columns of `normals` (germs x n): terms x n.
  [[nodiscard]] Points values(const Points& normals) const;

  /// The matrix T (terms x terms) with E[Σ c_α h_α(ξ) | ξ'] = Σ (c T)_β h_β(ξ'), where ξ and ξ' are
  /// standard normals, jointly Gaussian with E ξ ξ'ᵀ = `correlation` (germs x germs). It mixes
  /// terms of the same degree only.
  [[nodiscard]] Eigen::MatrixXd conditional_expectation(const Eigen::MatrixXd& correlation) const;

 private:
  /// α of a term is that of `lower` with one more at `germ`, its first germ that is not 0.
  struct Ancestor {
    Eigen::Index germ = 0;
    Eigen::Index lower = 0;
  };

  void enumerate(Eigen::Index germs);
  void relate();
  [[nodiscard]] Eigen::Index term_of(const Eigen::VectorXi& exponents) const;

  int order_;
  Eigen::MatrixXi exponents_;
  Eigen::VectorXd root_factorials_;  ///< √(α!) of every term
  std::vector<Ancestor> ancestors_;  ///< of every term but the constant, whose entry is unused
  Eigen::MatrixXi raised_;           ///< germs x terms: the term α + e_i; −1 above the order
};

struct HermiteExpansion {
  HermiteBasis basis;
  Eigen::MatrixXd coefficients;  ///< dim x terms

  [[nodiscard]] Eigen::VectorXd mean() const { return coefficients.col(0); }
  /// Σ_{α ≠ 0} c_α c_αᵀ.
  [[nodiscard]] Eigen::MatrixXd covariance() const;
};

/// N(mean, covariance), whose dimension is the number of germs.
[[nodiscard]] HermiteExpansion gaussian_expansion(const Gaussian& gaussian, int order);

}  // namespace qsmpc::controller

#pragma GCC visibility pop
