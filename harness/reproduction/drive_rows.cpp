#include "harness/reproduction/drive_rows.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/statistics/sample_statistics.hpp"

namespace qsmpc::harness {
namespace {

/// `samples` without the seeds for which one of them has no number: a drive that ended before its
/// first period has none.
std::vector<std::vector<double>> complete(const std::vector<std::vector<double>>& samples) {
  std::vector<std::vector<double>> kept(samples.size());
  for (std::size_t n = 0; n < samples.front().size(); ++n) {
    const bool finite = std::ranges::all_of(
        samples, [n](const std::vector<double>& sample) { return std::isfinite(sample[n]); });
    if (!finite) continue;
    for (std::size_t s = 0; s < samples.size(); ++s) kept[s].push_back(samples[s][n]);
  }
  return kept;
}

std::vector<double> differences(const std::vector<double>& first,
                                const std::vector<double>& second) {
  std::vector<double> result;
  for (std::size_t n = 0; n < first.size(); ++n) result.push_back(first[n] - second[n]);
  return result;
}

/// The median over the episodes that have the number.
double median_of_episodes(const std::vector<double>& numbers) {
  return median_of(complete({numbers}).front());
}

}  // namespace

std::vector<double> arrival_times(const Sample& sample) {
  std::vector<double> times;
  for (const EpisodeDigest& episode : sample.episodes) {
    if (episode.arrived) times.push_back(episode.duration);
  }
  return times;
}

std::vector<double> seconds_a_plan(const Sample& sample) {
  return over_episodes(sample, [](const EpisodeDigest& episode) {
    return episode.optimisation_s / static_cast<double>(episode.inputs.cols());
  });
}

double median_plan_seconds(const Sample& sample) {
  return median_of_episodes(seconds_a_plan(sample));
}

std::vector<double> largest_by_episode(const Sample& sample, EpisodeSeries series) {
  return over_episodes(sample,
                       [&](const EpisodeDigest& episode) { return largest_of(episode.*series); });
}

std::vector<double> mean_by_episode(const Sample& sample, EpisodeSeries series) {
  return over_episodes(sample,
                       [&](const EpisodeDigest& episode) { return mean_of(episode.*series); });
}

std::string share_text(int count, std::size_t total) {
  return fmt::format("{} of {} ({:.0f} %)", count, total,
                     100.0 * count / static_cast<double>(total));
}

void add_drive_rows(const PublishedDrive& column, const Sample& sample, ExperimentResult& result) {
  const std::vector<double> arrivals = arrival_times(sample);
  const auto row = [&](const std::string& what, const std::string& unit,
                       std::optional<double> published, double here, const std::string& note = {}) {
    result.rows.push_back({.quantity = column.name + ": " + what,
                           .unit = unit,
                           .published = published,
                           .here = here,
                           .note = note,
                           .place = TablePlace{.table = "", .row = what, .column = column.name}});
  };
  row("target reached in", "s", column.reached_s, median_of(arrivals),
      fmt::format("median of the {} drives that reached it", arrivals.size()));
  row("optimisation time of a drive", "s", column.optimisation_s,
      median_of_episodes(over_episodes(
          sample, [](const EpisodeDigest& episode) { return episode.optimisation_s; })));
  row("largest P(unsafe) of a next step, the published way", "", column.unsafe,
      median_of_episodes(largest_by_episode(sample, &EpisodeDigest::published)),
      "Algorithms 3 and 4 as printed: not a bound");
  row("largest P(unsafe) of a next step, C1", "", std::nullopt,
      median_of_episodes(largest_by_episode(sample, &EpisodeDigest::particles)),
      "the published method, made sound");
  row("largest P(unsafe) of a next step, certified", "", std::nullopt,
      median_of_episodes(largest_by_episode(sample, &EpisodeDigest::next_step)),
      "a bound, the smallest known");
  row("drives that arrive and are never unsafe", "", std::nullopt,
      safe_arrivals(sample) / static_cast<double>(sample.episodes.size()),
      share_text(safe_arrivals(sample), sample.episodes.size()));
}

Claim less_on_average(std::string statement, const std::vector<double>& first,
                      const std::vector<double>& second) {
  const std::vector<std::vector<double>> pairs = complete({first, second});
  const std::vector<double> gain = differences(pairs[0], pairs[1]);
  return {.statement = std::move(statement),
          .holds = mean_of(gain) < 0.0,
          .evidence = fmt::format("{:.3g} against {:.3g}; difference {:.2g} ± {:.1g} over {} seeds",
                                  mean_of(pairs[0]), mean_of(pairs[1]), mean_of(gain),
                                  standard_error_of(gain), gain.size())};
}

Claim falls_within_noise(std::string statement, const std::vector<std::vector<double>>& all) {
  const std::vector<std::vector<double>> samples = complete(all);
  Claim claim{.statement = std::move(statement), .holds = true};
  std::vector<std::string> means;
  for (std::size_t n = 0; n < samples.size(); ++n) {
    means.push_back(
        fmt::format("{:.3g} ± {:.1g}", mean_of(samples[n]), standard_error_of(samples[n])));
    if (n == 0) continue;
    const std::vector<double> rise = differences(samples[n], samples[n - 1]);
    if (!(mean_of(rise) <= 2.0 * standard_error_of(rise))) claim.holds = false;
  }
  claim.evidence =
      fmt::format("means over {} seeds: {}", samples.front().size(), fmt::join(means, ", "));
  return claim;
}

void add_points_claims(const std::string& solver, const std::vector<const Sample*>& samples,
                       ExperimentResult& result) {
  const auto claim = [&](const char* what, EpisodeSeries series) {
    std::vector<std::vector<double>> means;
    means.reserve(samples.size());
    for (const Sample* sample : samples) means.push_back(mean_by_episode(*sample, series));
    result.claims.push_back(falls_within_noise(
        fmt::format("More points lower {} ({}, mean along a drive)", what, solver), means));
  };
  claim("the published P(unsafe)", &EpisodeDigest::published);
  claim("the sound bound from the points, C1", &EpisodeDigest::particles);
  claim("the certificate in force", &EpisodeDigest::next_step);
}

}  // namespace qsmpc::harness
