#include "controller/measure/compression/nearest_centre.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace qsmpc::controller {
namespace {

/// |points_i − centres_n|²; Dim is their dimension or Eigen::Dynamic.
template <int Dim>
double squared_distance(const Eigen::MatrixXd& points, Eigen::Index i,
                        const Eigen::MatrixXd& centres, Eigen::Index n) {
  using Column = Eigen::Map<const Eigen::Matrix<double, Dim, 1>>;
  const Eigen::Index dim = points.rows();
  return (Column(points.data() + i * dim, dim) - Column(centres.data() + n * dim, dim))
      .squaredNorm();
}

}  // namespace

NearestCentre::NearestCentre(const Eigen::MatrixXd& points)
    : points_(points), own_(points.cols()), others_(points.cols(), 0.0) {}

/// Lowers all bounds on the other centres by the largest distance that any centre has moved.
void NearestCentre::note_drift(const Eigen::MatrixXd& centres) {
  if (last_centres_.cols() == centres.cols()) {
    const double drift = (centres - last_centres_).colwise().norm().maxCoeff();
    for (double& other : others_) other -= drift;
  } else {
    std::fill(others_.begin(), others_.end(), 0.0);
  }
  last_centres_ = centres;
}

/// The largest distance of a centre to those of its points that may have to leave it; 0 if none.
template <int Dim>
std::vector<double> NearestCentre::measure_reaches(const Eigen::MatrixXd& centres,
                                                   const std::vector<int>& assignment) {
  std::vector<double> reaches(centres.cols(), 0.0);
  for (Eigen::Index i = 0; i < points_.cols(); ++i) {
    const int n = assignment[i];
    own_[i] = std::sqrt(squared_distance<Dim>(points_, i, centres, n));
    if (own_[i] >= others_[i]) reaches[n] = std::max(reaches[n], own_[i]);
  }
  return reaches;
}

/// A centre at least twice as far away as a point is no nearer to the point, so it is not listed.
void NearestCentre::list_neighbours(const Eigen::MatrixXd& centres,
                                    const std::vector<double>& reaches) {
  const Eigen::Index count = centres.cols();
  const Eigen::MatrixXd by_axis = centres.transpose();
  Eigen::ArrayXd squares(count);
  neighbours_.resize(count);
  for (Eigen::Index n = 0; n < count; ++n) {
    neighbours_[n].clear();
    if (reaches[n] == 0.0) continue;
    squares.setZero();
    for (Eigen::Index axis = 0; axis < centres.rows(); ++axis) {
      squares += (by_axis.col(axis).array() - centres(axis, n)).square();
    }
    const double limit = 4.0 * reaches[n] * reaches[n];
    for (Eigen::Index m = 0; m < count; ++m) {
      if (squares[m] < limit && m != n) {
        neighbours_[n].push_back(
            {.distance = std::sqrt(squares[m]), .centre = static_cast<int>(m)});
      }
    }
    std::sort(neighbours_[n].begin(), neighbours_[n].end(), [](const auto& a, const auto& b) {
      return a.distance != b.distance ? a.distance < b.distance : a.centre < b.centre;
    });
  }
}

template <int Dim>
int NearestCentre::assign_in(const Eigen::MatrixXd& centres, std::vector<int>& assignment) {
  note_drift(centres);
  list_neighbours(centres, measure_reaches<Dim>(centres, assignment));
  int moved = 0;
  for (Eigen::Index i = 0; i < points_.cols(); ++i) {
    if (own_[i] < others_[i]) continue;
    const double own = own_[i];
    double nearest = own;
    double nearest_square = own * own;
    double second_square = std::numeric_limits<double>::infinity();
    double unseen = own;  // a centre beyond the list is at least 2·own from the present one
    int best = assignment[i];
    for (const Neighbour& neighbour : neighbours_[assignment[i]]) {
      if (neighbour.distance >= own + nearest) {
        unseen = neighbour.distance - own;
        break;
      }
      const double square = squared_distance<Dim>(points_, i, centres, neighbour.centre);
      if (square < nearest_square) {
        second_square = nearest_square;
        nearest_square = square;
        nearest = std::sqrt(square);
        best = neighbour.centre;
      } else {
        second_square = std::min(second_square, square);
      }
    }
    others_[i] = std::min(std::sqrt(second_square), unseen);
    if (best != assignment[i]) ++moved;
    assignment[i] = best;
  }
  return moved;
}

int NearestCentre::assign(const Eigen::MatrixXd& centres, std::vector<int>& assignment) {
  // The dimensions common in planning problems have loops of fixed length.
  switch (centres.rows()) {
    case 1:
      return assign_in<1>(centres, assignment);
    case 2:
      return assign_in<2>(centres, assignment);
    case 3:
      return assign_in<3>(centres, assignment);
    case 4:
      return assign_in<4>(centres, assignment);
    case 5:
      return assign_in<5>(centres, assignment);
    case 6:
      return assign_in<6>(centres, assignment);
    default:
      return assign_in<Eigen::Dynamic>(centres, assignment);
  }
}

}  // namespace qsmpc::controller
