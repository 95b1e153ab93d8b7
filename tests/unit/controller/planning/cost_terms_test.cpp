// Every cost term and every stage constraint: gradients, ranges and non-finite values.
#include "controller/planning/cost/cost_terms.hpp"

#include <cmath>
#include <memory>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "controller/planning/constraints/stage_constraint.hpp"
#include "tests/unit/controller/measure/random_measures.hpp"

namespace qsmpc::controller {
namespace cost_terms_test {

using namespace testing;

constexpr Eigen::Index kHorizon = 4;
constexpr Eigen::Index kSize = 21;
constexpr double kStep = 1e-6;

/// A disc ahead of the position, and one off to a side.
Body two_discs() {
  return {.discs = {{.radius = 0.1, .offset = {0.3, 0.0}}, {.radius = 0.2, .offset = {-0.1, 0.15}}},
          .x = 0,
          .y = 1,
          .heading = 2};
}

struct Problem {
  std::unique_ptr<const models::Dynamics> dynamics = models::make_dynamics("dubins", {}, 0.1);
  SafeSet safe_set{.bounds = {.lower = Eigen::Vector3d(-1.5, -1.5, -4.0),
                              .upper = Eigen::Vector3d(1.2, 1.4, 4.0)},
                   .obstacles = {Box{.lower = Eigen::Vector3d(-0.5, -0.5, -1e300),
                                     .upper = Eigen::Vector3d(0.1, 0.4, 1e300)}}};
  QuadraticCost cost{.state = Eigen::Vector3d(3.0, 2.0, 0.5).asDiagonal(),
                     .input = Eigen::MatrixXd::Constant(1, 1, 0.7),
                     .terminal = Eigen::Vector3d(6.0, 5.0, 1.0).asDiagonal(),
                     .target = Eigen::Vector3d(1.0, 0.5, 0.2)};
  Penalty penalty;
  Eigen::MatrixXd noise = Eigen::Vector3d(0.01, 0.02, 0.005).asDiagonal();
  Eigen::MatrixXd within = Eigen::Vector3d(0.001, 0.0, 0.002).asDiagonal();

