#include "harness/scenario/section_values.hpp"

#include <optional>

#include "harness/scenario/value_checks.hpp"

namespace qsmpc::harness {

Eigen::MatrixXd semidefinite(Section& section, const std::string& key,
                             const Eigen::MatrixXd& fallback) {
  std::optional<Eigen::MatrixXd> matrix = section.matrix(key, fallback.rows(), fallback.cols());
  if (!matrix) return fallback;
  if (const auto problem = make_semidefinite(*matrix)) {
    section.note(key, "a symmetric, positive semidefinite matrix", *problem);
    return fallback;
  }
  return *matrix;
}

NamedIntervals read_intervals(Section& section, const std::vector<models::Coordinate>& coordinates,
                              const IntervalOptions& options) {
  NamedIntervals read{.box = options.fallback};
  Eigen::Index i = 0;
  for (const models::Coordinate& coordinate : coordinates) {
    if (const auto interval = section.interval(coordinate.name, options.finite)) {
      read.box.lower[i] = interval->lower;
      read.box.upper[i] = interval->upper;
      read.any = true;
    }
    ++i;
  }
  section.refuse_unread();
  return read;
}

}  // namespace qsmpc::harness
