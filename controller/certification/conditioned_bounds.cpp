#include "controller/certification/conditioned_bounds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include "controller/certification/first_entry.hpp"
#include "controller/certification/path_tilt.hpp"
#include "controller/certification/tilt_split.hpp"
#include "models/constants.hpp"

namespace qsmpc::controller {
namespace {

// The largest number of laws, for many plans and for one …
constexpr double kLawsForMany = 100.0;
constexpr double kLawsForOne = 2000.0;
// … and of parts of the unsafe set over all laws and stages.
constexpr double kMostParts = 2e5;
// Refinement stops if the loose bounds fall by less than this share while so many laws are added.
constexpr double kLeastFall = 0.01;
constexpr std::size_t kLawsOfAttempt = 250;
// A bound within this factor, plus this margin, of its value without any error is not improved …
constexpr double kTightEnough = 1.1;
constexpr double kSmallEnough = 1e-6;
// … nor is one whose value without any error exceeds this.
constexpr double kHopeless = 0.5;
// What a part of the unsafe set may add to a bound, relative to its value without any error, before
// long searches are made for it.
constexpr double kNegligibleShare = 0.01;
// The cores with which a law is tried, and the excess over the value without errors from which a
// narrower one may help.
constexpr std::array kCores = {kWideCore, 4.25, kNarrowCore};
constexpr double kTryNarrower = 0.003;
// Bounds below this count as this much where logarithms are compared.
constexpr double kSmallest = 1e-12;

/// Bounds under one law: of stages 1 … horizon, and of being unsafe at any stage so far.
struct LawBounds {
  Eigen::VectorXd stages;
  Eigen::VectorXd so_far;
  Eigen::VectorXd without_errors;  ///< what `stages` would be without errors; no bounds

  /// The bound of being unsafe at any stage.
  [[nodiscard]] double together() const { return so_far[so_far.size() - 1]; }
  /// About what that would be without errors: less in the ratio of the stages' sums.
  [[nodiscard]] double together_without_errors() const {
    const double sum = stages.sum();
    return sum > 0.0 ? together() * std::min(1.0, without_errors.sum() / sum) : 0.0;
  }
};

Eigen::VectorXd sums_up_to_1(const std::vector<double>& entries) {
  Eigen::VectorXd sums(static_cast<Eigen::Index>(entries.size()));
  std::partial_sum(entries.begin(), entries.end(), sums.begin());
  return sums.cwiseMin(1.0);
}

/// What is asked of a law.
struct Question {
  Eigen::VectorXd worthwhile;  ///< as for tilted_surrogate_bounds
  bool together = true;        ///< whether `so_far` is asked; else it is 1
};

LawBounds law_bounds(const UnsafeSet& unsafe, const SurrogateBounds& of, const Question& question) {
  const auto horizon = static_cast<Eigen::Index>(of.bounds.size());
  LawBounds result{.stages = Eigen::VectorXd(horizon),
                   .so_far = Eigen::VectorXd::Ones(horizon),
                   .without_errors = Eigen::VectorXd::Zero(horizon)};
  if (question.together) result.so_far = sums_up_to_1(first_entry_bounds(unsafe, of));
  for (Eigen::Index k = 0; k < horizon; ++k) {
    const auto index = static_cast<std::size_t>(k);
    result.stages[k] = of.bounds[index].smooth;
    const SurrogateStage& surrogate = of.surrogates[index + 1];
    const double worthwhile = question.worthwhile[k];
    if (worthwhile == kInfinity || surrogate.leaving >= 1.0) continue;  // its law is not known
    result.without_errors[k] =
        std::min(result.stages[k], surrogate_law_bound(unsafe, k + 1, surrogate, worthwhile));
  }
  return result;
}

/// The largest excess of what is asked over its value without errors.
double largest_excess(const LawBounds& bounds, const Question& question) {
  double largest = 0.0;
  if (question.together) largest = bounds.together() - bounds.together_without_errors();
  for (Eigen::Index k = 0; k < bounds.stages.size(); ++k) {
    if (question.worthwhile[k] == kInfinity) continue;
    largest = std::max(largest, bounds.stages[k] - bounds.without_errors[k]);
  }
  return largest;
}

/// The least bounds over ever narrower cores, as long as these may help.
LawBounds tilted_bounds(const PredictedMotion& motion, const UnsafeSet& unsafe,
                        const PathTilt& tilt, const Question& question) {
  LawBounds least;
  for (const double core : kCores) {
    const SurrogateBounds of =
        tilted_surrogate_bounds(motion, unsafe, question.worthwhile, tilt, core, run_in_turn);
    LawBounds found = law_bounds(unsafe, of, question);
    if (least.stages.size() == 0) {
      least = std::move(found);
    } else {
      least.stages = least.stages.cwiseMin(found.stages);
      least.so_far = least.so_far.cwiseMin(found.so_far);
      least.without_errors = least.without_errors.cwiseMax(found.without_errors);
    }
    const bool in_use = of.surrogates.back().leaving > 0.0;
    if (!in_use || largest_excess(least, question) < kTryNarrower) break;
  }
  return least;
}

/// A tree of laws: each is bounded by itself and, where it has been split, by its parts.
class LawTree {
 public:
  LawTree(const PredictedMotion& motion, const UnsafeSet& unsafe, const SurrogateBounds& plain,
          CertificateEffort effort, const Executor& run)
      : motion_(motion), unsafe_(unsafe), untilted_(plain.surrogates), run_(run) {
    const auto horizon = static_cast<Eigen::Index>(plain.bounds.size());
    question_.worthwhile.setConstant(horizon, kSmallEnough);
    laws_.push_back({.tilt = {}, .bounds = law_bounds(unsafe, plain, question_)});
    far_.assign(plain.bounds.size(), true);
    loose_.assign(plain.bounds.size(), true);
    find_what_is_loose();
    double parts = 0.0;
    for (const DiscView& disc : unsafe.discs()) parts += static_cast<double>(disc.regions.size());
    const double laws = effort == CertificateEffort::kTightest ? kLawsForOne : kLawsForMany;
    most_ = std::min(laws, kMostParts / (parts * static_cast<double>(horizon)));
  }

