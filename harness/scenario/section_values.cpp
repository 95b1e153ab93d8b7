#include "harness/scenario/section_values.hpp"

#include <optional>

#include <fmt/format.h>

#include "harness/scenario/value_checks.hpp"
#include "harness/scenario/yaml_text.hpp"

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

std::string intervals_text(const controller::Box& box,
                           const std::vector<models::Coordinate>& coordinates) {
  std::string out = "{";
  for (Eigen::Index i = 0; i < box.lower.size(); ++i) {
    out += fmt::format("{}{}: [{}, {}]", i == 0 ? "" : ", ",
                       coordinates[static_cast<std::size_t>(i)].name, yaml_number(box.lower[i]),
                       yaml_number(box.upper[i]));
  }
  return out + "}";
}

}  // namespace qsmpc::harness
