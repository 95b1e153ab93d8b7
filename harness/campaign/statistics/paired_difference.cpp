#include "harness/campaign/statistics/paired_difference.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "models/constants.hpp"
#include "models/random/random_numbers.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::uint64_t kBootstrapSeed = 0;  // arbitrary but fixed: it has its own random stream
constexpr int kDrawsPerWord = 4;             // of 16 bits each
constexpr int kDrawBits = 16;

/// Thresholds for 16-bit draws: a draw at or above threshold k gives a weight above k. Threshold k
/// is 65536 P(X ≤ k), rounded, with X ~ Poisson(1). Weights of 9 or more have probability 1.1e-6,
/// below the resolution of a draw; the weights drawn have mean 1 and variance 0.99997.
constexpr std::array<std::uint32_t, 8> kThresholds = {24109, 48219, 60273, 64292,
                                                      65296, 65497, 65531, 65535};

double weight_of(std::uint32_t draw) {
  int weight = 0;
  for (const std::uint32_t threshold : kThresholds) weight += draw >= threshold ? 1 : 0;
  return weight;
}

using Value = std::optional<double> (*)(const EpisodeRow& row);

bool faulted(const EpisodeRow& row) { return row.outcome == outcome_name(Outcome::kFault); }

std::optional<double> unless_faulted(const EpisodeRow& row, double value) {
  if (faulted(row) || !std::isfinite(value)) return std::nullopt;
  return value;
}

struct NamedValue {
  const char* name;
  Value value;
};

const std::array<NamedValue, 6>& values() {
  static const std::array<NamedValue, 6> kept = {{
      {"reached",
       [](const EpisodeRow& row) -> std::optional<double> {
         return row.outcome == outcome_name(Outcome::kReached) ? 1.0 : 0.0;
       }},
      {"unsafe",
       [](const EpisodeRow& row) -> std::optional<double> { return row.unsafe ? 1.0 : 0.0; }},
      {"cost", [](const EpisodeRow& row) { return unless_faulted(row, row.cost); }},
      {"min_clearance",
       [](const EpisodeRow& row) { return unless_faulted(row, row.min_clearance); }},
      {"certified",
       [](const EpisodeRow& row) {
         return unless_faulted(row, row.steps > 0 ? row.next_step_sum / row.steps : kNotANumber);
       }},
      {"iterations",
       [](const EpisodeRow& row) { return unless_faulted(row, row.iterations_median); }},
  }};
  return kept;
}

}  // namespace

void poisson_weights(std::uint64_t seed, Eigen::ArrayXd& out) {
  static_assert(kBootstrapReplicates % kDrawsPerWord == 0);
  std::array<std::uint64_t, kBootstrapReplicates / kDrawsPerWord> words{};
  models::random_words(
      {.seed = kBootstrapSeed, .episode = seed, .stream = models::RandomStream::kBootstrap}, words);
  constexpr std::uint64_t kMask = (1U << kDrawBits) - 1U;
  out.resize(kBootstrapReplicates);
  Eigen::Index replicate = 0;
  for (const std::uint64_t word : words) {
    for (int draw = 0; draw < kDrawsPerWord; ++draw) {
      out[replicate++] = weight_of(static_cast<std::uint32_t>(word >> (kDrawBits * draw) & kMask));
    }
  }
}

void BootstrapMean::add(double value, const Eigen::ArrayXd& weights) {
  ++count_;
  sum_ += value;
  sums_ += value * weights;
  weights_ += weights;
}

double BootstrapMean::mean() const {
  return count_ == 0 ? kNotANumber : sum_ / static_cast<double>(count_);
}

RateInterval BootstrapMean::interval() const { return bootstrap_interval(count_, sums_, weights_); }

RateInterval bootstrap_interval(std::int64_t count, const Eigen::ArrayXd& sums,
                                const Eigen::ArrayXd& weights) {
  if (count < 2) return {.lower = kNotANumber, .upper = kNotANumber};
  std::vector<double> means;
  for (Eigen::Index r = 0; r < kBootstrapReplicates; ++r) {
    // With few pairs, a replicate may contain none of them; it is skipped.
    if (weights[r] > 0.0) means.push_back(sums[r] / weights[r]);
  }
  return percentile_interval(std::move(means));
}

RateInterval percentile_interval(std::vector<double> replicates) {
  if (replicates.empty()) return {.lower = kNotANumber, .upper = kNotANumber};
  std::ranges::sort(replicates);
  const auto count = static_cast<double>(replicates.size());
  const auto outside = static_cast<std::size_t>(std::ceil(kCampaignTail * count)) - 1;
  return {.lower = replicates[outside], .upper = replicates[replicates.size() - 1 - outside]};
}

const std::vector<std::string>& paired_quantities() {
  static const std::vector<std::string> kept = [] {
    std::vector<std::string> names;
    for (const NamedValue& value : values()) names.emplace_back(value.name);
    return names;
  }();
  return kept;
}

PairedDifference::PairedDifference() : quantities_(values().size()) {}

void PairedDifference::add(const EpisodeRow& baseline, const EpisodeRow& variant) {
  poisson_weights(variant.seed, weights_);
  add(baseline, variant, weights_);
}

void PairedDifference::add(const EpisodeRow& baseline, const EpisodeRow& variant,
                           const Eigen::ArrayXd& weights) {
  all_weights_ += weights;
  for (std::size_t n = 0; n < quantities_.size(); ++n) {
    Quantity& quantity = quantities_[n];
    const std::optional<double> before = values()[n].value(baseline);
    const std::optional<double> after = values()[n].value(variant);
    if (!before || !after) {
      ++quantity.left_out;
      if (quantity.left_out == 1) quantity.left_out_weights.setZero(kBootstrapReplicates);
      quantity.left_out_weights += weights;
      continue;
    }
    ++quantity.count;
    quantity.higher += *after > *before ? 1 : 0;
    quantity.lower += *after < *before ? 1 : 0;
    const double difference = *after - *before;
    if (difference == 0.0) continue;  // the usual case for shares
    quantity.sum += difference;
    quantity.sums += difference * weights;
  }
}

std::vector<MeanDifference> PairedDifference::result() const {
  std::vector<MeanDifference> differences;
  for (std::size_t n = 0; n < quantities_.size(); ++n) {
    const Quantity& quantity = quantities_[n];
    Eigen::ArrayXd weights = all_weights_;
    if (quantity.left_out > 0) weights -= quantity.left_out_weights;
    differences.push_back({.quantity = values()[n].name,
                           .pairs = quantity.count,
                           .left_out = quantity.left_out,
                           .higher = quantity.higher,
                           .lower = quantity.lower,
                           .mean = quantity.count == 0
                                       ? kNotANumber
                                       : quantity.sum / static_cast<double>(quantity.count),
                           .interval = bootstrap_interval(quantity.count, quantity.sums, weights)});
  }
  return differences;
}

}  // namespace qsmpc::harness
