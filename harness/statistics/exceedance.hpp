// Whether events happen more often than certified.
#pragma once

#include <cstdint>
#include <vector>

namespace qsmpc::harness {

/// Events of a sequence, and the sum of the certified probabilities.
struct EventTally {
  std::int64_t events = 0;
  double certified = 0.0;
};

/// A p-value against "no event was more probable, given what was known when its certificate was
/// made, than certified". It is below p with a probability of at most p if that is so, for any
/// number of periods, also one that depends on what happened, and for certificates that do.
///
/// tallies: sequences in each of which an event is known before the next certificate is made. They
/// may depend on each other. Throws std::invalid_argument without one, and on negative entries or
/// sums that are not a number.
///
/// With N events and the sum S, exp(N t − S (eᵗ − 1)) has an expectation of at most 1 for every
/// t ≥ 0, since E exp(t 1_event) ≤ 1 + c (eᵗ − 1) ≤ exp(c (eᵗ − 1)) period by period. So has its
/// mean E over t of the density (1 + t)⁻², and the mean of E over the tallies, whose reciprocal is
/// a p-value by Markov's inequality. (Howard, Ramdas, McAuliffe, Sekhon: "Time-uniform Chernoff
/// bounds via nonnegative supermartingales", Probability Surveys 17, 2020.)
[[nodiscard]] double exceedance_p_value(const std::vector<EventTally>& tallies);

/// Tallies of closed loops for `exceedance_p_value`.
///
/// The certificate of period k is made before x_k is seen, so that events of neighbouring periods
/// overlap in what is known of them: periods of even and of odd number are two sequences. An
/// episode ends before the certificate of the period that would follow is made; that of its last
/// period stands for it in the sums of the test.
class PeriodTallies {
 public:
  PeriodTallies() : tallies_(2) {}

  /// Period number `period` of an episode, from 0.
  void add(std::int64_t period, double certified, bool event);
  /// The episode had `periods` (≥ 1) of them, the last one with the certificate `certified`.
  void end_episode(std::int64_t periods, double certified);

  /// Two: of even and of odd periods.
  [[nodiscard]] const std::vector<EventTally>& tallies() const { return tallies_; }

 private:
  std::vector<EventTally> tallies_;
};

}  // namespace qsmpc::harness
