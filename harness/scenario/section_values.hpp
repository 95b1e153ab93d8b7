// Values that several sections of a scenario share, read and checked.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "controller/regions/safe_set.hpp"
#include "harness/scenario/yaml_section.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// The symmetric, positive semidefinite matrix under `key`, of the size of `fallback`; `fallback`
/// where there is none, or where it is invalid, which is noted.
[[nodiscard]] Eigen::MatrixXd semidefinite(Section& section, const std::string& key,
                                           const Eigen::MatrixXd& fallback);

/// The path of the file that `key`, which must be present, names: absolute, or relative to
/// `folder`, or for a value from --set otherwise to the working folder. Nothing, and a noted
/// problem with `expected`, where there is no such file.
[[nodiscard]] std::optional<std::string> named_file(Section& section, const std::string& key,
                                                    const std::string& folder,
                                                    const std::string& expected);

struct IntervalOptions {
  controller::Box fallback;  ///< for coordinates that are not named
  bool finite = false;       ///< whether infinite ends are refused
};

/// Intervals of coordinates, as a box.
struct NamedIntervals {
  controller::Box box;
  bool any = false;  ///< whether a coordinate is named
};

/// The intervals in `section` for the names of `coordinates`. Any other key is noted.
[[nodiscard]] NamedIntervals read_intervals(Section& section,
                                            const std::vector<models::Coordinate>& coordinates,
                                            const IntervalOptions& options);

/// `box` as a mapping on one line that `read_intervals` takes: {x: [0, 1], y: [-.inf, .inf]}.
[[nodiscard]] std::string intervals_text(const controller::Box& box,
                                         const std::vector<models::Coordinate>& coordinates);

}  // namespace qsmpc::harness
