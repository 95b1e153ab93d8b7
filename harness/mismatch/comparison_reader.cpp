// read_comparison: reads what comparison_file.hpp writes.
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "harness/assembly/assembly.hpp"
#include "harness/errors.hpp"
#include "harness/mismatch/comparison_file.hpp"
#include "harness/scenario/model_dynamics.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "models/constants.hpp"

namespace qsmpc::harness {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// For values that an older file lacks.

class ComparisonReader {
 public:
  explicit ComparisonReader(const std::string& path) : file_(Hdf5File::open(path)) {}

  Comparison read() {
    read_header();
    check_datasets();
    read_certificates();
    for (std::size_t n = 0; n < groups_.size(); ++n) read_plant(n);
    return std::move(comparison_);
  }

 private:
  [[noreturn]] void refuse(const std::string& key, const std::string& found,
                           const std::string& expected) const {
    throw InputError({.file = file_.path(), .key = key, .found = found, .expected = expected});
  }

  void read_header();
  void check_datasets() const;
  void read_certificates();
  void read_plant(std::size_t n);
  void read_episodes(const std::string& group, PlantComparison& plant) const;
  [[nodiscard]] ClosedLoop closed_loop(const std::string& group,
                                       const std::vector<EpisodeResult>& episodes) const;
  [[nodiscard]] ResidualStatistics one_step(const std::string& group) const;
  [[nodiscard]] std::vector<HorizonStage> horizon(const std::string& group) const;

  /// Refuses a dataset unless it has `rows` rows.
  void expect_rows(const std::string& path, std::size_t rows) const {
    const std::size_t found = file_.shape(path).front();
    if (found != rows) refuse(path, std::to_string(found) + " rows", std::to_string(rows));
  }
  [[nodiscard]] std::vector<double> doubles(const std::string& path, std::size_t rows) const {
    expect_rows(path, rows);
    return file_.doubles(path);
  }
  [[nodiscard]] std::vector<std::int64_t> integers(const std::string& path,
                                                   std::size_t rows) const {
    expect_rows(path, rows);
    return file_.integers(path);
  }
  /// One number per state.
  [[nodiscard]] Eigen::VectorXd by_state(const std::string& path) const {
    const std::vector<double> values = doubles(path, state_dim_);
    return Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values));
  }
  [[nodiscard]] std::vector<controller::StageCertificate> certificates(
      const std::string& path) const {
    std::vector<controller::StageCertificate> certificates(horizon_);
    const std::vector<double> values = doubles(path, horizon_);
    for (std::size_t k = 0; k < horizon_; ++k) certificates[k].value = values[k];
    return certificates;
  }

  Hdf5File file_;
  Comparison comparison_;
  std::vector<std::string> groups_;
  std::size_t state_dim_ = 0;
  std::size_t horizon_ = 0;
};

void ComparisonReader::read_header() {
  const std::string expected = "a comparison of schema " + std::to_string(kComparisonSchema);
  if (!file_.has_attribute("/", "kind") || file_.text("/", "kind") != "comparison") {
    refuse("/@kind", "a file that is not a comparison", expected);
  }
  if (const std::int64_t found = file_.integer("/", "schema"); found != kComparisonSchema) {
    refuse("/@schema", "schema " + std::to_string(found), expected);
  }
  comparison_.version = file_.text("/", "version");
  comparison_.scenario_text = file_.text("/", "scenario");
  const std::string& path = file_.path();
  comparison_.scenario = parse_scenario(
      comparison_.scenario_text,
      {.file = path, .folder = path.substr(0, path.rfind('/') + 1), .files_must_exist = false});
  comparison_.system = system_of(comparison_.scenario);
  state_dim_ = comparison_.system.states.size();
  horizon_ = static_cast<std::size_t>(certified_stages(decision_parts(comparison_.scenario)));
  const std::vector<std::string> names = file_.texts("/plants", "names");
  groups_ = file_.texts("/plants", "groups");
  for (const std::string& name : names) comparison_.plants.push_back({.name = name});
  if (names.empty() || groups_ != plant_groups(comparison_)) {
    refuse("/plants@groups", std::to_string(groups_.size()) + " groups", "one for each plant");
  }
  if (file_.has_dataset("/certificate/with")) comparison_.with_error.emplace();
  const std::vector<std::size_t> shape = file_.shape("/model/states");
  comparison_.paths = shape.size() == 3 ? static_cast<std::int64_t>(shape[1]) : 0;
  if (file_.has_attribute("/model", "w2_paths")) {
    comparison_.w2_paths = file_.integer("/model", "w2_paths");
  }
}

/// Datasets that older files may lack.
bool may_be_missing(const std::string& path) {
  return path == "/timing/speed" || path.find("/next_step/") != std::string::npos;
}

/// Checks everything except the number of rows.
void ComparisonReader::check_datasets() const {
  for (const DatasetSpec& spec : comparison_layout(comparison_)) {
    if (may_be_missing(spec.path) && !file_.has_dataset(spec.path)) continue;
    std::vector<std::size_t> found = file_.shape(spec.path);
    if (found.size() != spec.row_shape.size() + 1 ||
        !std::equal(spec.row_shape.begin(), spec.row_shape.end(), found.begin() + 1)) {
      refuse(spec.path, "a different shape", "the shape that qsmpc compare writes");
    }
  }
}

void ComparisonReader::read_certificates() {
  comparison_.certificates = certificates("/certificate/without");
  if (comparison_.with_error) comparison_.with_error = certificates("/certificate/with");
  const std::vector<double> floors = doubles("/model/w2_floor", horizon_ + 1);
  for (std::size_t k = 0; k <= horizon_; ++k) {
    comparison_.floors.push_back({.mean = floors[2 * k], .deviation = floors[2 * k + 1]});
  }
}

