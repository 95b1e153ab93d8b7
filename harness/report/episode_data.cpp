#include "harness/report/episode_data.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>

#include <nlohmann/json.hpp>

#include "controller/certification/certificate.hpp"
#include "harness/assembly/assembly.hpp"
#include "harness/figures/ground_map.hpp"
#include "harness/report/chart_data.hpp"
#include "harness/report/episode_charts.hpp"
#include "harness/report/moving_data.hpp"
#include "harness/report/packed_numbers.hpp"
#include "harness/report/script_json.hpp"
#include "harness/text/unit_text.hpp"
#include "models/constants.hpp"

namespace qsmpc::harness {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostParticles = 400'000;  // per page: about 3 MB as text
constexpr std::uint16_t kNowhere = 65'535;       // outside the map, or not finite
constexpr double kLastPlace = 65'534.0;

double entry(const Eigen::VectorXd& values, Eigen::Index index) {
  return index >= 0 && index < values.size() ? values[index] : kNotANumber;
}

class EpisodeData {
 public:
  explicit EpisodeData(const EpisodeView& view)
      : view_(view),
        trace_(view.trace()),
        system_(view.system()),
        axes_(map_axes(view.system()).value_or(MapAxes{.x = -1, .y = -1})),
        parts_(view.parts()),
        horizon_(certified_stages(parts_)) {}

  /// The data that exist for any system.
  [[nodiscard]] Json periods() const {
    Json json = {{"period", trace_.scenario.time_step},
                 {"steps", trace_.steps.size()},
                 {"horizon", horizon_},
                 {"planned", parts_.stages > 0},
                 {"solved", parts_.status},
                 {"times", of_steps([](const StepRecord& step) { return step.time; })},
                 {"clearance", clearances()},
                 {"clearanceUnit", view_.clearance_unit()},
                 {"holds", view_.summary().no_bound.empty()},
                 {"solve", of_steps([](const StepRecord& step) { return step.timing.total; })},
                 {"cost", cost_parts()},
                 {"inputs", inputs()},
                 {"certificates", certificates()},
                 {"budgets", budgets()},
                 {"budgetScale", scale_name(budget_scale(trace_))},
                 {"leastBudget", kLeastBudget},
                 {"status", Json::array()},
                 {"fallback", Json::array()}};
    for (const StepRecord& step : trace_.steps) {
      json["status"].push_back(step.solver_status);
      json["fallback"].push_back(step.fallback ? 1 : 0);
    }
    return json;
  }

  /// The data in the plane of `map`.
  [[nodiscard]] Json plane(const PlaneMap& map) const {
    const MapView view = map_view(map);
    Json json = {{"xLeft", view.x_left}, {"yTop", view.y_top},         {"scale", view.scale},
                 {"poses", poses()},     {"predicted", predicted()},   {"plans", plans()},
                 {"moments", moments()}, {"particles", particles(map)}};
    const DrivenObstacles others(trace_);
    if (!others.empty()) json["others"] = moving_data(view_, others);
    return json;
  }

 private:
  template <class Value>
  [[nodiscard]] std::string of_steps(const Value& value) const {
    std::vector<double> values;
    values.reserve(trace_.steps.size());
    for (const StepRecord& step : trace_.steps) values.push_back(value(step));
    return packed_floats(values);
  }

  [[nodiscard]] std::size_t stages() const { return static_cast<std::size_t>(horizon_) + 1; }

  /// Clearances of the states at the control instants, and of the final state.
  [[nodiscard]] std::string clearances() const {
    std::vector<double> values(view_.clearances().begin(), view_.clearances().end());
    values.resize(trace_.steps.size() + 1, kNotANumber);
    return packed_floats(values);
  }

  [[nodiscard]] Json cost_parts() const {
    if (!parts_.cost) return Json::object();
    Json json = Json::object();
    const std::vector<controller::CostPartEntry>& parts = controller::cost_parts();
    for (std::size_t part = 0; part < parts.size(); ++part) {
      json[parts[part].words] =
          of_steps([part](const StepRecord& step) { return step.cost[part]; });
    }
    return json;
  }

