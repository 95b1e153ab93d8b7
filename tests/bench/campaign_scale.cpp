// Time and memory of a large campaign's statistics: stores of made-up episodes are merged and
// everything is produced that `qsmpc campaign merge` produces, with seconds and memory per stage.
//
//   campaign_scale [--episodes 1000000] [--periods 5] [--stores 4] [--out DIR]
//   campaign_scale --stores 1000 --out DIR --make-only
//   /usr/bin/time -v qsmpc campaign merge DIR/stores/* --out DIR/merged
//
// Requirement: a million episodes of 75 periods in at most two minutes and 1 GB.
//
// Variants share the random numbers of their seeds, some episodes fail, and store I of N is shard
// I/N. The memory of a stage is the process's peak up to its end.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include "harness/campaign/statistics/campaign_csv.hpp"
#include "harness/campaign/statistics/campaign_json.hpp"
#include "harness/campaign/statistics/statistics.hpp"
#include "harness/campaign/statistics/worst_episodes.hpp"
#include "harness/campaign/store/merge.hpp"
#include "harness/campaign/store/store.hpp"
#include "harness/campaign/store/store_rows.hpp"
#include "harness/campaign/store/store_schema.hpp"
#include "harness/figures/svg_figure.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/report/campaign_charts.hpp"
#include "harness/report/campaign_page.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/version.hpp"
#include "models/random/random_numbers.hpp"

namespace qsmpc::harness {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct ScaleArguments {
  std::int64_t episodes = 1'000'000;  ///< over all variants
  std::int64_t variants = 4;
  std::int64_t periods = 5;  ///< per episode
  std::int64_t stores = 4;
  std::string out;
  bool make_only = false;
};

/// Time limit of all stages after the stores are made.
constexpr double kMostSeconds = 120.0;
constexpr double kMostMegabytes = 1024.0;
constexpr double kKibibytesInMebibyte = 1024.0;

Campaign campaign_of(const ScaleArguments& arguments) {
  Campaign campaign{.name = "scale", .variants = {}, .seeds = {}};
  for (std::int64_t v = 0; v < arguments.variants; ++v) {
    const std::string setting = fmt::format("controller.horizon={}", 5 + v);
    campaign.variants.push_back({.name = setting,
                                 .scenario = "dubins_corridor",
                                 .settings = setting,
                                 .overrides = {setting},
                                 .plant = "",
                                 .resolved = load_scenario("dubins_corridor", {setting})});
  }
  campaign.seeds.count = std::max<std::int64_t>(1, arguments.episodes / arguments.variants);
  return campaign;
}

/// Numbers in (0, 1] that depend only on variant and seed.
class MadeNumbers {
 public:
  MadeNumbers(std::int64_t variant, std::uint64_t seed) : words_(kWords) {
    models::random_words({.seed = static_cast<std::uint64_t>(variant),
                          .episode = seed,
                          .stream = models::RandomStream::kSearch},
                         words_);
  }
  double next() {
    const std::uint64_t word = words_[next_++ % kWords];
    return (static_cast<double>(word >> 11U) + 1.0) * 0x1p-53;
  }