void ComparisonReader::read_episodes(const std::string& group, PlantComparison& plant) const {
  const std::string own = group + "/closed_loop/";
  const std::size_t count = file_.shape(own + "seed").front();
  if (count == 0) refuse(own + "seed", "no episodes", "at least one");
  const auto seeds = integers(own + "seed", count);
  expect_rows(own + "outcome", count);
  const auto outcomes = file_.texts(own + "outcome");
  const auto steps = integers(own + "steps", count);
  const auto unsafe = integers(own + "unsafe", count);
  const auto clearances = doubles(own + "min_clearance", count);
  const auto costs = doubles(own + "cost", count);
  for (std::size_t n = 0; n < count; ++n) {
    EpisodeResult episode;
    episode.seed = static_cast<std::uint64_t>(seeds[n]);
    episode.outcome = outcomes[n];
    episode.steps = static_cast<int>(steps[n]);
    episode.unsafe = unsafe[n] != 0;
    episode.min_clearance = clearances[n];
    episode.cost = costs[n];
    plant.episodes.push_back(std::move(episode));
  }
  const std::string periods = group + "/next_step/";
  if (!file_.has_dataset(periods + "episode")) return;
  const std::size_t rows = file_.shape(periods + "episode").front();
  const auto owners = file_.integers(periods + "episode");
  const auto certified = doubles(periods + "certified", rows);
  const auto unsafe_next = integers(periods + "unsafe", rows);
  for (std::size_t k = 0; k < rows; ++k) {
    if (owners[k] < 0 || owners[k] >= static_cast<std::int64_t>(count)) {
      refuse(periods + "episode", std::to_string(owners[k]), "the number of an episode");
    }
    EpisodeResult& episode = plant.episodes[static_cast<std::size_t>(owners[k])];
    episode.certified.push_back(certified[k]);
    episode.unsafe_next.push_back(unsafe_next[k] != 0);
  }
}

/// From an older file, the sums that it has; the p-value is then unknown.
ClosedLoop ComparisonReader::closed_loop(const std::string& group,
                                         const std::vector<EpisodeResult>& episodes) const {
  ClosedLoop loop = closed_loop_of(episodes);
  if (file_.has_dataset(group + "/next_step/episode")) return loop;
  loop.periods = static_cast<std::int64_t>(file_.shape(group + "/one_step/residuals").front());
  for (const std::int64_t unsafe :
       integers(group + "/closed_loop/unsafe_periods", episodes.size())) {
    loop.unsafe_periods += unsafe;
  }
  for (const double certified : doubles(group + "/closed_loop/certified", episodes.size())) {
    loop.certified_periods += certified;
  }
  loop.p_value = kNotANumber;
  return loop;
}

ResidualStatistics ComparisonReader::one_step(const std::string& group) const {
  const std::string own = group + "/one_step/";
  const std::vector<double> covariance = doubles(own + "covariance", state_dim_);
  const auto size = static_cast<Eigen::Index>(state_dim_);
  ResidualStatistics statistics;
  statistics.periods = static_cast<std::int64_t>(file_.shape(own + "residuals").front());
  statistics.mean = by_state(own + "mean");
  statistics.mean_deviation = by_state(own + "mean_deviation");
  statistics.covariance = Eigen::Map<const RowMajor>(covariance.data(), size, size);
  statistics.rmse = by_state(own + "rmse");
  statistics.rounding = by_state(own + "rounding");
  statistics.whiteness.lag1 = by_state(own + "lag1");
  statistics.whiteness.ljung_box = by_state(own + "ljung_box");
  statistics.whiteness.p_value = by_state(own + "p_value");
  return statistics;
}

std::vector<HorizonStage> ComparisonReader::horizon(const std::string& group) const {
  const std::string own = group + "/horizon/";
  const auto divergence = doubles(own + "divergence_rmse", horizon_);
  const auto w2 = doubles(own + "w2", horizon_);
  const auto unsafe = integers(own + "unsafe", horizon_);
  const auto rates = doubles(own + "rate", horizon_);
  std::vector<HorizonStage> stages;
  for (std::size_t k = 0; k < horizon_; ++k) {
    HorizonStage stage;
    stage.stage = static_cast<int>(k) + 1;
    stage.divergence_rmse = Eigen::Map<const Eigen::VectorXd>(
        divergence.data() + k * state_dim_, static_cast<Eigen::Index>(state_dim_));
    stage.w2 = w2[k];
    stage.unsafe = unsafe[k];
    stage.unsafe_limits = {.lower = rates[3 * k + 1], .upper = rates[3 * k + 2]};
    stages.push_back(std::move(stage));
  }
  return stages;
}

void ComparisonReader::read_plant(std::size_t n) {
  const std::string& group = groups_[n];
  PlantComparison& plant = comparison_.plants[n];
  read_episodes(group, plant);
  plant.closed_loop = closed_loop(group, plant.episodes);
  plant.one_step = one_step(group);
  plant.paths.faults = file_.integer(group + "/paths", "faults");
  plant.horizon = horizon(group);
  plant.exceeded_stages = exceeded_stages(plant.horizon, comparison_.in_force());
  const bool has_speed = file_.has_dataset("/timing/speed");
  plant.speed = has_speed ? doubles("/timing/speed", groups_.size())[n] : kNotANumber;
}

}  // namespace

Comparison read_comparison(const std::string& folder) {
  return ComparisonReader(folder + "/" + kComparisonFile).read();
}

}  // namespace qsmpc::harness
