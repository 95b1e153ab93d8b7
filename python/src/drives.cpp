// Episodes that Python advances period by period, one or many in parallel, and pictures of them.
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "python/src/arrays.hpp"
#include "python/src/calls.hpp"
#include "python/src/episodes.hpp"
#include "python/src/module.hpp"
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include "harness/episode/drive.hpp"
#include "harness/threads/executor.hpp"
#include "harness/trace/episode_view.hpp"
#include "harness/trace/summary.hpp"
#include "harness/video/episode_painter.hpp"
#include "models/constants.hpp"

namespace qsmpc::python {
namespace {

namespace nb = nanobind;
using nb::literals::operator""_a;
using harness::Scenario;

/// The result of a period.
struct Period {
  double cost = 0.0;               ///< of the period, see harness::period_cost
  double certified = kNotANumber;  ///< upper bound of the probability that its end is unsafe
  double clearance = kNotANumber;  ///< of the state at its end
};

/// A drive with its scenario.
class OpenDrive {
 public:
  explicit OpenDrive(Scenario scenario)
      : scenario_(std::make_unique<const Scenario>(std::move(scenario))), drive_(*scenario_) {}

  void begin(std::uint64_t seed, std::optional<std::uint64_t> plant_seed, bool certify) {
    drive_.begin({.seed = seed, .plant_seed = plant_seed, .certify = certify});
    has_begun_ = true;
  }

  Period advance(const Eigen::VectorXd& input) {
    decision_.input = input;
    const std::optional<double> progress = drive_.progress();
    const harness::StepRecord& record = drive_.advance(decision_);
    Period period;
    period.cost = harness::period_cost(*scenario_, record.state, record.input, progress);
    if (!record.certificates.empty()) period.certified = record.certificates.front().value;
    period.clearance = clearance();
    return period;
  }

  [[nodiscard]] double clearance() const { return drive().clearance(); }

  /// The observation of the state.
  [[nodiscard]] const Eigen::VectorXd& observation() const {
    return drive().situation().observation;
  }

  /// The outcome; nothing while the episode is running.
  [[nodiscard]] std::optional<std::string> outcome() const {
    if (!drive_.outcome()) return std::nullopt;
    return harness::outcome_name(*drive_.outcome());
  }

  [[nodiscard]] const Scenario& scenario() const { return *scenario_; }
  /// Throws std::invalid_argument if no episode has begun.
  [[nodiscard]] const harness::Drive& drive() const {
    if (!has_begun_) throw std::invalid_argument("no episode has begun: reset it first");
    return drive_;
  }
  [[nodiscard]] const models::Dynamics& model() const { return drive_.model(); }

 private:
  std::unique_ptr<const Scenario> scenario_;
  harness::Drive drive_;
  bool has_begun_ = false;
  controller::Decision decision_;
};

/// Drives of one scenario, side by side.
class DriveBatch {
 public:
  DriveBatch(const Scenario& scenario, int count, int threads)
      : run_(harness::executor_of(threads)) {
    for (int n = 0; n < count; ++n) drives_.push_back(std::make_unique<OpenDrive>(scenario));
  }

  DriveBatch(const DriveBatch&) = delete;
  DriveBatch& operator=(const DriveBatch&) = delete;

  /// inputs: count x input_dim. seeds: of drives that restart instead of stepping; -1 for all
  /// others.
  /// Returns observations (count x state_dim), costs, certified, clearances, and outcomes (empty
  /// while a drive is running). For drives that have just begun or were already over, costs are 0
  /// and certified is NaN.
  auto step(const RowMatrix& inputs, const std::vector<std::int64_t>& seeds, bool certify) {
    const auto count = static_cast<Eigen::Index>(drives_.size());
    if (inputs.rows() != count || std::ssize(seeds) != count) {
      throw nb::value_error("a batch needs one input and one seed per drive");
    }
    RowMatrix observations(count, drives_.front()->model().state_dim());
    Eigen::VectorXd costs = Eigen::VectorXd::Zero(count);
    Eigen::VectorXd certified = Eigen::VectorXd::Constant(count, kNotANumber);
    Eigen::VectorXd clearances(count);
    std::vector<std::string> outcomes(drives_.size());
    without_lock([&] {
      run_(static_cast<int>(count), [&](int n) {
        OpenDrive& drive = *drives_[static_cast<std::size_t>(n)];
        const std::int64_t seed = seeds[static_cast<std::size_t>(n)];
        if (seed >= 0) {
          drive.begin(static_cast<std::uint64_t>(seed), std::nullopt, certify);
        } else if (!drive.outcome()) {
          const Period period = drive.advance(inputs.row(n).transpose());
          costs[n] = period.cost;
          certified[n] = period.certified;
        }
        clearances[n] = drive.clearance();
        observations.row(n) = drive.observation().transpose();
        outcomes[static_cast<std::size_t>(n)] = drive.outcome().value_or("");
      });
    });
    return std::tuple(observations, costs, certified, clearances, outcomes);
  }

