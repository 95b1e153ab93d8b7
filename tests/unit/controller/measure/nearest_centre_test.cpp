#include "controller/measure/compression/nearest_centre.hpp"

#include <gtest/gtest.h>

#include "tests/unit/controller/measure/random_measures.hpp"

namespace qsmpc::controller {
namespace nearest_centre_test {

using namespace testing;

TEST(NearestCentre, finds_what_comparing_all_centres_finds_while_they_move) {
  Generator generator(71);
  for (Eigen::Index dim = 1; dim <= 8; ++dim) {
    const Eigen::MatrixXd points = random_matrix(generator, dim, 300);
    Eigen::MatrixXd centres = random_matrix(generator, dim, 25);
    std::vector<int> assignment(300, 0);
    NearestCentre nearest(points);
    for (const double step : {0.0, 0.1, 0.01, 0.001, 0.5, 0.0, 0.0001}) {
      centres += random_matrix(generator, dim, 25, step);
      const std::vector<int> before = assignment;
      const int moved = nearest.assign(centres, assignment);
      int different = 0;
      for (Eigen::Index i = 0; i < points.cols(); ++i) {
        int expected = 0;
        (centres.colwise() - points.col(i)).colwise().squaredNorm().minCoeff(&expected);
        EXPECT_EQ(assignment[i], expected);
        different += assignment[i] != before[i] ? 1 : 0;
      }
      EXPECT_EQ(moved, different);
    }
  }
}

TEST(NearestCentre, another_number_of_centres_is_another_problem) {
  Generator generator(72);
  const Eigen::MatrixXd points = random_matrix(generator, 2, 200);
  NearestCentre nearest(points);
  std::vector<int> assignment(200, 0);
  for (const Eigen::Index count : {10, 7, 12}) {
    const Eigen::MatrixXd centres = random_matrix(generator, 2, count);
    std::fill(assignment.begin(), assignment.end(), 0);
    nearest.assign(centres, assignment);
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      int expected = 0;
      (centres.colwise() - points.col(i)).colwise().squaredNorm().minCoeff(&expected);
      EXPECT_EQ(assignment[i], expected);
    }
  }
}

TEST(NearestCentre, a_point_stays_where_no_centre_is_strictly_nearer) {
  const Eigen::MatrixXd points = Eigen::MatrixXd::Zero(1, 2);
  const Eigen::RowVector2d centres(-1.0, 1.0);
  std::vector<int> assignment{0, 1};
  NearestCentre nearest(points);
  EXPECT_EQ(nearest.assign(centres, assignment), 0);
  EXPECT_EQ(assignment, (std::vector<int>{0, 1}));
}

}  // namespace nearest_centre_test
}  // namespace qsmpc::controller
