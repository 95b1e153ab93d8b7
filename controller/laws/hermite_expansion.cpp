#include "controller/laws/hermite_expansion.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "controller/laws/covariance_root.hpp"

namespace qsmpc::controller {
namespace {

/// Appends every multi-index of total degree `left` more than `index`, from position `germ` on, in
/// lexicographically descending order.
void append_degree(Eigen::Index germ, int left, Eigen::VectorXi& index,
                   std::vector<Eigen::VectorXi>& all) {
  if (germ + 1 == index.size()) {
    index[germ] = left;
    all.push_back(index);
    return;
  }
  for (int power = left; power >= 0; --power) {
    index[germ] = power;
    append_degree(germ + 1, left - power, index, all);
  }
}

/// binomial(germs + order, order), or some value above `most`.
Eigen::Index term_count(Eigen::Index germs, int order, Eigen::Index most) {
  Eigen::Index count = 1;
  for (int k = 1; k <= order && count <= most; ++k) count = count * (germs + k) / k;
  return count;
}

}  // namespace

HermiteBasis::HermiteBasis(Eigen::Index germs, int order) : order_(order) {
  if (germs < 1 || order < 1) {
    throw std::invalid_argument("Hermite basis: at least one variable and order 1 are needed");
  }
  if (term_count(germs, order, kMostTerms) > kMostTerms) {
    throw std::invalid_argument("Hermite basis: too many terms; take a lower order");
  }
  enumerate(germs);
  relate();
}

void HermiteBasis::enumerate(Eigen::Index germs) {
  std::vector<Eigen::VectorXi> all;
  Eigen::VectorXi index = Eigen::VectorXi::Zero(germs);
  for (int degree = 0; degree <= order_; ++degree) append_degree(0, degree, index, all);
  exponents_.resize(germs, static_cast<Eigen::Index>(all.size()));
  root_factorials_.resize(exponents_.cols());
  for (Eigen::Index term = 0; term < exponents_.cols(); ++term) {
    exponents_.col(term) = all[term];
    double factorials = 1.0;
    for (const int power : all[term]) factorials *= std::tgamma(power + 1.0);
    root_factorials_[term] = std::sqrt(factorials);
  }
}

void HermiteBasis::relate() {
  ancestors_.resize(terms());
  raised_ = Eigen::MatrixXi::Constant(germs(), terms(), -1);
  for (Eigen::Index term = 1; term < terms(); ++term) {
    for (Eigen::Index germ = germs() - 1; germ >= 0; --germ) {
      if (exponents_(germ, term) == 0) continue;
      Eigen::VectorXi lower = exponents_.col(term);
      --lower[germ];
      ancestors_[term] = {.germ = germ, .lower = term_of(lower)};
      raised_(germ, ancestors_[term].lower) = static_cast<int>(term);
    }
  }
}

Points HermiteBasis::values(const Points& normals) const {
  Points values = Points::Ones(terms(), normals.cols());
  Points powers(order_ + 1, normals.cols());  // h_0 … h_order of one germ
  for (Eigen::Index germ = 0; germ < germs(); ++germ) {
    powers.row(0).setOnes();
    powers.row(1) = normals.row(germ);
    for (int n = 1; n < order_; ++n) {
      powers.row(n + 1) =
          (normals.row(germ).cwiseProduct(powers.row(n)) - std::sqrt(n) * powers.row(n - 1)) /
          std::sqrt(n + 1.0);
    }
    for (Eigen::Index term = 1; term < terms(); ++term) {
      const int power = exponents_(germ, term);
      if (power > 0) values.row(term) = values.row(term).cwiseProduct(powers.row(power));
    }
  }
  return values;
}

Eigen::Index HermiteBasis::term_of(const Eigen::VectorXi& exponents) const {
  // Sorted by degree, then lexicographically descending.
  const auto before = [&](Eigen::Index term) {
    const int degree = exponents_.col(term).sum() - exponents.sum();
    if (degree != 0) return degree < 0;
    for (Eigen::Index germ = 0; germ < germs(); ++germ) {
      const int difference = exponents_(germ, term) - exponents[germ];
      if (difference != 0) return difference > 0;
    }
    return false;
  };
  Eigen::Index low = 0;
  Eigen::Index high = terms();
  while (low < high) {
    const Eigen::Index middle = (low + high) / 2;
    (before(middle) ? low : high) = before(middle) ? middle + 1 : middle;
  }
  return low;
}

// With Wick powers :ξ^α: = √(α!) h_α, E[:q(ξ): | ξ'] = :q(R ξ'): for every homogeneous polynomial
// q, R = E ξ ξ'ᵀ (Janson: "Gaussian Hilbert Spaces", 1997, theorem 3.9). So the substitution is
// computed for monomials, degree by degree: (R x)^α = (R x)_i (R x)^{α − e_i}.
Eigen::MatrixXd HermiteBasis::conditional_expectation(const Eigen::MatrixXd& correlation) const {
  Eigen::MatrixXd powers = Eigen::MatrixXd::Zero(terms(), terms());
  powers(0, 0) = 1.0;
  for (Eigen::Index term = 1; term < terms(); ++term) {
    const auto& [germ, lower] = ancestors_[term];
    for (Eigen::Index part = 0; part < terms(); ++part) {
      const double power = powers(lower, part);
      if (power == 0.0) continue;  // of another degree
      for (Eigen::Index other = 0; other < germs(); ++other) {
        powers(term, raised_(other, part)) += correlation(germ, other) * power;
      }
    }
  }
  return root_factorials_.cwiseInverse().asDiagonal() * powers * root_factorials_.asDiagonal();
}

Eigen::MatrixXd HermiteExpansion::covariance() const {
  const auto varying = coefficients.rightCols(coefficients.cols() - 1);
  return varying * varying.transpose();
}

HermiteExpansion gaussian_expansion(const Gaussian& gaussian, int order) {
  HermiteBasis basis(gaussian.mean.size(), order);
  Eigen::MatrixXd coefficients = Eigen::MatrixXd::Zero(gaussian.mean.size(), basis.terms());
  coefficients.col(0) = gaussian.mean;
  coefficients.middleCols(1, basis.germs()) = covariance_root(gaussian.covariance);
  return {.basis = std::move(basis), .coefficients = std::move(coefficients)};
}

}  // namespace qsmpc::controller
