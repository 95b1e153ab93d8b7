// The controller's vector loops give the same bits on every instruction set.
#include "tests/support/vector_targets.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "controller/planning/cost/stage_kernels.hpp"
#include "controller/prediction/sparse_matrix.hpp"
#include "tests/support/point_penalty.hpp"
#include "tests/unit/controller/measure/mixture_cases.hpp"
#include "tests/unit/controller/measure/reference_cases.hpp"

namespace qsmpc::controller {
namespace measure_vector_targets_test {

using namespace testing;

constexpr int kSizes[] = {1, 2, 3, 5, 7, 8, 9, 16, 17, 100, 101, 1023};

/// Compares `answer` on every target with its result on the best one.
template <class Answer>
void expect_same_on_every_target(const Answer& answer, const std::string& what) {
  const auto best = answer();
  for (const std::int64_t target : vector_targets()) {
    const OnTarget only(target);
    EXPECT_EQ(answer(), best) << what << " on " << hwy::TargetName(target);
  }
}

std::vector<double> all_of(const Points& points) {
  return {points.data(), points.data() + points.size()};
}

void append(std::vector<double>& to, const Points& points) {
  to.insert(to.end(), points.data(), points.data() + points.size());
}

TEST(VectorTargets, policies_are_equal_bit_for_bit) {
  Generator generator(901);
  for (const bool closed_loop : {false, true}) {
    for (const int size : kSizes) {
      const Eigen::Vector2d constant(0.1, -0.2);
      const Eigen::MatrixXd gain = random_matrix(generator, 2, 3);
      const Eigen::Vector2d lower(-0.6, -0.5);
      const Eigen::Vector2d upper(0.7, 0.4);
      const StagePolicy policy{.constant = constant.data(),
                               .gain = gain.data(),
                               .lower = lower.data(),
                               .upper = upper.data(),
                               .closed_loop = closed_loop};
      const Points states = random_matrix(generator, 3, size);
      const Points adjoint = random_matrix(generator, 2, size);
      // Also for a part of the particles.
      for (const Eigen::Index begin : {0, size / 3}) {
        const ParticleRange range{begin, size};
        expect_same_on_every_target(
            [&] {
              Points inputs = Points::Zero(2, size);
              apply_policy(policy, states, range, inputs);
              Points state_adjoint = states;
              Eigen::VectorXd sum = Eigen::VectorXd::Ones(2);
              Eigen::MatrixXd outer = Eigen::MatrixXd::Ones(2, 3);
              pullback_policy(policy, states, inputs, adjoint, range, state_adjoint, sum.data(),
                              outer.data());
              std::vector<double> all = all_of(inputs);
              append(all, state_adjoint);
              append(all, sum);
              append(all, outer);
              return all;
            },
            "policy of " + std::to_string(size));
      }
    }
  }
}

TEST(VectorTargets, quadratic_costs_are_equal_bit_for_bit) {
  Generator generator(902);
  for (const bool diagonal : {false, true}) {
    for (const int size : kSizes) {
      Eigen::MatrixXd matrix = random_spd(generator, 4);
      if (diagonal) matrix = Eigen::MatrixXd(matrix.diagonal().asDiagonal());
      const QuadraticForm form(matrix, random_matrix(generator, 4, 1));
      const DiscreteMeasure measure = random_measure(generator, 4, size);
      expect_same_on_every_target(
          [&] {
            Points gradient = Points::Zero(4, size);
            const double value = weighted_quadratic(form, 0.5, measure.locations, measure.weights,
                                                    {size / 3, size}, gradient);
            add_points(measure.locations, {0, size}, gradient);
            std::vector<double> all = all_of(gradient);
            all.push_back(value);
            return all;
          },
          "quadratic cost of " + std::to_string(size));
    }
  }
}

TEST(VectorTargets, penalties_are_equal_bit_for_bit) {
  Generator generator(903);
  SafeSet room = unbounded_safe_set(3);
  room.bounds.lower.head<2>().setConstant(-1.5);
  room.bounds.upper.head<2>().setConstant(1.2);
  room.obstacles = {
      Box{.lower = Eigen::Vector3d(-0.5, -0.5, -1.0), .upper = Eigen::Vector3d(0.6, 0.7, 0.9)},
      Box{.lower = Eigen::Vector3d(0.2, 0.1, -1e300), .upper = Eigen::Vector3d(0.9, 1.0, 1e300)}};
  for (const PenaltyShape shape : {PenaltyShape::kSmooth, PenaltyShape::kThesis}) {
    const Penalty penalty{.shape = shape};
    for (const int size : kSizes) {
      const DiscreteMeasure measure = random_measure(generator, 3, size);
      expect_same_on_every_target(
          [&] {
            Points adjoint = Points::Ones(3, size);
            const PenaltyValue value = add_penalty(measure.locations, measure.weights, room,
                                                   penalty, adjoint, {size / 3, size});
            std::vector<double> all = all_of(adjoint);
            all.push_back(value.box);
            all.push_back(value.obstacle);
            return all;
          },
          "penalty of " + std::to_string(size));
    }
  }
}

TEST(VectorTargets, sparse_products_are_equal_bit_for_bit) {
  Generator generator(904);
  for (int dim = 1; dim <= 9; ++dim) {
    SparseMatrix matrix{.begin = {0}, .column = {}, .value = {}, .places = {}};
    for (int row = 0; row < 30; ++row) {
      for (int k = 0; k < row % 11; ++k) {
        matrix.column.push_back((row * 7 + k * 3) % 40);
        matrix.value.push_back(uniform(generator, -1.0, 1.0));
      }
      matrix.begin.push_back(static_cast<int>(matrix.column.size()));
    }
    const Points points = random_matrix(generator, dim, 40);
    PackedPoints packed;
    resize_packed(dim, 40, packed);
    pack(points, 0, 40, packed);
    expect_same_on_every_target(
        [&] {
          Points out = Points::Ones(dim, 30);
          multiply(matrix, packed, 2, 29, out);
          return all_of(out);
        },
        "sparse product in " + std::to_string(dim) + " dimensions");
  }
}

TEST(VectorTargets, mixtures_are_equal_bit_for_bit) {
  for (const MixtureCase& mixture : random_mixtures()) {
    expect_same_on_every_target(
        [&] {
          const MixtureCells cells = split(mixture);
          std::vector<double> all(cells.begin.begin(), cells.begin.end());
          all.insert(all.end(), cells.source.begin(), cells.source.end());
          all.insert(all.end(), cells.mass.begin(), cells.mass.end());
          all.insert(all.end(), cells.weight.begin(), cells.weight.end());
          all.insert(all.end(), cells.noise_mean.begin(), cells.noise_mean.end());
          all.push_back(cells.w2);
          return all;
        },
        mixture.name);
  }
}

TEST(VectorTargets, whole_predictions_with_cost_and_gradient_are_equal_bit_for_bit) {
  for (const ReferenceCase& options : reference_cases()) {
    const ReferenceProblem problem(options);
    Eigen::VectorXd z =
        Eigen::VectorXd::Constant(problem.policy().inputs.size() +
                                      (options.closed_loop ? problem.policy().gains[0].size() : 0),
                                  0.01);
    z.head(problem.policy().inputs.size()) += problem.policy().inputs.reshaped();
    expect_same_on_every_target(
        [&] {
          const Prediction prediction = problem.predict();
          HorizonCost cost(problem.terms(), prediction, problem.policy());
          Eigen::VectorXd gradient(z.size());
          std::vector<double> all = {cost.evaluate(z, gradient)};
          append(all, gradient);
          for (const DiscreteMeasure& stage : prediction.stages) {
            append(all, stage.locations);
            append(all, stage.weights);
          }
          return all;
        },
        name_of(options));
  }
}

}  // namespace measure_vector_targets_test
}  // namespace qsmpc::controller
