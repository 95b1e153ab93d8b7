// A test of whether events occur more often than certified.
#pragma once

#include <cstdint>
#include <vector>

namespace qsmpc::harness {

/// Events of a sequence, and the sum of the certified probabilities.
struct EventTally {
  std::int64_t events = 0;
  double certified = 0.0;
};

/// A p-value of the null hypothesis "given what was known when its certificate was made, no event
/// was more probable than certified". Under it the p-value is below p with probability at most p,
/// for any number of periods. The number of periods and the certificates may depend on past events.
///
/// tallies: sequences in each of which an event is known before the next certificate is made. The
/// sequences may depend on each other. Throws std::invalid_argument if there is none, or on
/// negative entries or NaN sums.
///
/// With N events and the sum S of the certified probabilities c, exp(N t − S (eᵗ − 1)) has
/// expectation at most 1 for every t ≥ 0, since E exp(t 1_event) ≤ 1 + c (eᵗ − 1) ≤ exp(c (eᵗ − 1))
/// in each period. The same holds for its mean E over t with density (1 + t)⁻², and for the mean of
/// E over the tallies. The reciprocal of the latter is a p-value by Markov's inequality. (Howard,
/// Ramdas, McAuliffe, Sekhon: "Time-uniform Chernoff bounds via nonnegative supermartingales",
/// Probability Surveys 17, 2020.)
[[nodiscard]] double exceedance_p_value(const std::vector<EventTally>& tallies);

/// Tallies of closed loops for `exceedance_p_value`.
///
/// The certificate of period k is made before x_k is observed, so it does not yet know the event of
/// the period before: even and odd periods form two separate sequences. An episode ends before the
/// certificate of the period that would follow is made; the certificate of its last period takes
/// its place in the sums of the test.
class PeriodTallies {
 public:
  PeriodTallies() : tallies_(2) {}

  /// Period number `period` of an episode, from 0.
  void add(std::int64_t period, double certified, bool event);
  /// Ends an episode of `periods` (≥ 1) periods, the last one with the certificate `certified`.
  void end_episode(std::int64_t periods, double certified);

  /// Two tallies: of the even and of the odd periods.
  [[nodiscard]] const std::vector<EventTally>& tallies() const { return tallies_; }

 private:
  std::vector<EventTally> tallies_;
};

}  // namespace qsmpc::harness
