#include "harness/doctor/plant_answers.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "harness/assembly/assembly.hpp"
#include "harness/plant/plant.hpp"
#include "harness/plant/plant_registry.hpp"
#include "models/constants.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {
namespace {

constexpr int kLeastPeriods = 8;
constexpr int kMostPeriods = 40;
constexpr double kLeastDuration = 0.5;    // s
constexpr double kAmplitude = 0.1;        // of the half-range; small enough to be nearly linear
constexpr double kUnboundedRange = 10.0;  // half-range of an input without bounds, in its unit
constexpr double kAnswered = 0.01;        // of a state's scale
constexpr int kDelaySteps = 20;           // per period

/// The change of the states after 1, 2, … periods, state_dim x periods.
using Path = Eigen::MatrixXd;

struct Paths {
  Path model;
  Path plant;
  double tilt_at_start = 0.0;  // rad, of the plant
  double tilt = 0.0;           // rad, at the end
};

/// Drives plant and model from the same state under held inputs.
class Comparer {
 public:
  explicit Comparer(const Scenario& scenario)
      : model_(model_of(scenario)),
        plant_(make_plant(undisturbed(scenario))),
        start_(scenario.initial_state.mean),
        lower_(scenario.controller.input_lower),
        upper_(scenario.controller.input_upper),
        periods_(std::clamp(static_cast<int>(std::ceil(kLeastDuration / scenario.time_step)),
                            kLeastPeriods, kMostPeriods)) {}

  [[nodiscard]] const models::Dynamics& model() const { return *model_; }
  [[nodiscard]] int periods() const { return periods_; }

  [[nodiscard]] Eigen::VectorXd neutral() const {
    return Eigen::VectorXd::Zero(lower_.size()).cwiseMax(lower_).cwiseMin(upper_);
  }

  /// The displacement of an input to either side.
  [[nodiscard]] double amplitude(Eigen::Index input) const {
    const double half_range = 0.5 * (upper_[input] - lower_[input]);
    return kAmplitude * (std::isfinite(half_range) ? half_range : kUnboundedRange);
  }

  /// The neutral input with one component displaced; inwards where it is at a bound.
  [[nodiscard]] Eigen::VectorXd moved(Eigen::Index input, double by) const {
    Eigen::VectorXd held = neutral();
    const double reach = std::abs(by);
    const double centre = std::clamp(held[input], lower_[input] + reach,
                                     std::max(upper_[input] - reach, lower_[input] + reach));
    held[input] = centre + by;
    return held;
  }

  /// Throws SimulatorError where the plant breaks.
  [[nodiscard]] Paths drive(const Eigen::VectorXd& input) const {
    Paths paths{.model = Path(start_.size(), periods_),
                .plant = Path(start_.size(), periods_),
                .tilt_at_start = 0.0,
                .tilt = 0.0};
    plant_->reset(start_);
    const Eigen::VectorXd start = plant_->state();  // sensor states cannot be set
    paths.tilt_at_start = plant_->tilt();
    models::StateBatch state = start;
    models::StateBatch next = state;
    const models::StateBatch held = input;
    const Eigen::VectorXd still = Eigen::VectorXd::Zero(start.size());
    for (int k = 0; k < periods_; ++k) {
      model_->step(state, held, next);
      state = next;
      const PlantStep step = plant_->advance(input, still);
      if (step.fault) {
        throw SimulatorError({.found = fmt::format("{} in period {}", *step.fault, k + 1)});
      }
      paths.model.col(k) = state - start;
      paths.plant.col(k) = step.state - start;
    }
    paths.tilt = plant_->tilt();
    return paths;
  }

 private:
  static Scenario undisturbed(Scenario scenario) {
    scenario.plant.solid = false;
    scenario.disturbance.kind = "state";
    scenario.disturbance.friction = 0.0;
    scenario.disturbance.mass = 0.0;
    scenario.disturbance.wheelbase = 0.0;
    return scenario;
  }