  /// Splits laws until all bounds are tight, or until the work is used up.
  void refine() {
    Eigen::VectorXd before = logarithms();
    std::size_t next_look = kLawsOfAttempt;
    while (is_loose()) {
      const std::size_t loosest = loosest_leaf();
      if (loosest == laws_.size()) return;
      split(loosest);
      find_what_is_loose();
      if (laws_.size() < next_look) continue;
      next_look += kLawsOfAttempt;
      Eigen::VectorXd now = logarithms();
      if (is_loose() && mean_over_loose(now - before) > std::log1p(-kLeastFall)) return;
      before = std::move(now);
    }
  }

  [[nodiscard]] bool has_parts() const { return laws_.size() > 1; }
  /// The bounds of the untilted law.
  [[nodiscard]] const LawBounds& bounds() const { return laws_[0].bounds; }

 private:
  struct Law {
    PathTilt tilt;
    LawBounds bounds;
    double share = 1.0;          ///< its weight in the law above
    double weight = 1.0;         ///< the product of its share and those of all laws above
    std::size_t above = 0;       ///< the law of which it is a part
    std::size_t first_part = 0;  ///< 0: it has none
    std::size_t parts = 0;
    double left_out = 0.0;
    bool is_final = false;  ///< no split of it gains anything
  };

  [[nodiscard]] bool is_leaf(const Law& law) const { return law.first_part == 0; }

  /// Which stages' bounds, and whether the bound of all together, are still far from their values
  /// without errors, and which of these are worth laws. What has become tight is not asked of
  /// further laws.
  void find_what_is_loose() {
    const LawBounds& whole = laws_[0].bounds;
    const Eigen::Index horizon = whole.stages.size();
    without_errors_.setZero(horizon);
    together_ = 0.0;
    for (const Law& law : laws_) {
      if (!is_leaf(law)) continue;
      without_errors_ += law.weight * law.bounds.without_errors;
      together_ += law.weight * law.bounds.together_without_errors();
    }
    const auto is_far = [](double bound, double without_errors) {
      return bound > kTightEnough * without_errors + kSmallEnough;
    };
    question_.together = question_.together && is_far(whole.together(), together_);
    loose_together_ = question_.together && together_ <= kHopeless;
    const double share_of_all = (together_ + kSmallEnough) / static_cast<double>(horizon);
    for (Eigen::Index k = 0; k < horizon; ++k) {
      const auto index = static_cast<std::size_t>(k);
      far_[index] = far_[index] && is_far(whole.stages[k], without_errors_[k]);
      loose_[index] = far_[index] && without_errors_[k] <= kHopeless;
      double value = kInfinity;
      if (far_[index]) value = without_errors_[k] + kSmallEnough;
      if (question_.together) value = std::min(value, share_of_all);
      question_.worthwhile[k] = kNegligibleShare * value;
    }
  }

  [[nodiscard]] bool is_loose() const {
    return loose_together_ || std::find(loose_.begin(), loose_.end(), true) != loose_.end();
  }

  /// Of the bounds of all stages, and of all together.
  [[nodiscard]] Eigen::VectorXd logarithms() const {
    const LawBounds& whole = laws_[0].bounds;
    Eigen::VectorXd result(whole.stages.size() + 1);
    result << whole.stages, whole.together();
    return result.array().max(kSmallest).log();
  }

