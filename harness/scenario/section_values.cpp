#include "harness/scenario/section_values.hpp"

#include <filesystem>
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

std::optional<std::string> named_file(Section& section, const std::string& key,
                                      const std::string& folder, const std::string& expected) {
  namespace fs = std::filesystem;
  const std::string name = section.text(key, "", kLongestPath);
  if (!section.holds_text(key)) return std::nullopt;  // already noted
  std::error_code error;
  fs::path path = fs::path(folder) / name;
  if (section.is_override(key) && !fs::is_regular_file(path, error)) path = name;
  if (!name.empty() && fs::is_regular_file(path, error)) return path.lexically_normal().string();
  const bool is_folder = !name.empty() && fs::is_directory(path, error);
  section.note(key, expected, (is_folder ? "the folder " : "no file ") + name);
  return std::nullopt;
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
