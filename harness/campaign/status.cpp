#include "harness/campaign/status.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/text/json_text.hpp"
#include "harness/text/printable.hpp"
#include "harness/trace/ending.hpp"

namespace qsmpc::harness {
namespace {

constexpr double kWindow = 60.0;  // s, averaging window of the rate

std::string outcomes_text(const std::map<std::string, std::int64_t>& outcomes) {
  std::string text;
  for (const auto& [outcome, count] : in_order(outcomes)) {
    if (count == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", printable(outcome), count);
  }
  return text;
}

/// ", 5 min 0 s left"; with "at most" if a rule may stop the campaign before its last seed.
std::string time_left_text(const CampaignStatus& status) {
  if (!status.left) return {};
  const bool may_stop = status.campaign.until && !status.campaign.stopped_after;
  return fmt::format(", {}{} left", may_stop ? "at most " : "", duration_text(*status.left));
}

}  // namespace

CampaignStatus campaign_status(const std::string& folder) {
  const StoreReader store(folder);
  CampaignStatus status{.campaign = store.campaign(), .outcomes = store.outcomes()};
  for (const auto& [outcome, count] : status.outcomes) status.done += count;
  status.running = lock_holder(folder);
  if (!status.running) return status;
  const auto now = static_cast<double>(std::time(nullptr));
  const double window = std::clamp(now - static_cast<double>(status.running->since), 1.0, kWindow);
  status.rate = static_cast<double>(store.finished_since(now - window)) / window;
  if (status.rate > 0.0) {
    status.left = static_cast<double>(status.campaign.episodes - status.done) / status.rate;
  }
  return status;
}

std::string done_text(const CampaignStatus& status) {
  const StoredCampaign& campaign = status.campaign;
  std::string text = printable(campaign.name);
  if (campaign.shard.count > 1) {
    text += fmt::format(", shard {}/{}", campaign.shard.index, campaign.shard.count);
  }
  text += fmt::format("\n  done      {} of {}", status.done, campaign.episodes);
  if (campaign.episodes > 0) {
    text += fmt::format(" ({:.1f} %)", 100.0 * static_cast<double>(status.done) /
                                           static_cast<double>(campaign.episodes));
  }
  return text + fmt::format("\n  outcomes  {}\n", outcomes_text(status.outcomes));
}

std::string rate_text(const CampaignStatus& status) {
  return fmt::format("  rate      {:.3g} episodes/s{}\n", status.rate, time_left_text(status));
}

std::string status_table(const CampaignStatus& status) {
  std::string text = done_text(status);
  if (status.running) {
    text += fmt::format("  running   process {} on {}, since {}\n", status.running->process,
                        printable(status.running->host), utc_text(status.running->since));
    text += rate_text(status);
  } else {
    text += "  running   no\n";
  }
  return text;
}

std::string status_json(const CampaignStatus& status) {
  nlohmann::ordered_json json;
  const Shard& shard = status.campaign.shard;
  json["name"] = status.campaign.name;
  json["shard"] = {shard.index, shard.count};
  json["episodes"] = status.campaign.episodes;
  json["done"] = status.done;
  json["outcomes"] = status.outcomes;
  json["running"] = nullptr;
  if (status.running) {
    json["running"] = {{"process", status.running->process},
                       {"host", status.running->host},
                       {"since", utc_text(status.running->since)}};
  }
  json["rate"] = status.rate;
  json["left"] = nullptr;
  if (status.left) json["left"] = *status.left;
  return json_text(json);
}

std::string progress_note(const CampaignProgress& progress) {
  std::string note;
  if (progress.fresh > 0 && progress.elapsed > 0.0) {
    const double rate = static_cast<double>(progress.fresh) / progress.elapsed;
    note = fmt::format("{:.3g} episodes/s, ", rate);
    if (progress.done < progress.total) {
      note += duration_text(static_cast<double>(progress.total - progress.done) / rate) + " left, ";
    }
  }
  return note + outcomes_text(progress.outcomes);
}

std::string duration_text(double seconds) {
  constexpr double kMinute = 60.0;
  constexpr double kHour = 3600.0;
  constexpr double kDay = 86400.0;
  const double whole = std::round(seconds);
  if (seconds < 1.0) return fmt::format("{:.0f} ms", 1e3 * seconds);
  const auto two = [whole](double large, const char* name, double small, const char* rest) {
    return fmt::format("{:.0f} {} {:.0f} {}", std::floor(whole / large), name,
                       std::floor(std::fmod(whole, large) / small), rest);
  };
  if (whole < kMinute) return fmt::format("{:.0f} s", whole);
  if (whole < kHour) return two(kMinute, "min", 1.0, "s");
  if (whole < kDay) return two(kHour, "h", kMinute, "min");
  return two(kDay, "d", kHour, "h");
}

}  // namespace qsmpc::harness
