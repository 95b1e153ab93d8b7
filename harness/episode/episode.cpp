#include "harness/episode/episode.hpp"

#include <memory>
#include <span>
#include <utility>

#include "controller/control/controller.hpp"
#include "harness/assembly/assembly.hpp"
#include "harness/control/object_controller.hpp"
#include "harness/episode/drive.hpp"
#include "harness/errors.hpp"
#include "harness/scenario/outside_controllers.hpp"
#include "harness/threads/interruption.hpp"
#include "harness/trace/trace_writer.hpp"

namespace qsmpc::harness {
namespace {

// The second plan is warm-started from the first, like the plans of an episode.
constexpr int kRehearsals = 2;
// A period whose belief is predicted, as in all periods but the first.
constexpr int kRehearsedPeriod = 1;
constexpr double kMilliseconds = 1000.0;  // in a second

}  // namespace

/// A drive, and the controller that decides in it.
class EpisodeDriver::Loop {
 public:
  explicit Loop(const Scenario& scenario)
      : scenario_(&scenario),
        drive_(scenario),
        controller_(make_controller(drive_.scenario(), drive_.model())) {
    // Controllers outside the program start with the drive, and see only its own situations.
    if (!is_outside(scenario.controller)) rehearse();
  }

  Loop(const Scenario& scenario, ControllerObject object)
      : own_scenario_(std::make_unique<const Scenario>(with_controller(scenario, object))),
        scenario_(own_scenario_.get()),
        drive_(*scenario_),
        controller_(std::make_unique<ObjectController>(std::move(object), drive_.scenario(),
                                                       drive_.model())) {}

  Trace run(const EpisodeOptions& options) {
    const DriveOptions how{.seed = options.seed,
                           .plant_seed = options.plant_seed,
                           .noise = options.noise,
                           .certify = options.certify};
    try {
      drive_.begin(how);
      guarded([&] { controller_->reset(options.seed); });
      while (!drive_.outcome()) step(options);
    } catch (const Interrupted&) {
      drive_.end(Outcome::kInterrupted);
    }
    Trace trace = drive_.take();
    trace.controller_log = controller_->log();
    if (options.writer != nullptr) options.writer->finish(trace);
    return trace;
  }

 private:
  /// Does `work` of the controller; its failure is a fault of the drive.
  template <class Work>
  void guarded(const Work& work) {
    if (drive_.outcome()) return;
    try {
      work();
    } catch (const ControllerError& error) {
      drive_.end(Outcome::kFault, error.what(), FaultOf::kController);
    }
  }

  void step(const EpisodeOptions& options) {
    if (options.should_stop && options.should_stop()) {
      drive_.end(Outcome::kInterrupted);
      return;
    }
    const controller::Decision* decision = nullptr;
    guarded([&] { decision = &controller_->decide(drive_.situation()); });
    if (decision == nullptr) return;
    const std::size_t steps = drive_.trace().steps.size();
    const StepRecord& record = drive_.advance(*decision);
    if (drive_.trace().steps.size() == steps) return;
    if (options.writer != nullptr) {
      options.writer->append(record,
                             std::span(drive_.trace().motion).subspan(drive_.motion_begin()));
    }
    if (options.on_step) options.on_step(drive_.trace());
  }

  /// Decides and certifies for typical beliefs and discards the decisions: slow first-time work,
  /// such as filling tables and allocating memory, is then done before the loop begins.
  void rehearse() {
    const controller::Gaussian later = drive_.later_belief();
    const Scenario::GaussianValue& first = scenario_->initial_state;
    for (const Eigen::MatrixXd& covariance : {later.covariance, first.covariance}) {
      const controller::Gaussian belief{.mean = first.mean, .covariance = covariance};
      for (int n = 0; n < kRehearsals; ++n) {
        const controller::Situation situation = drive_.situation_of(belief, kRehearsedPeriod);
        const StepRecord record = drive_.record_of(situation, controller_->decide(situation));
        // If planning takes longer than a period anyway, a second rehearsal is not worth the wait.
        if (record.timing.total > kMilliseconds * scenario_->time_step) break;
      }
    }
  }

  std::unique_ptr<const Scenario> own_scenario_{};  // if the controller is an object
  const Scenario* scenario_;
  Drive drive_;
  std::unique_ptr<controller::Controller> controller_;
};

EpisodeDriver::EpisodeDriver(const Scenario& scenario) : loop_(std::make_unique<Loop>(scenario)) {}
EpisodeDriver::EpisodeDriver(const Scenario& scenario, ControllerObject object)
    : loop_(std::make_unique<Loop>(scenario, std::move(object))) {}
EpisodeDriver::EpisodeDriver(EpisodeDriver&&) noexcept = default;
EpisodeDriver& EpisodeDriver::operator=(EpisodeDriver&&) noexcept = default;
EpisodeDriver::~EpisodeDriver() = default;

Trace EpisodeDriver::run(const EpisodeOptions& options) { return loop_->run(options); }

Trace run_episode(const Scenario& scenario, const EpisodeOptions& options) {
  return EpisodeDriver(scenario).run(options);
}

Trace run_episode(const Scenario& scenario, const EpisodeOptions& options,
                  ControllerObject object) {
  return EpisodeDriver(scenario, std::move(object)).run(options);
}

}  // namespace qsmpc::harness