  std::unique_ptr<const models::Dynamics> model_;
  std::unique_ptr<Plant> plant_;
  Eigen::VectorXd start_;
  Eigen::VectorXd lower_;
  Eigen::VectorXd upper_;
  int periods_;
};

/// `answer`, delayed by `delay` periods; 0 before its first period.
Eigen::VectorXd delayed(const Eigen::VectorXd& answer, double delay) {
  Eigen::VectorXd later = Eigen::VectorXd::Zero(answer.size());
  // For a delay of 0, the weight of the value after the last period is 0.
  const auto at = [&](Eigen::Index k) {
    return k < 0 ? 0.0 : answer[std::min(k, answer.size() - 1)];
  };
  for (Eigen::Index k = 0; k < answer.size(); ++k) {
    const double time = static_cast<double>(k) - delay;
    const double whole = std::floor(time);
    const auto before = static_cast<Eigen::Index>(whole);
    later[k] = at(before) + (time - whole) * (at(before + 1) - at(before));
  }
  return later;
}

/// The ratio and the delay that fit the model's response to the plant's best.
void fit(StateAnswer& answer, double period) {
  const int most = static_cast<int>(answer.model.size()) / 2 * kDelaySteps;
  double least = kInfinity;
  for (int n = 0; n <= most; ++n) {
    const double delay = static_cast<double>(n) / kDelaySteps;
    const Eigen::VectorXd later = delayed(answer.model, delay);
    const double size = later.squaredNorm();
    if (!(size > 0.0)) break;
    const double ratio = later.dot(answer.plant) / size;
    const double error = (answer.plant - ratio * later).squaredNorm();
    // A larger delay must improve the fit by more than rounding.
    if (error < least * (1.0 - 1e-6)) {
      least = error;
      answer.ratio = ratio;
      answer.delay = delay * period;
    }
  }
}

InputAnswer input_answer(int input, double amplitude, const Paths& paths) {
  InputAnswer answer{.input = input, .amplitude = amplitude, .states = {}};
  for (Eigen::Index i = 0; i < paths.model.rows(); ++i) {
    answer.states.push_back({.model = paths.model.row(i), .plant = paths.plant.row(i)});
  }
  return answer;
}

/// Computes what depends on the scale over all drives.
void judge(InputAnswer& answer, const PlantAnswers& all) {
  const double to_full = answer.input < 0 ? 1.0 : 1.0 / kAmplitude;
  for (std::size_t i = 0; i < answer.states.size(); ++i) {
    StateAnswer& state = answer.states[i];
    for (Eigen::Index k = state.model.size() / 2; k < state.model.size(); ++k) {
      const double difference = std::abs(state.plant[k] - state.model[k]);
      state.discrepancy =
          std::max(state.discrepancy, to_full * difference / static_cast<double>(k + 1));
    }
    const double size = state.model.cwiseAbs().maxCoeff();
    state.ratio = kNotANumber;
    if (size > kAnswered * all.scale[static_cast<Eigen::Index>(i)]) fit(state, all.period);
  }
}

void drive_all(const Comparer& comparer, PlantAnswers& answers) {
  const Paths none = comparer.drive(comparer.neutral());
  answers.inputs.push_back(input_answer(-1, 0.0, none));
  answers.tilt_at_start = none.tilt_at_start;
  answers.tilt = none.tilt;
  for (int j = 0; j < comparer.model().input_dim(); ++j) {
    const double amplitude = comparer.amplitude(j);
    const Paths above = comparer.drive(comparer.moved(j, amplitude));
    const Paths below = comparer.drive(comparer.moved(j, -amplitude));
    answers.tilt = std::max({answers.tilt, above.tilt, below.tilt});
    answers.inputs.push_back(input_answer(
        j, amplitude,
        {.model = 0.5 * (above.model - below.model), .plant = 0.5 * (above.plant - below.plant)}));
  }
}

}  // namespace

PlantAnswers plant_answers(const Scenario& scenario) {
  const Comparer comparer(scenario);
  PlantAnswers answers{.periods = comparer.periods(),
                       .period = scenario.time_step,
                       .start = scenario.initial_state.mean,
                       .scale = Eigen::VectorXd::Zero(comparer.model().state_dim()),
                       .inputs = {}};
  try {
    drive_all(comparer, answers);
  } catch (const SimulatorError& error) {
    answers.fault = error.where().found;
  }
  for (const InputAnswer& answer : answers.inputs) {
    for (Eigen::Index i = 0; i < answers.scale.size(); ++i) {
      const StateAnswer& state = answer.states[static_cast<std::size_t>(i)];
      answers.scale[i] = std::max(answers.scale[i], state.model.cwiseAbs().maxCoeff());
    }
  }
  for (InputAnswer& answer : answers.inputs) judge(answer, answers);
  return answers;
}

}  // namespace qsmpc::harness
