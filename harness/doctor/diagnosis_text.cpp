#include "harness/doctor/diagnosis_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/assembly/assembly.hpp"
#include "harness/doctor/diagnosis.hpp"
#include "harness/scenario/plant_mapping_reader.hpp"
#include "harness/scenario/yaml_text.hpp"
#include "harness/text/json_text.hpp"
#include "harness/text/number_format.hpp"
#include "harness/text/printable.hpp"
#include "harness/text/text_width.hpp"
#include "harness/text/utf8.hpp"

namespace qsmpc::harness {
namespace {

constexpr double kRounding = 1e-6;  // of a state's largest change

std::string with_unit(double value, const models::Coordinate& coordinate) {
  return format_short(value) + (coordinate.unit.empty() ? "" : " " + coordinate.unit);
}

/// Rows of cells, each column as wide as its widest cell.
std::string aligned(const std::vector<std::vector<std::string>>& rows) {
  constexpr std::size_t kGap = 2;
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], utf8_characters(row[i]));
    }
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += std::string(kGap, ' ') + padded(row[i], widths[i]);
    }
    while (line.ends_with(' ')) line.pop_back();
    text += line + "\n";
  }
  return text;
}

/// A change of a state; 0 where it is only rounding relative to `scale`.
std::string change(double value, double scale, const models::Coordinate& coordinate) {
  return with_unit(std::abs(value) < kRounding * scale ? 0.0 : value, coordinate);
}

std::string held(const InputAnswer& answer, const models::SystemDescription& system) {
  if (answer.input < 0) return "nothing";
  const models::Coordinate& input = system.inputs[static_cast<std::size_t>(answer.input)];
  return fmt::format("{} ±{}", input.name, with_unit(answer.amplitude, input));
}

/// A number with four significant digits, in its usual notation.
std::string four_digits(double value) {
  return yaml_number(std::stod(fmt::format("{:.4g}", value)));
}

std::string term_text(const std::string& actuator, const std::string& more, double gain) {
  return fmt::format("{{actuator: {}, {}gain: {}}}", quoted_yaml(actuator), more,
                     four_digits(gain));
}

/// The keys with the gains that were found, to be pasted under `plant`.
std::string mapping_lines(const PlantMapping& mapping) {
  std::string text;
  for (const auto& [name, terms] : mapping.inputs) {
    if (text.empty()) text += "  input:\n";
    text += fmt::format("    {}:\n", name);
    for (const ControlTerm& term : terms) {
      const std::string offset =
          term.offset == 0.0 ? "" : fmt::format("offset: {}, ", yaml_number(term.offset));
      text += "      - " + term_text(term.actuator, offset, term.gain) + "\n";
    }
  }
  if (!mapping.holds.empty()) text += "  hold:\n";
  for (const HoldTerm& hold : mapping.holds) {
    const std::string parameter = hold.constant.parameter.empty()
                                      ? ""
                                      : fmt::format("parameter: {}, ", hold.constant.parameter);
    text += "    - " + term_text(hold.actuator, parameter, hold.constant.gain) + "\n";
  }
  const bool has_feedback = std::ranges::any_of(mapping.loops, [](const PlantLoop& loop) {
    return std::holds_alternative<FeedbackLoop>(loop);
  });
  if (has_feedback) {
    text += "  loops:\n";
    for (const PlantLoop& loop : mapping.loops) text += "    - " + plant_loop_text(loop) + "\n";
  }
  return text;
}

std::string suggestion(const Diagnosis& diagnosis) {
  if (!diagnosis.search || !diagnosis.search->changed) return "";
  const std::vector<std::string> left =
      answer_warnings(diagnosis.scenario, diagnosis.search->answers);
  std::string text = left.empty()
                         ? "With these gains under plant, each state responds as in the model:\n"
                         : "With these gains under plant, these warnings remain:\n";
  for (const std::string& warning : left) text += "  - " + warning + "\n";
  return text + mapping_lines(diagnosis.search->mapping);
}

