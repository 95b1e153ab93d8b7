// Paths in a file of their own: the centre line of a road or track, with or without its widths.
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
  /// n x 2: x and y, or n x 4: and the widths from there to the right and to the left edge, m.
  Eigen::MatrixXd rows;
  std::vector<int> lines{};  ///< of the file, n; empty where they are not from one
};

/// Notes what is wrong with row `row`, from 0: what was found, and what was expected.
using RowNote = std::function<void(Eigen::Index row, std::string found, std::string expected)>;

/// Reads the text file `path`: a point a line, its numbers separated by commas, semicolons or
/// blanks, in metres; what follows a # is passed over, and so is a first line of names. This is the
/// format of the TUM racetrack database: x_m, y_m, w_tr_right_m, w_tr_left_m. Nothing, and a noted
/// problem with file and line, where that is something else.
[[nodiscard]] std::optional<PathRows> read_path_file(const std::string& path, Problems& problems);

/// Notes the first row that makes no path: rows of different lengths, numbers that are not finite
/// or too large, widths that are not above 0, points that repeat the one before, and too few of
/// them. Returns whether there was none.
[[nodiscard]] bool check_path_rows(const Eigen::MatrixXd& rows, bool closed, const RowNote& note);

/// Whether the path goes on from its last point to its first: where that is as near as two
/// successive points are at most, within a tenth, or the same.
[[nodiscard]] bool comes_back(const Eigen::MatrixXd& rows);

}  // namespace qsmpc::harness
