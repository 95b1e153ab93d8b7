// Rows and claims about drives in closed loop that several experiments share.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/reproduction/laboratory.hpp"
#include "harness/reproduction/result.hpp"

namespace qsmpc::harness {

/// One column of a table of the thesis: a drive and what is published of it.
struct PublishedDrive {
  std::string name;  ///< e.g. "open loop"
  Variant variant;
  std::optional<double> reached_s{};       ///< "target reached in"
  std::optional<double> optimisation_s{};  ///< "optimisation time", of the whole drive
  std::optional<double> unsafe{};          ///< "max P", the published way
};

/// The times of the drives that reached the target, s.
[[nodiscard]] std::vector<double> arrival_times(const Sample& sample);

/// Wall clock of one plan, s: of each episode the mean over its periods; not a number where it
/// ended before the first, as in what follows.
[[nodiscard]] std::vector<double> seconds_a_plan(const Sample& sample);
/// The median of these.
[[nodiscard]] double median_plan_seconds(const Sample& sample);

/// The greatest of a series of each episode, and its mean.
using EpisodeSeries = std::vector<double> EpisodeDigest::*;
[[nodiscard]] std::vector<double> largest_by_episode(const Sample& sample, EpisodeSeries series);
[[nodiscard]] std::vector<double> mean_by_episode(const Sample& sample, EpisodeSeries series);

/// Time to the target, optimisation time, P(unsafe) the published way and as bounds that hold, and
/// how many drives were safe: medians over the episodes of `sample`.
void add_drive_rows(const PublishedDrive& column, const Sample& sample, ExperimentResult& result);

/// "k of n (p %)".
[[nodiscard]] std::string share_text(int count, std::size_t total);

/// Claims leave out the seeds of which one side has no number.

/// The claim that what `first` numbers is less than `second`, episode by episode of the same seed:
/// their mean difference is below 0. Evidence: both means, the difference and its standard error.
[[nodiscard]] Claim less_on_average(std::string statement, const std::vector<double>& first,
                                    const std::vector<double>& second);

/// The claims that more points tighten what is published, C1 and the certificate in force: samples
/// of the same scenario with more and more points.
void add_points_claims(const std::string& solver, const std::vector<const Sample*>& samples,
                       ExperimentResult& result);

/// The claim that the means of `all` (each as many numbers, of the same seeds) fall from each
/// to the next, but for two standard errors of their difference.
[[nodiscard]] Claim falls_within_noise(std::string statement,
                                       const std::vector<std::vector<double>>& all);

}  // namespace qsmpc::harness
