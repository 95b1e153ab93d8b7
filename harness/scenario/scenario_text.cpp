// to_yaml: writes what scenario_file.hpp loads; and the text of defaults.
#include "harness/scenario/scenario_text.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "harness/scenario/model_dynamics.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/scenario/yaml_text.hpp"

namespace qsmpc::harness {
namespace {

/// The value of a member as YAML.
struct MemberText {
  const KeyDescription& about;

  std::string operator()(bool value) const { return value ? "true" : "false"; }
  std::string operator()(int value) const { return fmt::format("{}", value); }
  std::string operator()(std::uint64_t value) const { return fmt::format("{}", value); }
  std::string operator()(double value) const { return yaml_number(value); }
  std::string operator()(const Eigen::VectorXd& value) const { return yaml_list(value); }
  std::string operator()(const Eigen::MatrixXd& value) const { return yaml_square(value); }
  std::string operator()(const std::string& value) const {
    return std::holds_alternative<NameValue>(about.values.front()) ? value : quoted_yaml(value);
  }
};

std::string member_text(const ScenarioKey& key, Scenario& scenario) {
  return std::visit(
      [&](auto member) -> std::string {
        if constexpr (std::is_same_v<decltype(member), std::monostate>) {
          return "";
        } else {
          return MemberText{key.about}(member(scenario));
        }
      },
      key.member);
}

class ScenarioWriter {
 public:
  explicit ScenarioWriter(const Scenario& scenario)
      : scenario_(scenario), system_(system_of(scenario)) {}

  /// One line per key after `indent`, more where the value spans several.
  std::string lines(const std::vector<ScenarioKey>& keys, const std::string& indent) {
    std::string out;
    for (const ScenarioKey& key : keys) {
      const std::optional<std::string> text = value(key, indent + "  ");
      if (!text) continue;
      const char* space = text->starts_with('\n') ? "" : " ";
      out += fmt::format("{}{}:{}{}\n", indent, key.about.name, space, *text);
    }
    return out;
  }

 private:
  std::optional<std::string> value(const ScenarioKey& key, const std::string& indent) {
    if (key.is_written != nullptr && !key.is_written(scenario_)) return std::nullopt;
    if (key.write != nullptr) return key.write(scenario_, system_);
    if (key.keys.empty()) return member_text(key, scenario_);
    if (key.layout == SectionLayout::kFlow) return braces(key.keys);
    std::string block = "\n" + lines(key.keys, indent);
    block.pop_back();
    return block;
  }

  std::string braces(const std::vector<ScenarioKey>& keys) {
    std::string out;
    for (const ScenarioKey& key : keys) {
      const std::optional<std::string> text = value(key, "");
      if (!text) continue;
      const KeyDescription& about = key.about;
      const bool is_one = !about.name.empty() && about.family == NameFamily::kNone;
      out += (out.empty() ? "" : ", ") + (is_one ? about.name + ": " : "") + *text;
    }
    return "{" + out + "}";
  }

  Scenario scenario_;  // a copy, since members are accessed through mutable references
  models::SystemDescription system_;
};

}  // namespace

std::string default_text(const ScenarioKey& key) {
  Scenario scenario;
  const bool is_matrix = std::holds_alternative<Eigen::MatrixXd& (*)(Scenario&)>(key.member);
  std::string text = is_matrix ? "" : member_text(key, scenario);
  return text == quoted_yaml("") || text == ".inf" ? "" : text;
}

std::string to_yaml(const Scenario& scenario) {
  return ScenarioWriter(scenario).lines(scenario_keys(), "");
}

}  // namespace qsmpc::harness