 private:
  static constexpr std::size_t kWords = 256;
  std::vector<std::uint64_t> words_;
  std::size_t next_ = 0;
};

std::vector<PeriodRow> made_periods(MadeNumbers& own, std::int64_t count, bool unsafe) {
  std::vector<PeriodRow> periods;
  for (std::int64_t k = 0; k < count; ++k) {
    const double certified = std::pow(10.0, -12.0 * own.next());
    periods.push_back({.certified = certified,
                       .published = certified * own.next(),
                       .unsafe = unsafe && k + 1 == count,
                       .ocp_ms = std::round(1e6 * (2.0 - 3.0 * std::log(own.next()))) * 1e-6});
  }
  return periods;
}

EpisodeRow made_row(std::int64_t variant, std::uint64_t seed, std::int64_t periods) {
  constexpr double kUnsafeShare = 0.01;
  constexpr double kFaultShare = 0.001;
  MadeNumbers shared(-1, seed);
  MadeNumbers own(variant, seed);
  const double luck = shared.next();
  const double chance = 0.5 * (luck + own.next());
  const bool unsafe = own.next() < kUnsafeShare;
  const bool fault = !unsafe && own.next() < kFaultShare;
  EpisodeRow row{.variant = variant,
                 .seed = seed,
                 .outcome = unsafe  ? "collision"
                            : fault ? "fault"
                                    : "reached",
                 .fault = fault ? "made up" : "",
                 .steps = static_cast<int>(periods),
                 .unsafe = unsafe,
                 .min_clearance = unsafe ? -0.1 * chance : chance,
                 .cost = 1000.0 + 100.0 * luck + 10.0 * static_cast<double>(variant) + chance,
                 .next_step_max = 1e-3 * chance,
                 .next_step_sum = 1e-2 * chance,
                 .horizon_max = 0.1 * chance,
                 .thesis_max = 0.2 * chance,
                 .iterations_median = std::floor(20.0 * chance),
                 .fallbacks = 0,
                 .risk_exceeded = 0,
                 .version = kVersion,
                 .timing = {.finished_at = 1.7e9 + static_cast<double>(seed),
                            .wall_ms = 500.0 * chance,
                            .deadline_misses = 0},
                 .periods = made_periods(own, periods, unsafe)};
  if (!unsafe && !fault) row.time_to_target = 0.1 * static_cast<double>(periods);
  for (int k = 0; k < 40; ++k) {
    row.path.push_back({.x = std::round(1e5 * (0.25 * k + 0.3 * own.next())) * 1e-5,
                        .y = std::round(1e5 * (0.2 * k + 0.3 * own.next())) * 1e-5});
  }
  return row;
}

/// Makes store `shard.index` of `shard.count` in `folder`.
void make_store(const Campaign& campaign, const ScaleArguments& arguments, const Shard& shard,
                const std::string& folder) {
  fs::create_directories(folder);
  const std::vector<std::string> digests(campaign.variants.size());
  {
    const Store store(folder, stored_campaign(campaign, shard), stored_variants(campaign, digests),
                      campaign.seeds, false);
  }
  // Many episodes per transaction: writing is not what is measured.
  SQLite::Database database(folder + "/" + kStoreFile, SQLite::OPEN_READWRITE);
  database.exec("PRAGMA journal_mode = DELETE; PRAGMA synchronous = OFF");
  SQLite::Transaction transaction(database);
  EpisodeWriter writer(database);
  for (std::int64_t i = shard.index - 1; i < campaign.seeds.size(); i += shard.count) {
    for (std::int64_t v = 0; v < std::ssize(campaign.variants); ++v) {
      writer.add(made_row(v, campaign.seeds.at(i), arguments.periods));
    }
  }
  transaction.commit();
}

std::vector<std::string> make_stores(const ScaleArguments& arguments) {
  const Campaign campaign = campaign_of(arguments);
  std::vector<std::string> folders;
  for (std::int64_t n = 1; n <= arguments.stores; ++n) {
    folders.push_back(fmt::format("{}/stores/{:04}", arguments.out, n));
    make_store(campaign, arguments, {.index = n, .count = arguments.stores}, folders.back());
  }
  return folders;
}

double cpu_seconds(const rusage& usage) {
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// Runs a stage, prints its time and memory and returns the seconds.
double stage(const char* name, const std::function<void()>& work) {
  rusage before{};
  rusage after{};
  getrusage(RUSAGE_SELF, &before);
  const auto start = Clock::now();
  work();
  const std::chrono::duration<double> taken = Clock::now() - start;
  getrusage(RUSAGE_SELF, &after);
  fmt::print("{:<28}{:>9.1f} s{:>9.1f} s CPU{:>9.0f} MB\n", name, taken.count(),
             cpu_seconds(after) - cpu_seconds(before),
             static_cast<double>(after.ru_maxrss) / kKibibytesInMebibyte);
  std::fflush(stdout);
  return taken.count();
}

/// Returns whether the requirement is met.
bool measure(const std::vector<std::string>& folders, const std::string& merged) {
  double seconds = stage("merge, checksums", [&] { (void)merge_shards(folders, merged); });
  const StoreReader store(merged);
  CampaignStatistics statistics;
  seconds += stage("statistics", [&] { statistics = campaign_statistics(store); });
  seconds += stage("episodes.csv", [&] { write_episodes_csv(store, merged + "/episodes.csv"); });
  seconds += stage("figures", [&] {
    for (const CampaignFigure& figure : campaign_figures(statistics)) {
      write_file(merged + "/" + figure.file, svg_figure(figure.charts));
    }
  });
  seconds += stage("worst episodes, page", [&] {
    std::vector<ListedEpisode> worst;
    for (const EpisodeRow& row : worst_episodes(store, 10)) worst.push_back({.row = row});
    write_file(merged + "/report.html", campaign_page(statistics, worst));
  });
  seconds += stage("campaign.json",
                   [&] { write_file(merged + "/campaign.json", campaign_json(statistics)); });
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const double megabytes = static_cast<double>(usage.ru_maxrss) / kKibibytesInMebibyte;
  fmt::print(
      "{} episodes from merge to page: {:.1f} s (at most {:.0f}), {:.0f} MB (at most {:.0f})\n",
      statistics.done, seconds, kMostSeconds, megabytes, kMostMegabytes);
  return seconds <= kMostSeconds && megabytes <= kMostMegabytes;
}

bool run_scale(const ScaleArguments& arguments) {
  std::vector<std::string> folders;
  (void)stage("making the stores", [&] { folders = make_stores(arguments); });
  return arguments.make_only || measure(folders, arguments.out + "/merged");
}

/// A temporary folder, removed on destruction.
class OwnFolder {
 public:
  OwnFolder()
      : path_((fs::temp_directory_path() / fmt::format("campaign_scale_{}", ::getpid())).string()) {
    fs::create_directories(path_);
  }
  ~OwnFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  OwnFolder(const OwnFolder&) = delete;
  OwnFolder& operator=(const OwnFolder&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace
}  // namespace qsmpc::harness

int main(int argc, char** argv) {
  CLI::App app{"Time and memory for the statistics of a large campaign."};
  qsmpc::harness::ScaleArguments arguments;
  app.add_option("--episodes", arguments.episodes, "episodes over all variants")
      ->check(CLI::PositiveNumber);
  app.add_option("--variants", arguments.variants)->check(CLI::Range(1, 500));
  app.add_option("--periods", arguments.periods, "periods per episode")->check(CLI::Range(1, 1000));
  app.add_option("--stores", arguments.stores)->check(CLI::Range(1, 100000));
  app.add_option("--out", arguments.out, "a new folder, which is kept; default: a temporary one");
  app.add_flag("--make-only", arguments.make_only, "make the stores without measuring");
  CLI11_PARSE(app, argc, argv);
  if (!arguments.out.empty() && std::filesystem::exists(arguments.out)) {
    fmt::print(stderr, "campaign_scale: {} already exists\n", arguments.out);
    return 2;
  }
  std::optional<qsmpc::harness::OwnFolder> own;
  if (arguments.out.empty()) arguments.out = own.emplace().path();
  return qsmpc::harness::run_scale(arguments) ? 0 : 1;
}
