// Rows and claims about closed-loop drives, shared by several experiments.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/reproduction/laboratory.hpp"
#include "harness/reproduction/result.hpp"

namespace qsmpc::harness {

/// One column of a table of the thesis: a drive and its published numbers.
struct PublishedDrive {
  std::string name;  ///< e.g. "open loop"
  Variant variant;
  std::optional<double> reached_s{};       ///< "target reached in"
  std::optional<double> optimisation_s{};  ///< "optimisation time", for the whole drive
  std::optional<double> unsafe{};          ///< "max P", computed as published
};

/// The times of the drives that reached the target, s.
[[nodiscard]] std::vector<double> arrival_times(const Sample& sample);

/// Wall-clock time of one plan, s: for each episode the mean over its periods. NaN for an episode
/// that ended before its first period, here and below.
[[nodiscard]] std::vector<double> seconds_a_plan(const Sample& sample);
/// The median of seconds_a_plan.
[[nodiscard]] double median_plan_seconds(const Sample& sample);

/// For each episode, the largest value of a series, and its mean.
using EpisodeSeries = std::vector<double> EpisodeDigest::*;
[[nodiscard]] std::vector<double> largest_by_episode(const Sample& sample, EpisodeSeries series);
[[nodiscard]] std::vector<double> mean_by_episode(const Sample& sample, EpisodeSeries series);

/// Adds time to the target, optimisation time, P(unsafe) as published and as valid bounds, and the
/// number of safe drives. Values are medians over the episodes of `sample`.
void add_drive_rows(const PublishedDrive& column, const Sample& sample, ExperimentResult& result);

/// "k of n (p %)".
[[nodiscard]] std::string share_text(int count, std::size_t total);

/// Claims leave out the seeds for which one side has no number.

/// The claim that `first` is less than `second`, compared by episodes of the same seed: their mean
/// difference is below 0. Evidence: both means, the difference and its standard error.
[[nodiscard]] Claim less_on_average(std::string statement, const std::vector<double>& first,
                                    const std::vector<double>& second);

/// Adds the claims that more points tighten the published value, C1 and the certificate in force.
/// `samples` are of the same scenario with increasing numbers of points.
void add_points_claims(const std::string& solver, const std::vector<const Sample*>& samples,
                       ExperimentResult& result);

/// The claim that the means of `all` (equally many numbers each, of the same seeds) decrease from
/// each to the next, up to two standard errors of their difference.
[[nodiscard]] Claim falls_within_noise(std::string statement,
                                       const std::vector<std::vector<double>>& all);

}  // namespace qsmpc::harness
