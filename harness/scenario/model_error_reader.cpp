#include "harness/scenario/model_error_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "harness/errors.hpp"
#include "harness/files/text_file.hpp"
#include "harness/scenario/error_origin.hpp"
#include "harness/scenario/value_checks.hpp"
#include "harness/scenario/yaml_text.hpp"
#include "harness/scenario/yaml_tree.hpp"

namespace qsmpc::harness {
namespace {

namespace fs = std::filesystem;

constexpr const char* kErrorKey = "model_error";
constexpr std::size_t kMostPeriods = 1000;  // with their own errors
// Relative tolerance where one norm must be at least another: the error of printing ten digits.
constexpr double kErrorRounding = 1e-9;
constexpr std::array<const char*, controller::kHigherOrders.size()> kNormKeys = {"norm4", "norm8"};

/// Norms of the error's coordinates, none below `least` except by rounding; nothing, and a noted
/// problem, if they are invalid.
std::optional<Eigen::VectorXd> read_norms(Section& section, const std::string& key,
                                          const Eigen::VectorXd& least,
                                          const std::string& expected) {
  std::optional<Eigen::VectorXd> norms = section.vector(key, least.size());
  if (!norms) return std::nullopt;
  for (Eigen::Index i = 0; i < least.size(); ++i) {
    if ((*norms)[i] >= (1.0 - kErrorRounding) * least[i]) continue;
    section.note(key, expected, fmt::format("{} at position {}", (*norms)[i], i + 1));
    return std::nullopt;
  }
  return norms;
}

void read_moments(Section& section, Eigen::Index dim, controller::ModelError& error) {
  error.mean = section.vector("mean", dim).value_or(Eigen::VectorXd());
  std::optional<Eigen::MatrixXd> covariance = section.matrix("covariance", dim, dim);
  if (!covariance) return;
  if (const auto problem = make_semidefinite(*covariance)) {
    section.note("covariance", "a symmetric, positive semidefinite matrix", *problem);
    return;
  }
  if (const auto problem = tiny_variance(*covariance)) {
    section.note("covariance", expected_variances(), *problem);
    return;
  }
  error.covariance = *covariance;
}

void read_radius(Section& section, controller::ModelError& error) {
  if (!section.has("radius")) {
    (void)section.number("radius", 0.0);  // registers the key
    return;
  }
  const double least = error.radius();  // before a radius is stated
  const double radius = section.number("radius", least, kNotNegative);
  if (radius >= (1.0 - kErrorRounding) * least) {
    error.stated_radius = radius;
  } else {
    section.note("radius", fmt::format("at least {}, the norm of |offset| + rms", least));
  }
}

/// The bounds on the error of one period, or of all.
controller::ModelError read_bounds(Section& section, Eigen::Index dim) {
  section.require("rms",
                  fmt::format("{} numbers, each the root mean square of a state's error", dim));
  const auto rms = read_norms(section, "rms", Eigen::VectorXd::Zero(dim), "numbers >= 0");
  controller::ModelError error =
      controller::model_error_of_size(rms.value_or(Eigen::VectorXd::Zero(dim)));
  error.offset = section.vector("offset", dim).value_or(Eigen::VectorXd());
  Eigen::VectorXd least = error.root_mean_square;
  for (std::size_t k = 0; k < kNormKeys.size(); ++k) {
    const auto norms = read_norms(section, kNormKeys[k], least,
                                  "numbers that are at least the norms of lower order");
    if (!norms) continue;
    error.higher[k] = *norms;
    least = *norms;
  }
  read_radius(section, error);
  return error;
}

StatedModelError read_mapping(Section& section, const ModelErrorContext& context) {
  const std::string system = section.text("system", context.system, kLongestName);
  if (system != context.system) {
    section.note("system", context.system + ", the scenario's system");
  }
  controller::ModelError error = read_bounds(section, context.dim);
  read_moments(section, context.dim, error);
  const std::size_t periods = section.list_size("first");
  if (periods > kMostPeriods) {
    section.note("first", fmt::format("at most {} periods", kMostPeriods));
  }
  for (std::size_t k = 0; k < std::min(periods, kMostPeriods); ++k) {
    Section item = section.item("first", k);
    error.first.push_back(read_bounds(item, context.dim));
    item.refuse_unread();
  }
  std::optional<Scenario::ErrorOrigin> origin = read_error_origin(section, context);
  section.refuse_unread();
  return {.error = std::move(error), .origin = std::move(origin)};
}

StatedModelError blank(Eigen::Index dim) {
  return {.error = controller::model_error_of_size(Eigen::VectorXd::Zero(dim))};
}

/// `name` if it is an absolute path, otherwise relative to `folder`.
std::string path_from(const std::string& folder, const std::string& name) {
  const fs::path path(name);
  return path.is_absolute() ? name : (fs::path(folder) / path).lexically_normal().string();
}

StatedModelError read_file(const std::string& path, Problems& problems,
                           const ModelErrorContext& context) {
  try {
    const YamlNode tree = parse_yaml(read_text_file(path), path);
    Problems own(path);
    Section section(tree, own);
    StatedModelError stated =
        section.present() ? read_mapping(section, context) : blank(context.dim);
    for (InputError::Where& where : own.sorted()) problems.add(std::move(where));
    return stated;
  } catch (const InputError& error) {
    problems.add(error.where());
    return blank(context.dim);
  }
}

/// Keys and values of the bounds on the error of one period, or of all.
std::vector<std::pair<std::string, std::string>> bounds_text(const controller::ModelError& error) {
  std::vector<std::pair<std::string, std::string>> lines;
  if (error.offset.size() > 0) lines.emplace_back("offset", yaml_list(error.offset));
  lines.emplace_back("rms", yaml_list(error.root_mean_square));
  for (std::size_t k = 0; k < kNormKeys.size(); ++k) {
    if (error.higher[k].allFinite()) lines.emplace_back(kNormKeys[k], yaml_list(error.higher[k]));
  }
  if (error.stated_radius) lines.emplace_back("radius", yaml_number(*error.stated_radius));
  return lines;
}

/// The keys of the bounds of one period, or of all.
std::vector<KeyDescription> bounds_keys() {
  const VectorValue norms{.range = kNotNegative};
  return {{.name = "rms",
           .values = {norms},
           .words = "*n* numbers {range}, the root mean square of each state's error per period, "
                    "without the offset",
           .unit = "of the state",
           .required = true},
          {.name = "offset",
           .values = {VectorValue{}},
           .words = "*n* numbers *m* that the plant adds in every period on every path; the norms "
                    "are of *e* − *m*",
           .unit = "of the state",
           .fallback_words = "zero"},
          {.name = kNormKeys[0],
           .values = {norms},
           .words = "*n* norms (E\\|e − m\\|⁴)^(1/4), none less than in `rms`",
           .unit = "of the state",
           .fallback_words = "unknown"},
          {.name = kNormKeys[1],
           .values = {norms},
           .words = "*n* norms (E\\|e − m\\|⁸)^(1/8), none less than in `norm4` and `rms`",
           .unit = "of the state",
           .fallback_words = "unknown"},
          {.name = "radius",
           .values = {NumberValue{kNotNegative}},
           .words = "bound on the root mean square of the whole error, offset included; {range} "
                    "and at least the norm of \\|`offset`\\| + `rms`; C1 and C2 use it instead",
           .unit = "norm of the states",
           .fallback_words = "that norm"}};
}

}  // namespace

std::vector<KeyDescription> model_error_keys() {
  std::vector<KeyDescription> keys = bounds_keys();
  keys.push_back({.name = "first",
                  .values = {list_of_values(MappingValue{bounds_keys()}, {.most = kMostPeriods})},
                  .words = "a list of mappings with the keys above, for the first, second, … "
                           "period of a drive; the keys beside it apply to all later periods",
                  .fallback_words = "all periods are alike"});
  keys.push_back({.name = "mean",
                  .values = {VectorValue{}},
                  .words = "*n* numbers, for information",
                  .unit = "of the state",
                  .fallback_words = "unknown"});
  keys.push_back({.name = "covariance",
                  .values = {MatrixValue{}},
                  .words = "*n* × *n* covariance, for information",
                  .unit = "unit²",
                  .fallback_words = "unknown"});
  keys.push_back({.name = "system",
                  .values = {TextValue{.longest = kLongestName}},
                  .words = "a name from `qsmpc list systems`: the system that it was measured for; "
                           "another one is refused",
                  .fallback_words = "the scenario's"});
  keys.push_back(error_origin_key());
  return keys;
}

std::optional<StatedModelError> read_model_error(Section& root, Problems& problems,
                                                 const ModelErrorContext& context) {
  if (!root.holds_text(kErrorKey)) {
    Section section = root.section(kErrorKey);
    if (!section.present()) return std::nullopt;
    return read_mapping(section, context);
  }
  const std::string name = root.text(kErrorKey, "", kLongestPath);
  std::string path = path_from(context.folder, name);
  std::error_code error;
  if (root.is_override(kErrorKey) && !fs::is_regular_file(path, error)) path = path_from("", name);
  if (!name.empty() && fs::is_regular_file(path, error)) return read_file(path, problems, context);
  root.note(kErrorKey,
            "a mapping, or the path of a YAML file relative to the scenario's folder or, with "
            "--set, to the working folder",
            "no file " + name);
  return std::nullopt;
}

std::string model_error_text(const StatedModelError& stated, const std::string& indent) {
  const controller::ModelError& error = stated.error;
  std::string out;
  const auto line = [&](const std::string& key, const std::string& value) {
    out += fmt::format("{}{}: {}\n", indent, key, value);
  };
  if (error.mean.size() > 0) line("mean", yaml_list(error.mean));
  if (error.covariance.size() > 0) line("covariance", yaml_square(error.covariance));
  for (const auto& [key, value] : bounds_text(error)) line(key, value);
  if (!error.first.empty()) out += indent + "first:\n";
  for (const controller::ModelError& own : error.first) {
    std::string start = "  - ";
    for (const auto& [key, value] : bounds_text(own)) {
      out += fmt::format("{}{}{}: {}\n", indent, start, key, value);
      start = "    ";
    }
  }
  return stated.origin ? out + error_origin_text(*stated.origin, indent) : out;
}

std::string model_error_yaml(const StatedModelError& stated, const std::string& system,
                             const std::string& comment) {
  const std::string head = comment.empty() ? "" : "# " + comment + "\n";
  return head + "system: " + system + "\n" + model_error_text(stated, "");
}

}  // namespace qsmpc::harness
