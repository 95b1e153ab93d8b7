#include "harness/trace/trace_csv.hpp"

#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "harness/text/csv.hpp"
#include "harness/trace/driven_obstacles.hpp"

namespace qsmpc::harness {
namespace {

using Coordinates = std::vector<models::Coordinate>;

/// Lines that grow field by field.
class Table {
 public:
  void text(const std::string& value) { put(csv_field(value)); }
  void count(std::size_t value) { put(fmt::format("{}", value)); }
  void number(double value) { put(std::isfinite(value) ? fmt::format("{}", value) : ""); }
  /// `size` numbers; empty fields where there are none.
  void numbers(const Eigen::Ref<const Eigen::VectorXd>& values, std::size_t size) {
    const auto known = static_cast<std::size_t>(values.size());
    for (std::size_t i = 0; i < size; ++i) {
      number(i < known ? values[static_cast<Eigen::Index>(i)] : kNotANumber);
    }
  }
  void nothing(std::size_t fields) { numbers(Eigen::VectorXd(), fields); }
  void heads(const std::string& prefix, const Coordinates& coordinates) {
    for (const models::Coordinate& one : coordinates) {
      text(fmt::format("{}{} [{}]", prefix, one.name, one.unit));
    }
  }
  void end_line() {
    out_ += '\n';
    begins_ = true;
  }
  [[nodiscard]] const std::string& str() const { return out_; }

 private:
  void put(const std::string& field) {
    if (!begins_) out_ += ',';
    out_ += field;
    begins_ = false;
  }

  std::string out_;
  bool begins_ = true;
};

/// Indices of the moving obstacles among all of them.
std::vector<std::size_t> moving_indices(const controller::SafeSet& safe_set) {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < safe_set.obstacles.size(); ++i) {
    if (safe_set.obstacles[i].motion) indices.push_back(i);
  }
  return indices;
}

void episode_head(const EpisodeView& view, Table& table) {
  const models::SystemDescription& system = view.system();
  table.text("time [s]");
  table.heads("", system.states);
  table.text(fmt::format("clearance [{}]", view.clearance_unit()));
  table.heads("observed ", system.states);
  table.heads("", system.inputs);
  table.heads("disturbance ", system.states);
  table.heads("residual ", system.states);
  table.heads("belief ", system.states);
  table.text("cost");
  table.text("P(unsafe at next step) <=");
  table.end_line();
}

void episode_line(const EpisodeView& view, const StepRecord& step, Eigen::Index k, Table& table) {
  const std::size_t states = view.system().states.size();
  table.number(step.time);
  table.numbers(step.state, states);
  table.number(view.clearances()[k]);
  table.numbers(step.observation, states);
  table.numbers(step.input, view.system().inputs.size());
  table.numbers(step.disturbance, states);
  table.numbers(step.residual, states);
  table.numbers(step.belief_mean, states);
  table.number(step.cost.total());
  table.number(step.certificates.empty() ? kNotANumber : step.certificates.front().value);
  table.end_line();
}

}  // namespace

std::string episode_csv(const EpisodeView& view) {
  Table table;
  episode_head(view, table);
  const std::vector<StepRecord>& steps = view.trace().steps;
  Eigen::Index k = 0;
  for (const StepRecord& step : steps) episode_line(view, step, k++, table);
  if (k < view.states().cols()) {
    // After the last period only the state is known.
    const std::size_t states = view.system().states.size();
    table.number(view.duration());
    table.numbers(view.states().col(k), states);
    table.number(view.clearances()[k]);
    table.nothing(4 * states + view.system().inputs.size() + 2);
    table.end_line();
  }
  return table.str();
}

std::string plan_csv(const EpisodeView& view) {
  const models::SystemDescription& system = view.system();
  Table table;
  for (const char* head : {"time [s]", "stage"}) table.text(head);
  table.heads("", system.states);
  table.heads("", system.inputs);
  table.text("P(unsafe) <=");
  table.end_line();
  for (const StepRecord& step : view.trace().steps) {
    for (Eigen::Index k = 0; k < step.plan_states.cols(); ++k) {
      table.number(step.time + static_cast<double>(k) * view.scenario().time_step);
      table.count(static_cast<std::size_t>(k));
      table.numbers(step.plan_states.col(k), system.states.size());
      if (k < step.plan_inputs.cols()) {
        table.numbers(step.plan_inputs.col(k), system.inputs.size());
      } else {
        table.nothing(system.inputs.size());
      }
      const bool certified = k > 0 && k <= std::ssize(step.certificates);
      table.number(certified ? step.certificates[static_cast<std::size_t>(k - 1)].value
                             : kNotANumber);
      table.end_line();
    }
  }
  return table.str();
}

std::string obstacles_csv(const EpisodeView& view) {
  Table table;
  for (const char* head :
       {"time [s]", "obstacle", "x [m]", "y [m]", "turn [rad]", "seen x [m]", "seen y [m]"}) {
    table.text(head);
  }
  table.end_line();
  const std::vector<StepRecord>& steps = view.trace().steps;
  const DrivenObstacles others(view.trace());
  const std::vector<std::size_t> indices = moving_indices(view.scenario().safe_set);
  for (std::size_t k = 0; k < others.poses().size(); ++k) {
    for (std::size_t n = 0; n < others.count(); ++n) {
      const auto column = static_cast<Eigen::Index>(n);
      const Eigen::Vector2d centre = controller::shape_centre(others.shape(n));
      const Eigen::Vector3d pose = others.poses()[k].col(column);
      table.number(static_cast<double>(k) * view.scenario().time_step);
      table.count(indices[n]);
      table.numbers(centre + pose.head<2>(), 2);
      table.number(pose[2]);
      if (k < steps.size() && column < steps[k].obstacles_seen.cols()) {
        table.numbers(centre + steps[k].obstacles_seen.col(column), 2);
      } else {
        table.nothing(2);
      }
      table.end_line();
    }
  }
  return table.str();
}

std::string particles_csv(const EpisodeView& view) {
  const models::SystemDescription& system = view.system();
  Table table;
  for (const char* head : {"time [s]", "planned at [s]", "stage", "weight"}) table.text(head);
  table.heads("", system.states);
  table.end_line();
  for (const StepRecord& step : view.trace().steps) {
    for (std::size_t stage = 0; stage < step.particles.size(); ++stage) {
      const StageParticles& particles = step.particles[stage];
      for (Eigen::Index i = 0; i < particles.weights.size(); ++i) {
        table.number(step.time + static_cast<double>(stage) * view.scenario().time_step);
        table.number(step.time);
        table.count(stage);
        table.number(particles.weights[i]);
        table.numbers(particles.locations.col(i), system.states.size());
        table.end_line();
      }
    }
  }
  return table.str();
}

}  // namespace qsmpc::harness