  [[nodiscard]] Json inputs() const {
    Json json = Json::array();
    for (std::size_t i = 0; i < system_.inputs.size(); ++i) {
      const auto index = static_cast<Eigen::Index>(i);
      json.push_back({{"name", system_.inputs[i].name},
                      {"unit", printed_unit(system_.inputs[i].unit)},
                      {"values", of_steps([index](const StepRecord& step) {
                         return entry(step.input, index);
                       })}});
    }
    return json;
  }

  template <class Figure>
  [[nodiscard]] std::string of_stages(const Figure& figure) const {
    std::vector<double> values;
    for (const StepRecord& step : trace_.steps) {
      for (std::size_t stage = 0; stage + 1 < stages(); ++stage) {
        const bool known = stage < step.certificates.size();
        values.push_back(known ? figure(step.certificates[stage]) : kNotANumber);
      }
    }
    return packed_floats(values);
  }

  [[nodiscard]] Json certificates() const {
    return {
        {"value", of_stages([](const controller::StageCertificate& stage) { return stage.value; })},
        {"thesis",
         of_stages([](const controller::StageCertificate& stage) { return stage.of("thesis"); })},
        {"plan", of_steps([](const StepRecord& step) {
           return step.certificates.empty() ? kNotANumber
                                            : controller::horizon_bound(step.certificates);
         })}};
  }

  [[nodiscard]] std::string of_budgets(double controller::StageBudget::*member) const {
    std::vector<double> values;
    for (const StepRecord& step : trace_.steps) {
      for (std::size_t stage = 0; stage < stages(); ++stage) {
        values.push_back(stage < step.budgets.size() ? step.budgets[stage].*member : kNotANumber);
      }
    }
    return packed_floats(values);
  }

  [[nodiscard]] Json budgets() const {
    return {{"total", of_budgets(&controller::StageBudget::total)},
            {"belief", of_budgets(&controller::StageBudget::belief)},
            {"noise", of_budgets(&controller::StageBudget::noise)},
            {"compression", of_budgets(&controller::StageBudget::compression)},
            {"model", of_budgets(&controller::StageBudget::model)}};
  }

  void add_pose(const Eigen::VectorXd& state, std::vector<double>& values) const {
    values.push_back(entry(state, axes_.x));
    values.push_back(entry(state, axes_.y));
    values.push_back(system_.heading < 0 || !axes_.is_plane ? kNotANumber
                                                            : entry(state, system_.heading));
  }

  [[nodiscard]] std::string poses() const {
    std::vector<double> values;
    for (const auto& state : view_.states().colwise()) add_pose(state, values);
    const bool end_is_known = view_.states().cols() > std::ssize(trace_.steps);
    if (!end_is_known) add_pose(Eigen::VectorXd(), values);
    return packed_floats(values);
  }

  /// The noise-free model's state at the end of each period.
  [[nodiscard]] std::string predicted() const {
    std::vector<double> values;
    for (const StepRecord& step : trace_.steps) {
      add_pose(step.plan_states.cols() > 1 ? Eigen::VectorXd(step.plan_states.col(1))
                                           : Eigen::VectorXd(),
               values);
    }
    return packed_floats(values);
  }

  [[nodiscard]] std::string plans() const {
    std::vector<double> values;
    for (const StepRecord& step : trace_.steps) {
      for (Eigen::Index stage = 0; stage < static_cast<Eigen::Index>(stages()); ++stage) {
        const bool known = stage < step.plan_states.cols();
        const Eigen::VectorXd state =
            known ? Eigen::VectorXd(step.plan_states.col(stage)) : Eigen::VectorXd();
        values.push_back(entry(state, axes_.x));
        values.push_back(entry(state, axes_.y));
      }
    }
    return packed_floats(values);
  }