  [[nodiscard]] double mean_over_loose(const Eigen::VectorXd& values) const {
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t k = 0; k <= loose_.size(); ++k) {
      if (!(k < loose_.size() ? loose_[k] : loose_together_)) continue;
      sum += values[static_cast<Eigen::Index>(k)];
      count += 1.0;
    }
    return sum / count;
  }

  /// What the leaf adds to all loose bounds beyond their values without errors, relative to these.
  [[nodiscard]] double excess(const Law& law) const {
    double sum = 0.0;
    for (Eigen::Index k = 0; k < without_errors_.size(); ++k) {
      if (!loose_[static_cast<std::size_t>(k)]) continue;
      sum += (law.bounds.stages[k] - law.bounds.without_errors[k]) /
             (without_errors_[k] + kSmallEnough);
    }
    if (loose_together_) {
      sum += (law.bounds.together() - law.bounds.together_without_errors()) /
             (together_ + kSmallEnough);
    }
    return law.weight * sum;
  }

  [[nodiscard]] std::size_t loosest_leaf() const {
    std::size_t loosest = laws_.size();
    double most = 0.0;
    for (std::size_t i = 0; i < laws_.size(); ++i) {
      if (!is_leaf(laws_[i]) || laws_[i].is_final) continue;
      const double excess_here = excess(laws_[i]);
      if (!(excess_here > most)) continue;
      most = excess_here;
      loosest = i;
    }
    return loosest;
  }

  void split(std::size_t index) {
    const double left = most_ - static_cast<double>(laws_.size() - 1);
    const TiltSplit split = best_split(motion_, laws_[index].tilt, untilted_, left, run_);
    if (split.parts.empty()) {
      laws_[index].is_final = true;
      return;
    }
    std::vector<LawBounds> bounds(split.parts.size());
    run_(static_cast<int>(bounds.size()), [&](int i) {
      const auto part = static_cast<std::size_t>(i);
      bounds[part] = tilted_bounds(motion_, unsafe_, split.parts[part], question_);
    });
    laws_[index].first_part = laws_.size();
    laws_[index].parts = bounds.size();
    laws_[index].left_out = split.left_out;
    const double weight = laws_[index].weight;
    for (std::size_t i = 0; i < bounds.size(); ++i) {
      const double share = split.weights[static_cast<Eigen::Index>(i)];
      laws_.push_back({.tilt = split.parts[i],
                       .bounds = std::move(bounds[i]),
                       .share = share,
                       .weight = weight * share,
                       .above = index});
    }
    while (true) {
      take_sums(laws_[index]);
      if (index == 0) break;
      index = laws_[index].above;
    }
  }

  /// Lowers the law's bounds to the sums over its parts.
  void take_sums(Law& law) {
    Eigen::VectorXd stages = Eigen::VectorXd::Constant(law.bounds.stages.size(), law.left_out);
    Eigen::VectorXd so_far = stages;
    for (std::size_t i = law.first_part; i < law.first_part + law.parts; ++i) {
      stages += laws_[i].share * laws_[i].bounds.stages;
      so_far += laws_[i].share * laws_[i].bounds.so_far;
    }
    law.bounds.stages = law.bounds.stages.cwiseMin(stages);
    law.bounds.so_far = law.bounds.so_far.cwiseMin(so_far);
  }

  const PredictedMotion& motion_;
  const UnsafeSet& unsafe_;
  const std::vector<SurrogateStage>& untilted_;
  const Executor& run_;
  double most_ = 0.0;
  std::vector<Law> laws_;
  Eigen::VectorXd without_errors_;
  double together_ = 0.0;
  std::vector<bool> far_;    ///< stages that are not tight
  std::vector<bool> loose_;  ///< far stages that are worth laws
  bool loose_together_ = false;
  Question question_;  ///< of further laws
};

}  // namespace

ConditionedBounds conditioned_bounds(const PredictedMotion& motion, const UnsafeSet& unsafe,
                                     const SurrogateBounds& plain, CertificateEffort effort,
                                     const Executor& run) {
  ConditionedBounds result{.stages = std::vector<double>(plain.bounds.size(), 1.0), .entries = {}};
  if (motion.model_error != nullptr || motion.belief_error != nullptr) return result;
  LawTree tree(motion, unsafe, plain, effort, run);
  tree.refine();
  if (!tree.has_parts()) return result;
  const LawBounds& bounds = tree.bounds();
  result.stages.assign(bounds.stages.begin(), bounds.stages.end());
  // What has been unsafe by one stage has been so by the next: a bound for later stages holds for
  // those before.
  Eigen::VectorXd so_far = bounds.so_far;
  for (Eigen::Index k = so_far.size() - 1; k > 0; --k) {
    so_far[k - 1] = std::min(so_far[k - 1], so_far[k]);
  }
  result.entries.resize(static_cast<std::size_t>(so_far.size()));
  std::adjacent_difference(so_far.begin(), so_far.end(), result.entries.begin());
  return result;
}

}  // namespace qsmpc::controller
