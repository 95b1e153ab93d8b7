#include "tests/integration/campaign_fixture.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/mount.h>

#include "harness/campaign/store/store_reader.hpp"

namespace qsmpc::testing {
namespace {

namespace fs = std::filesystem;

std::string row_text(const harness::EpisodeRow& row) {
  return fmt::format("{} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {}", row.variant,
                     row.seed, row.outcome, row.fault, row.steps, row.time_to_target.value_or(-1.0),
                     row.unsafe, row.min_clearance, row.cost, row.next_step_max, row.next_step_sum,
                     row.horizon_max, row.thesis_max, row.iterations_median, row.fallbacks,
                     row.risk_exceeded.value_or(-1), row.believed_max.value_or(-1.0),
                     row.believed_sum.value_or(-1.0), row.trace);
}

/// All wall-clock values are under this key.
void strip_timings(nlohmann::ordered_json& json) {
  if (json.is_object()) json.erase("ocp_ms");
  for (auto& item : json) {
    if (item.is_structured()) strip_timings(item);
  }
}

bool is_timing(const std::string& column) {
  return column.find("_ms") != std::string::npos || column == "finished_at" ||
         column == "deadline_misses";
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (c == ',' && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

std::string without_timings(const std::string& csv) {
  std::istringstream lines(csv);
  std::string line;
  std::vector<std::string> columns;
  std::string text;
  while (std::getline(lines, line)) {
    const std::vector<std::string> cells = cells_of(line);
    if (columns.empty()) columns = cells;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (!is_timing(columns.at(i))) text += cells[i] + ",";
    }
    text += "\n";
  }
  return text;
}

}  // namespace

std::string short_campaign(const TemporaryFolder& folder, int seeds, const std::string& extra) {
  return folder.file("short.yaml", fmt::format("name: short\n"
                                               "scenario: dubins_corridor\n"
                                               "variants:\n"
                                               "  closed: {{}}\n"
                                               "  open: {{controller.policy: open_loop}}\n"
                                               "grid: {{limit.steps: [6]}}\n"
                                               "seeds: {{first: 3, count: {}}}\n"
                                               "{}",
                                               seeds, extra));
}

std::vector<std::string> rows_of(const std::string& folder) {
  const harness::StoreReader store(folder);
  std::vector<std::string> rows;
  for (const harness::StoredVariant& variant : store.variants()) {
    rows.push_back(variant.name + " " + variant.scenario_text);
    store.for_each_episode(variant.id,
                           [&](const harness::EpisodeRow& row) { rows.push_back(row_text(row)); });
    store.for_each_period(
        variant.id, [&](std::uint64_t seed, std::int64_t period, const harness::PeriodRow& row) {
          rows.push_back(fmt::format("{} {} {} {} {}", seed, period, row.certified, row.published,
                                     row.unsafe));
        });
    store.for_each_path(variant.id, std::numeric_limits<std::int64_t>::max(),
                        [&](const std::string& outcome, const auto& path) {
                          std::string points;
                          for (const auto& [x, y] : path) points += fmt::format(" {} {}", x, y);
                          rows.push_back(outcome + points);
                        });
  }
  return rows;
}

std::string json_without_timings(const std::string& path) {
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(read_text(path));
  strip_timings(json);
  return json.dump(1);
}

std::string results_of(const std::string& folder) {
  std::string results = json_without_timings(folder + "/campaign.json");
  for (const std::string& name : files_below(folder, ".csv")) {
    results += name + "\n" + without_timings(read_text(folder + "/" + name));
  }
  return results;
}

std::vector<std::string> files_below(const std::string& folder, const std::string& ending) {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = fs::relative(entry.path(), folder).string();
    if (entry.is_regular_file() && name.ends_with(ending)) names.push_back(name);
  }
  std::ranges::sort(names);
  return names;
}

SmallDisk::SmallDisk(std::string path, int kilobytes)
    : path_(std::move(path)), kilobytes_(kilobytes) {
  fs::create_directories(path_);
  mounted_ =
      mount("none", path_.c_str(), "tmpfs", 0, fmt::format("size={}k", kilobytes).c_str()) == 0;
}

SmallDisk::~SmallDisk() {
  if (mounted_) umount2(path_.c_str(), MNT_DETACH);
}

ProcessOptions SmallDisk::when_small() const {
  ProcessOptions options;
  if (!mounted_) options.file_size_limit = 600L * kilobytes_;
  return options;
}

void SmallDisk::grow() const {
  if (mounted_) {
    ASSERT_EQ(mount("none", path_.c_str(), "tmpfs", MS_REMOUNT, "size=64m"), 0);
  }
}

}  // namespace qsmpc::testing