  [[nodiscard]] OpenDrive& at(std::size_t n) const {
    if (n >= drives_.size()) throw nb::index_error("no such drive");
    return *drives_[n];
  }

 private:
  controller::Executor run_;
  std::vector<std::unique_ptr<OpenDrive>> drives_;
};

/// Draws the current state of a drive. Created and used on one thread.
class DrivePicture {
 public:
  DrivePicture(int width, int height, std::string camera)
      : layout_{.width = width, .height = height, .camera = std::move(camera)} {}

  /// height x width x 3.
  Array<std::uint8_t> draw(const OpenDrive& drive) {
    const harness::EpisodeView view(drive.drive().trace());
    const harness::EpisodePictures pictures(view, layout_);
    if (renderer_ == nullptr) {
      renderer_ = std::make_unique<render::Renderer>(pictures.options(), pictures.scenes());
    }
    std::vector<render::Frame> frames = pictures.at(pictures.duration());
    if (!drive.drive().outcome()) {  // the drive has not ended: no outcome to show
      frames.front().banner.clear();
      frames.front().alarm = false;
    }
    render::Image image;
    renderer_->draw(frames, image);
    const auto height = static_cast<std::size_t>(image.height);
    const auto width = static_cast<std::size_t>(image.width);
    return array_of(std::vector<std::uint8_t>(image.rgb), {height, width, 3});
  }

 private:
  harness::VideoLayout layout_;
  std::unique_ptr<render::Renderer> renderer_;
};

void add_drive_class(nb::module_& module) {
  nb::class_<OpenDrive>(module, "Drive")
      .def(nb::init<Scenario>(), "scenario"_a)
      .def(
          "begin",
          [](OpenDrive& drive, std::uint64_t seed, std::optional<std::uint64_t> plant_seed,
             bool certify) { without_lock([&] { drive.begin(seed, plant_seed, certify); }); },
          "seed"_a, "plant_seed"_a.none() = nb::none(), "certify"_a = true)
      .def(
          "advance",
          [](OpenDrive& drive, const Eigen::VectorXd& input) {
            const Period period = without_lock([&] { return drive.advance(input); });
            return std::tuple(period.cost, period.certified, period.clearance);
          },
          "input"_a, "Returns cost, certified probability (NaN if not certified), clearance.")
      .def_prop_ro("scenario", [](const OpenDrive& drive) { return drive.scenario(); })
      .def_prop_ro("period", [](const OpenDrive& drive) { return drive.drive().period(); })
      .def_prop_ro("state", [](const OpenDrive& drive) { return drive.drive().state(); })
      .def_prop_ro("observation", [](const OpenDrive& drive) { return drive.observation(); })
      .def_prop_ro("belief",
                   [](const OpenDrive& drive) {
                     const controller::Gaussian& belief = drive.drive().situation().belief;
                     return std::pair(belief.mean, belief.covariance);
                   })
      .def_prop_ro("clearance", &OpenDrive::clearance)
      .def_prop_ro("outcome", &OpenDrive::outcome)
      .def("episode",
           [](const OpenDrive& drive) { return std::make_unique<Episode>(drive.drive().trace()); });
}

}  // namespace

void add_drives(nb::module_& module) {
  add_drive_class(module);
  nb::class_<DriveBatch>(module, "DriveBatch")
      .def(nb::init<const Scenario&, int, int>(), "scenario"_a, "count"_a, "threads"_a)
      .def("step", &DriveBatch::step, "inputs"_a, "seeds"_a, "certify"_a)
      .def("at", &DriveBatch::at, "index"_a, nb::rv_policy::reference_internal);
  nb::class_<DrivePicture>(module, "DrivePicture")
      .def(nb::init<int, int, std::string>(), "width"_a, "height"_a, "camera"_a)
      .def("draw", &DrivePicture::draw, "drive"_a);
}

}  // namespace qsmpc::python
