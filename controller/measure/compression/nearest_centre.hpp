// Repeated assignment of many points to the nearest of a set of centres that move slightly each
// time: the inner step of Lloyd's method.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace qsmpc::controller {

/// Keeps, from one assignment to the next, a lower bound on the distance of every point to its
/// second-nearest centre, so that most points need not be examined again (Hamerly's bounds). The
/// centres to examine come from a list sorted by their distance to the point's current one, up to
/// where the triangle inequality excludes the rest. The result is the same as if all were compared.
class NearestCentre {
 public:
  /// `points`: d x n, held by reference; must stay alive and unchanged.
  explicit NearestCentre(const Eigen::MatrixXd& points);

  /// Moves every point in `assignment` (n, entries in 0 … N − 1) to the nearest of `centres`
  /// (d x N); a point stays where none is strictly nearer. Returns how many points moved.
  int assign(const Eigen::MatrixXd& centres, std::vector<int>& assignment);

 private:
  struct Neighbour {
    double distance;
    int centre;
  };

  template <int Dim>
  int assign_in(const Eigen::MatrixXd& centres, std::vector<int>& assignment);
  void note_drift(const Eigen::MatrixXd& centres);
  template <int Dim>
  std::vector<double> measure_reaches(const Eigen::MatrixXd& centres,
                                      const std::vector<int>& assignment);
  void list_neighbours(const Eigen::MatrixXd& centres, const std::vector<double>& reaches);

  const Eigen::MatrixXd& points_;
  std::vector<double> own_;     // n, distance to the centre that the point is assigned to
  std::vector<double> others_;  // n, lower bound on the distance to any other centre
  Eigen::MatrixXd last_centres_;
  std::vector<std::vector<Neighbour>> neighbours_;  // of every centre, nearest first
};

}  // namespace qsmpc::controller