  /// Mean and covariance of the particles in the plane: x, y, xx, xy, yy.
  [[nodiscard]] std::array<double, 5> planar_moments(const StageParticles& stage) const {
    const double weight = stage.weights.sum();
    if (stage.size() == 0 || !(weight > 0.0)) {
      return {kNotANumber, kNotANumber, kNotANumber, kNotANumber, kNotANumber};
    }
    const Eigen::ArrayXd x = stage.locations.row(axes_.x).transpose();
    const Eigen::ArrayXd y = stage.locations.row(axes_.y).transpose();
    const Eigen::ArrayXd w = stage.weights.array() / weight;
    const double x_mean = (w * x).sum();
    const double y_mean = (w * y).sum();
    return {x_mean, y_mean, (w * (x - x_mean).square()).sum(),
            (w * (x - x_mean) * (y - y_mean)).sum(), (w * (y - y_mean).square()).sum()};
  }

  [[nodiscard]] std::string moments() const {
    std::vector<double> values;
    for (const StepRecord& step : trace_.steps) {
      for (std::size_t stage = 0; stage < stages(); ++stage) {
        const std::array<double, 5> five = planar_moments(
            stage < step.particles.size() ? step.particles[stage] : StageParticles{});
        values.insert(values.end(), five.begin(), five.end());
      }
    }
    return packed_floats(values);
  }

  [[nodiscard]] std::size_t stride() const {
    std::size_t count = 0;
    for (const StepRecord& step : trace_.steps) {
      for (const StageParticles& stage : step.particles) {
        count += static_cast<std::size_t>(stage.size());
      }
    }
    return 1 + count / kMostParticles;
  }

  /// Positions within the shown part of the plane in 65,535ths; weights as square roots of their
  /// ratio to the heaviest of the stage, in 255ths.
  [[nodiscard]] Json particles(const PlaneMap& map) const {
    const MapRectangle area = map.area.value_or(map_area(map));
    const auto place = [](double value, double lower, double upper) {
      const double share = (value - lower) / (upper - lower);
      const bool shown = share >= 0.0 && share <= 1.0;  // false for NaN
      return shown ? static_cast<std::uint16_t>(std::lround(kLastPlace * share)) : kNowhere;
    };
    const auto every = static_cast<Eigen::Index>(stride());
    std::vector<double> counts;
    std::vector<std::uint16_t> places;
    std::vector<std::uint8_t> sizes;
    for (const StepRecord& step : trace_.steps) {
      for (std::size_t stage = 0; stage < stages(); ++stage) {
        if (stage >= step.particles.size() || step.particles[stage].size() == 0) {
          counts.push_back(0.0);
          continue;
        }
        const StageParticles& measure = step.particles[stage];
        const double heaviest = measure.weights.maxCoeff();
        for (Eigen::Index i = 0; i < measure.size(); i += every) {
          const Eigen::VectorXd state = measure.locations.col(i);
          places.push_back(place(state[axes_.x], area.x_lower, area.x_upper));
          places.push_back(place(state[axes_.y], area.y_lower, area.y_upper));
          const double root = std::sqrt(std::max(measure.weights[i] / heaviest, 0.0));
          sizes.push_back(root <= 1.0 ? static_cast<std::uint8_t>(std::lround(255.0 * root)) : 0);
        }
        const Eigen::Index kept = (measure.size() + every - 1) / every;
        counts.push_back(static_cast<double>(kept));
      }
    }
    return {{"xLower", area.x_lower},
            {"xUpper", area.x_upper},
            {"yLower", area.y_lower},
            {"yUpper", area.y_upper},
            {"stride", every},
            {"counts", packed_floats(counts)},
            {"places", packed_words(places)},
            {"sizes", packed_bytes(sizes)}};
  }

  const EpisodeView& view_;
  const Trace& trace_;
  const models::SystemDescription& system_;
  MapAxes axes_;
  controller::DecisionParts parts_;
  int horizon_;  // stages with a certificate
};

}  // namespace

std::string episode_data(const EpisodeView& view, const PageScene& scene) {
  const EpisodeData data(view);
  Json json = data.periods();
  json["charts"] = Json::array();
  for (const Chart& chart : scene.charts) json["charts"].push_back(chart_data(chart));
  json["video"] = {{"from", scene.video_from}, {"speed", scene.video_speed}};
  if (scene.map != nullptr) json["map"] = data.plane(*scene.map);
  return script_json(json);
}

}  // namespace qsmpc::harness
