#include "controller/planning/risk/recent_bounds.hpp"

#include <algorithm>

#include "controller/certification/certificate.hpp"

namespace qsmpc::controller {
namespace {

// A plan rarely returns to a policy after more than four others.
constexpr std::size_t kMostEntries = 6;

}  // namespace

bool RecentBounds::Entry::is_of(const PredictedMotion& motion) const {
  const Policy& other = motion.policy;
  return policy.inputs == other.inputs && policy.gains == other.gains &&
         policy.states == other.states && belief.mean == motion.belief.mean &&
         belief.covariance == motion.belief.covariance;
}

const SurrogateBounds& RecentBounds::of(const PredictedMotion& motion) {
  auto entry = std::find_if(entries_.begin(), entries_.end(),
                            [&](const Entry& one) { return one.is_of(motion); });
  if (entry == entries_.end()) {
    Entry made{.belief = motion.belief,
               .policy = motion.policy,
               .bounds = surrogate_bounds(motion, unsafe_, CertificateEffort::kLeast, run_,
                                          NarrowCore::kIfTelling)};
    if (entries_.size() == kMostEntries) entries_.pop_back();
    entries_.push_back(std::move(made));
    entry = entries_.end() - 1;
  }
  std::rotate(entries_.begin(), entry, entry + 1);
  return entries_.front().bounds;
}

}  // namespace qsmpc::controller