nlohmann::ordered_json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json answers_json(const Scenario& scenario, const PlantAnswers& answers) {
  const models::SystemDescription system = model_of(scenario)->description();
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const InputAnswer& answer : answers.inputs) {
    for (std::size_t i = 0; i < answer.states.size(); ++i) {
      const StateAnswer& state = answer.states[i];
      nlohmann::ordered_json json;
      json["input"] =
          answer.input < 0
              ? nlohmann::ordered_json(nullptr)
              : nlohmann::ordered_json(system.inputs[static_cast<std::size_t>(answer.input)].name);
      json["amplitude"] = answer.amplitude;
      json["state"] = system.states[i].name;
      json["unit"] = system.states[i].unit;
      json["model"] = number_or_null(state.model[state.model.size() - 1]);
      json["plant"] = number_or_null(state.plant[state.plant.size() - 1]);
      json["ratio"] = number_or_null(state.ratio);
      json["delay"] = state.delay;
      json["discrepancy"] = number_or_null(state.discrepancy);
      json["verdict"] = verdict_name(verdict_of(scenario, answers, answer, i));
      rows.push_back(json);
    }
  }
  return rows;
}

}  // namespace

std::string diagnosis_table(const Diagnosis& diagnosis) {
  const Scenario& scenario = diagnosis.scenario;
  const PlantAnswers& answers = diagnosis.answers;
  const models::SystemDescription system = model_of(scenario)->description();
  std::string text =
      fmt::format("{}: {} as {}, driven for {} periods of {} s from the mean initial state\n",
                  printable(scenario.name),
                  printable(std::filesystem::path(scenario.plant.mjcf).filename().string()),
                  system.name, answers.periods, format_short(answers.period));
  std::vector<std::vector<std::string>> rows{
      {"held", "state", "model", "plant", "ratio", "delay", "verdict"}};
  for (const InputAnswer& answer : answers.inputs) {
    std::string what = held(answer, system);
    for (std::size_t i = 0; i < answer.states.size(); ++i) {
      const StateAnswer& state = answer.states[i];
      const models::Coordinate& coordinate = system.states[i];
      const double scale = answers.scale[static_cast<Eigen::Index>(i)];
      const Eigen::Index last = state.model.size() - 1;
      const bool answered = !std::isnan(state.ratio);
      rows.push_back(
          {std::exchange(what, ""), coordinate.name, change(state.model[last], scale, coordinate),
           change(state.plant[last], scale, coordinate), answered ? format_short(state.ratio) : "",
           answered ? format_short(state.delay) + " s" : "",
           verdict_name(verdict_of(scenario, answers, answer, i))});
    }
  }
  text += aligned(rows);
  const std::vector<std::string> warnings = answer_warnings(scenario, answers);
  for (const std::string& warning : warnings) text += "warning: " + warning + "\n";
  if (warnings.empty()) text += "ok: sign, size and delay match the model\n";
  return text + suggestion(diagnosis);
}

std::string diagnosis_json(const Diagnosis& diagnosis) {
  const PlantAnswers& answers = diagnosis.answers;
  nlohmann::ordered_json json;
  json["scenario"] = diagnosis.scenario.name;
  json["mjcf"] = diagnosis.scenario.plant.mjcf;
  json["periods"] = answers.periods;
  json["period"] = answers.period;
  json["fault"] =
      answers.fault ? nlohmann::ordered_json(*answers.fault) : nlohmann::ordered_json(nullptr);
  json["tilt"] = {{"start", answers.tilt_at_start}, {"end", answers.tilt}};
  json["answers"] = answers_json(diagnosis.scenario, answers);
  json["warnings"] = answer_warnings(diagnosis.scenario, answers);
  json["suggestion"] = nullptr;
  if (diagnosis.search && diagnosis.search->changed) {
    json["suggestion"] = {
        {"plant", mapping_lines(diagnosis.search->mapping)},
        {"answers", answers_json(diagnosis.scenario, diagnosis.search->answers)},
        {"warnings", answer_warnings(diagnosis.scenario, diagnosis.search->answers)}};
  }
  return json_text(json);
}

}  // namespace qsmpc::harness
