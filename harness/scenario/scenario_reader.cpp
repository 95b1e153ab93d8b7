// read_scenario: reads the keys of a scenario according to their descriptions.
#include "harness/scenario/scenario_reader.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/scenario/keys/scenario_key.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/scenario/section_values.hpp"

namespace qsmpc::harness {
namespace {

Eigen::Index size_of(Dimension dimension, const models::SystemDescription& system) {
  return std::ssize(dimension == Dimension::kInputs ? system.inputs : system.states);
}

/// The expected value of a required key, for errors.
struct ExpectedValue {
  const ScenarioReading& reading;

  std::string operator()(const TextValue& text) const { return text.what; }
  std::string operator()(const NameValue& name) const { return expected_names("", name.known); }
  std::string operator()(const VectorValue& /*vector*/) const {
    const std::vector<models::Coordinate>& states = reading.system().states;
    return fmt::format("{} numbers, [{}]", states.size(),
                       fmt::join(coordinate_names(states), ", "));
  }
  template <class Value>
  std::string operator()(const Value& /*value*/) const {
    return "a value";
  }
};

/// Reads a value into its member.
struct MemberReading {
  ScenarioReading& reading;
  Section& section;
  const KeyDescription& about;

  void operator()(std::monostate /*none*/) const {}
  void operator()(bool& (*member)(Scenario&)) const {
    bool& value = member(reading.scenario);
    value = section.flag(about.name, value);
  }
  void operator()(int& (*member)(Scenario&)) const {
    int& value = member(reading.scenario);
    const auto& [least, most] = value_of<WholeValue>(about);
    value = section.whole(about.name, value, {static_cast<int>(least), static_cast<int>(most)});
  }
  void operator()(std::uint64_t& (*member)(Scenario&)) const {
    std::uint64_t& value = member(reading.scenario);
    value = section.seed(about.name, value);
  }
  void operator()(double& (*member)(Scenario&)) const {
    double& value = member(reading.scenario);
    value = section.number(about.name, value, value_of<NumberValue>(about).range);
  }
  void operator()(std::string& (*member)(Scenario&)) const {
    std::string& value = member(reading.scenario);
    if (const auto* name = std::get_if<NameValue>(&about.values.front())) {
      value = section.name(about.name, value, name->known);
      return;
    }
    const auto& text = value_of<TextValue>(about);
    const std::size_t before = reading.problems.size();
    value = section.text(about.name, value, text.longest);
    const bool is_empty = value.empty() && reading.problems.size() == before;
    if (is_empty && section.has(about.name) && !text.what.empty()) {
      section.note(about.name, text.what + ", not empty");
    }
  }
  void operator()(Eigen::VectorXd& (*member)(Scenario&)) const {
    const Eigen::Index size = size_of(value_of<VectorValue>(about).size, reading.system());
    member(reading.scenario) =
        section.vector(about.name, size).value_or(Eigen::VectorXd::Zero(size));
  }
  void operator()(Eigen::MatrixXd& (*member)(Scenario&)) const {
    const auto& matrix = value_of<MatrixValue>(about);
    const Eigen::Index size = size_of(matrix.rows, reading.system());
    Eigen::MatrixXd fallback = Eigen::MatrixXd::Zero(size, size);
    if (matrix.is_identity_by_default) fallback.setIdentity();
    member(reading.scenario) = semidefinite(section, about.name, fallback);
  }
};

class ScenarioReader {
 public:
  ScenarioReader(const YamlNode& tree, const FileLookup& lookup, Problems& problems)
      : root_(tree, problems), reading_{.lookup = lookup, .problems = problems} {}

  Scenario read() {
    if (!root_.present()) return {};
    read_those(ReadAfter::kNothing);
    read_those(ReadAfter::kTimeStep);
    if (reading_.dynamics != nullptr) {
      read_those(ReadAfter::kSystem);
    } else {
      // Sizes depend on the system; problems here are reported once there is one.
      for (const ScenarioKey& key : scenario_keys()) {
        if (key.after == ReadAfter::kSystem) expect_section(key);
      }
    }
    root_.refuse_unread();
    for (auto& [section, check] : checks_) check(reading_, section);
    return std::move(reading_.scenario);
  }

 private:
  void read_those(ReadAfter after) {
    for (const ScenarioKey& key : scenario_keys()) {
      if (key.after == after) read_key(root_, key);
    }
  }

  void read_key(Section& section, const ScenarioKey& key) {
    const KeyDescription& about = key.about;
    const std::size_t before = reading_.problems.size();
    if (about.required && !about.values.empty()) {
      section.require(about.name, std::visit(ExpectedValue{reading_}, about.values.front()));
    }
    if (key.read != nullptr) {
      key.read(reading_, section, about);
    } else if (const YamlNode* node = key.word.empty() ? nullptr : section.tree(about.name);
               node != nullptr && node->kind != YamlNode::Kind::kMap) {
      if (node->kind == YamlNode::Kind::kText && node->text == key.word) {
        key.say(reading_.scenario);
      } else {
        section.note(about.name, key.word + ", or a mapping of keys to values");
      }
    } else if (!key.keys.empty()) {
      Section inner = section.section(about.name);
      for (const ScenarioKey& inner_key : key.keys) read_key(inner, inner_key);
      inner.refuse_unread();
    } else {
      std::visit(MemberReading{reading_, section, about}, key.member);
    }
    if (key.check != nullptr && reading_.problems.size() == before) {
      checks_.emplace_back(section, key.check);
    }
  }

  void expect_section(const ScenarioKey& key) {
    if (key.keys.empty()) {
      (void)root_.holds_text(key.about.name);
    } else {
      (void)root_.section(key.about.name);
    }
  }

  using Check = void (*)(const ScenarioReading&, Section&);

  Section root_;
  ScenarioReading reading_;
  std::vector<std::pair<Section, Check>> checks_;
};

}  // namespace

Scenario read_scenario(const YamlNode& tree, const FileLookup& lookup, Problems& problems) {
  return ScenarioReader(tree, lookup, problems).read();
}

}  // namespace qsmpc::harness
