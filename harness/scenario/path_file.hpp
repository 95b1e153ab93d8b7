// Paths in a separate file: the centre line of a road or track, with or without widths.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "harness/scenario/yaml_section.hpp"

namespace qsmpc::harness {

inline constexpr std::size_t kMostPathRows = 5000;

/// The points of a path.
struct PathRows {
  /// n x 2: x and y; or n x 4: x, y and the widths to the right and to the left edge, m.
  Eigen::MatrixXd rows;
  std::vector<int> lines{};  ///< in the file, n; empty for rows that are not from a file
};

/// Notes a problem with row `row` (from 0): what was found, and what was expected.
using RowNote = std::function<void(Eigen::Index row, std::string found, std::string expected)>;

/// Reads the text file `path`: one point per line, its numbers separated by commas, semicolons or
/// blanks, in metres; text after a # and a first line of names are skipped. This is the format of
/// the TUM racetrack database: x_m, y_m, w_tr_right_m, w_tr_left_m. Nothing, and a noted problem
/// with file and line, on any other content.
[[nodiscard]] std::optional<PathRows> read_path_file(const std::string& path, Problems& problems);

/// Notes the first invalid row: rows of different lengths, numbers that are not finite or too
/// large, widths that are not above 0, points that repeat the one before, and too few points.
/// Returns whether all rows are valid.
[[nodiscard]] bool check_path_rows(const Eigen::MatrixXd& rows, bool closed, const RowNote& note);

/// Whether the path is closed: it has at least four points, and the distance from its last point to
/// its first is at most 1.1 times the largest distance of successive points.
[[nodiscard]] bool comes_back(const Eigen::MatrixXd& rows);

}  // namespace qsmpc::harness
