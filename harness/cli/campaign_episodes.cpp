#include "harness/cli/campaign_episodes.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>

#include <fmt/format.h>

#include "harness/campaign/statistics/worst_episodes.hpp"
#include "harness/campaign/store/folder_lock.hpp"
#include "harness/campaign/store/store_schema.hpp"
#include "harness/cli/artefacts.hpp"
#include "harness/cli/interrupt.hpp"
#include "harness/cli/progress.hpp"
#include "harness/episode/episode.hpp"
#include "harness/errors.hpp"
#include "harness/files/atomic_file.hpp"
#include "harness/files/text_file.hpp"
#include "harness/plant/plant_registry.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/trace/ending.hpp"
#include "harness/trace/hdf5_file.hpp"
#include "harness/trace/trace_file.hpp"
#include "harness/video/episode_painter.hpp"

namespace qsmpc::harness {
namespace {

constexpr const char* kVariantFolder = "variants";

const StoredVariant& variant_of(const StoreReader& store, const EpisodeRow& row) {
  return *std::ranges::find(store.variants(), row.variant, &StoredVariant::id);
}

/// The scenario of a variant as stored. `with_files`: it is refused if its vehicle's file is not
/// found.
Scenario scenario_of(const StoredVariant& variant, const std::string& folder, bool with_files) {
  return parse_scenario(variant.scenario_text,
                        {.file = folder + "/" + kStoreFile + ", variant " + variant.name,
                         .folder = folder,
                         .files_must_exist = with_files,
                         .is_recorded = true});
}

/// A scenario as text, without the seed, which does not affect an episode of a given seed.
std::string without_seed(Scenario scenario) {
  scenario.seed = 0;
  return to_yaml(scenario);
}

/// Whether the trace at `path` is of this episode: another one may have been left there before the
/// campaign changed. An unreadable trace does not count.
bool is_trace_of(const std::string& path, const EpisodeRow& row, const StoredVariant& variant,
                 const std::string& folder) {
  if (!is_file(path)) return false;
  try {
    const Hdf5File file = Hdf5File::open(path);
    const Scenario found =
        parse_scenario(file.text("/", "scenario"), {.file = path, .files_must_exist = false});
    return file.unsigned_integer("/", "seed") == row.seed &&
           without_seed(found) == without_seed(scenario_of(variant, folder, false));
  } catch (const InputError&) {
    return false;
  }
}

/// The folder of an episode within the campaign's.
std::string folder_of(const EpisodeRow& row) {
  return row.trace.empty() ? episode_folder(row.variant, row.seed) : row.trace;
}

bool has_trace(const StoreReader& store, const EpisodeRow& row, const std::string& folder) {
  const std::string path = folder + "/" + folder_of(row) + "/" + kTraceFile;
  return row.trace.empty() ? is_trace_of(path, row, variant_of(store, row), folder) : is_file(path);
}

ListedEpisode listed(const StoreReader& store, const EpisodeRow& row, const std::string& folder) {
  ListedEpisode episode{.row = row};
  const std::string own = folder_of(row);
  if (!has_trace(store, row, folder)) {
    const std::string scenario = fmt::format("{}/{}.yaml", kVariantFolder, row.variant);
    make_output_folder(folder + "/" + kVariantFolder);
    write_file(folder + "/" + scenario, variant_of(store, row).scenario_text);
    episode.commands.push_back(
        fmt::format("qsmpc run {} --seed {} --out {}", scenario, row.seed, own));
    return episode;
  }
  episode.trace = own + "/" + kTraceFile;
  const auto list = [&](const char* file, const char* command, std::string& path) {
    if (is_file(folder + "/" + own + "/" + file)) {
      path = own + "/" + file;
    } else {
      episode.commands.push_back(fmt::format("qsmpc {} {}", command, own));
    }
  };
  list(kVideoFile, "render", episode.video);
  list(kPageFile, "report", episode.page);
  return episode;
}

/// Reports if an episode did not end as it did in the campaign.
void compare_with_store(const EpisodeView& view, const EpisodeRow& stored) {
  const EpisodeRow now = episode_row(view, stored.variant);
  const auto same = [](double one, double other) {
    return one == other || (std::isnan(one) && std::isnan(other));
  };
  // A former outcome name only says that the drive was unsafe.
  const bool same_end =
      now.outcome == stored.outcome || (stored.outcome == kLeftSafeSet && now.unsafe);
  if (same_end && now.steps == stored.steps && now.unsafe == stored.unsafe &&
      same(now.cost, stored.cost) && same(now.min_clearance, stored.min_clearance)) {
    return;
  }
  std::cerr << fmt::format(
      "qsmpc: variant {}, seed {}: driven again by version {}, it ends as {} after {} steps; in "
      "the campaign, version {} ended as {} after {} steps\n",
      stored.variant + 1, stored.seed, now.version, now.outcome, now.steps, stored.version,
      stored.outcome, stored.steps);
}

/// Drives an episode whose trace was not kept, and keeps its trace; returns nothing if interrupted.
std::optional<Trace> drive_again(const StoredVariant& variant, const EpisodeRow& row,
                                 const std::string& folder, bool quiet) {
  const Scenario scenario = scenario_of(variant, folder, true);
  if (plant_digest(scenario) != variant.plant_digest) {
    throw InputError({.file = folder + "/" + kStoreFile,
                      .key = "variant " + variant.name,
                      .found = "a vehicle that has changed since the campaign",
                      .expected = "the vehicle that the campaign drove"});
  }
  Progress progress("driving", quiet);
  EpisodeOptions options;
  options.seed = row.seed;
  options.should_stop = [] { return interrupts() > 0; };
  options.on_step = [&](const Trace& trace) {
    progress.update(static_cast<std::int64_t>(trace.steps.size()), scenario.step_limit);
  };
  Trace trace = run_episode(scenario, options);
  if (trace.outcome == Outcome::kInterrupted) return std::nullopt;
  const std::string target = folder + "/" + episode_folder(row.variant, row.seed);
  make_durable_folder(target, folder);
  discard_artefacts(target);
  write_trace(target + "/" + kTraceFile, trace);
  return trace;
}

/// Makes summary, page and video of an episode in the folder `target`. `has_drawn`: whether a video
/// was drawn before, so that there is enough memory to draw.
void make_artefacts(const EpisodeView& view, const std::string& target, bool quiet,
                    bool& has_drawn) {
  bool with_video = is_file(target + "/" + kVideoFile);
  const std::string no_video = why_not_drawn(view);
  if (!no_video.empty()) {
    std::cerr << "qsmpc: no video: " << no_video << '\n';
  } else if (!with_video && !view.trace().steps.empty()) {
    if (!has_drawn) refuse_without_memory_to_draw(video_options(view.scenario()));
    has_drawn = true;
    make_video(view,
               {.video = target + "/" + kVideoFile, .numbers = target + "/" + kVideoNumbersFile},
               video_options(view.scenario()), {.quiet = quiet});
    with_video = true;
  }
  write_summary(view, target, with_video);
  write_page(view, target, with_video);
}

}  // namespace

std::vector<ListedEpisode> worst_with_files(const StoreReader& store, const std::string& folder,
                                            std::size_t count) {
  std::vector<ListedEpisode> episodes;
  for (const EpisodeRow& row : worst_episodes(store, count)) {
    episodes.push_back(listed(store, row, folder));
  }
  return episodes;
}

bool make_worst_episodes(const std::string& folder, std::size_t count, bool quiet) {
  const StoreReader store(folder);
  const FolderLock lock(folder);
  const std::vector<EpisodeRow> worst = worst_episodes(store, count);
  bool has_drawn = false;
  for (std::size_t n = 0; n < worst.size(); ++n) {
    const EpisodeRow& row = worst[n];
    if (interrupts() > 0) return false;
    if (!quiet) {
      std::cerr << fmt::format("qsmpc: episode {} of {}: variant {}, seed {}\n", n + 1,
                               worst.size(), row.variant, row.seed);
    }
    const std::string target = folder + "/" + folder_of(row);
    const bool kept = has_trace(store, row, folder);
    const std::optional<Trace> trace =
        kept ? read_folder(target) : drive_again(variant_of(store, row), row, folder, quiet);
    if (!trace) return false;
    const EpisodeView view(*trace);
    if (!kept) compare_with_store(view, row);
    make_artefacts(view, target, quiet, has_drawn);
  }
  return interrupts() == 0;
}

}  // namespace qsmpc::harness