  [[nodiscard]] HorizonCostTerms terms() const {
    return {.dynamics = *dynamics,
            .safe_set = safe_set,
            .cost = cost,
            .penalty = penalty,
            .noise_covariance = noise,
            .within_covariance = within};
  }
};

/// check(entry, term, random particles of the term's dimension) for every term of either kind, for
/// a point and for a body.
template <class Check>
void for_every_term(const Check& check) {
  Generator generator(31);
  std::set<std::string> seen;
  for (const int variant : {0, 1, 2}) {
    Problem problem;
    problem.penalty.shape = variant == 2 ? PenaltyShape::kThesis : PenaltyShape::kSmooth;
    if (variant == 1) problem.safe_set.body = two_discs();
    const HorizonCostTerms terms = problem.terms();
    for (const CostTermEntry& entry : cost_terms()) {
      const std::unique_ptr<StageTerm> term = entry.make(terms);
      if (term == nullptr) continue;
      SCOPED_TRACE(entry.name);
      seen.insert(entry.name);
      const DiscreteMeasure belief = random_measure(generator, 3, 7);
      term->freeze({.belief = belief,
                    .noise_covariance = problem.noise,
                    .within_covariance = problem.within,
                    .horizon = kHorizon});
      const int dim = term->place() == TermPlace::kInputs ? 1 : 3;
      check(*term, random_measure(generator, dim, kSize));
    }
  }
  EXPECT_EQ(seen.size(), cost_terms().size()) << "a term that no problem here has";
}

double value_of(StageTerm& term, const DiscreteMeasure& particles, Points& gradient,
                ParticleRange range, bool blank) {
  const Eigen::Index stage = term.acts(kHorizon - 1, kHorizon) ? kHorizon - 1 : kHorizon;
  return term.add({.stage = stage,
                   .points = particles.locations,
                   .weights = particles.weights,
                   .range = range,
                   .gradient = gradient,
                   .blank = blank},
                  run_in_turn);
}

TEST(CostTerms, gradient_is_the_derivative_and_is_added_or_overwrites) {
  for_every_term([](StageTerm& term, const DiscreteMeasure& particles) {
    const Eigen::Index dim = particles.locations.rows();
    Points over = Points::Constant(dim, kSize, 17.0);
    Points added = Points::Constant(dim, kSize, 17.0);
    const double value = value_of(term, particles, over, {0, kSize}, /*blank=*/true);
    EXPECT_EQ(value_of(term, particles, added, {0, kSize}, /*blank=*/false), value);
    EXPECT_LT(((added.array() - 17.0).matrix() - over.matrix()).norm(), 1e-11);
    EXPECT_GT(over.norm(), 0.0);
    Points unused(dim, kSize);
    for (Eigen::Index i = 0; i < kSize; ++i) {
      for (Eigen::Index axis = 0; axis < dim; ++axis) {
        DiscreteMeasure moved = particles;
        moved.locations(axis, i) += kStep;
        const double high = value_of(term, moved, unused, {0, kSize}, true);
        moved.locations(axis, i) -= 2.0 * kStep;
        const double low = value_of(term, moved, unused, {0, kSize}, true);
        EXPECT_NEAR(over(axis, i), (high - low) / (2.0 * kStep), 1e-5 * (1.0 + over.norm()));
      }
    }
  });
}

TEST(CostTerms, ranges_add_up_and_leave_the_others_alone) {
  for_every_term([](StageTerm& term, const DiscreteMeasure& particles) {
    if (term.needs_all()) return;
    const Eigen::Index dim = particles.locations.rows();
    Points whole(dim, kSize);
    Points parts = Points::Constant(dim, kSize, 5.0);
    const double value = value_of(term, particles, whole, {0, kSize}, true);
    const double first = value_of(term, particles, parts, {0, 8}, true);
    EXPECT_TRUE((parts.rightCols(kSize - 8).array() == 5.0).all());
    const double second = value_of(term, particles, parts, {8, kSize}, true);
    EXPECT_NEAR(first + second, value, 1e-12 * (1.0 + value));
    EXPECT_LT((whole - parts).norm(), 1e-12 * (1.0 + whole.norm()));
  });
}

// Terms at the kept particles need not: the terms at the stepped ones have already shown it.
TEST(CostTerms, what_is_not_a_number_shows) {
  for_every_term([](StageTerm& term, const DiscreteMeasure& particles) {
    EXPECT_TRUE(std::isfinite(term.fixed()));
    EXPECT_GE(term.fixed(), 0.0);
    if (term.place() == TermPlace::kParticles) return;
    DiscreteMeasure broken = particles;
    broken.locations(0, 3) = std::nan("");
    Points unused(particles.locations.rows(), kSize);
    EXPECT_TRUE(std::isnan(value_of(term, broken, unused, {0, kSize}, true)));
  });
}

TEST(CostTerms, are_parts_of_the_cost_by_name) {
  for (const CostTermEntry& entry : cost_terms()) EXPECT_NO_THROW((void)cost_part(entry.part));
  EXPECT_LE(cost_parts().size(), CostParts::kMost);
  EXPECT_THROW((void)cost_part("weather"), std::invalid_argument);
  const CostParts parts{{"state", 1.0}, {"box", 8.0}};
  EXPECT_EQ(parts.total(), 9.0);
  EXPECT_EQ(parts.of("box"), 8.0);
  EXPECT_EQ(CostParts::all(2.0).total(), 2.0 * static_cast<double>(cost_parts().size()));
}

TEST(StageConstraints, slopes_are_the_derivatives_of_the_values) {
  Generator generator(32);
  Problem problem;
  for (const StageConstraintEntry& entry : stage_constraints()) {
    SCOPED_TRACE(entry.name);
    problem.safe_set.body = two_discs();
    EXPECT_FALSE(entry.summary.empty());
    EXPECT_EQ(entry.make(unbounded_safe_set(3)), nullptr);
    const auto constraint = entry.make(problem.safe_set);
    ASSERT_NE(constraint, nullptr);
    const Points points = random_measure(generator, 3, kSize).locations;
    const Eigen::Index size = constraint->group_size(kSize);
    Eigen::VectorXd values(size);
    Eigen::VectorXd high(size);
    Eigen::VectorXd low(size);
    StageSlope slope;
    for (int group = 0; group < constraint->groups(); ++group) {
      constraint->values(2, group, points, values);
      for (Eigen::Index j = 0; j < size; ++j) {
        EXPECT_EQ(constraint->value_and_slope(2, group, points, j, slope), values[j]);
        Points dense = Points::Zero(3, kSize);
        for (std::size_t i = 0; i < slope.particles.size(); ++i) {
          dense.col(slope.particles[i]) = slope.by_particle.col(static_cast<Eigen::Index>(i));
        }
        const Points direction = random_measure(generator, 3, kSize).locations;
        constraint->values(2, group, points + kStep * direction, high);
        constraint->values(2, group, points - kStep * direction, low);
        EXPECT_NEAR(dense.cwiseProduct(direction).sum(), (high[j] - low[j]) / (2.0 * kStep), 1e-7);
      }
    }
  }
}

}  // namespace cost_terms_test
}  // namespace qsmpc::controller
