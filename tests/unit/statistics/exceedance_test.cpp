#include "harness/statistics/exceedance.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "models/random/random_numbers.hpp"

namespace qsmpc::harness {
namespace exceedance_test {

TEST(Exceedance, nothing_certified_and_no_event_is_not_evidence) {
  EXPECT_EQ(exceedance_p_value({{.events = 0, .certified = 0.0}}), 1.0);
  EXPECT_EQ(exceedance_p_value({{.events = 0, .certified = 5.0}}), 1.0);
}

TEST(Exceedance, an_event_that_was_certified_not_to_happen_is_proof) {
  EXPECT_EQ(exceedance_p_value({{.events = 1, .certified = 0.0}}), 0.0);
  // One of the two sequences is enough.
  EXPECT_EQ(exceedance_p_value({{.events = 1, .certified = 0.0}, {.events = 0, .certified = 9.0}}),
            0.0);
}

TEST(Exceedance, as_many_events_as_certified_are_not_evidence_and_many_more_are) {
  EXPECT_GT(exceedance_p_value({{.events = 10, .certified = 10.0}}), 0.3);
  EXPECT_LT(exceedance_p_value({{.events = 40, .certified = 10.0}}), 1e-8);
  EXPECT_LT(exceedance_p_value({{.events = 1, .certified = 1e-6}}), 1e-3);
}

// Counts of many rare events are Poisson, a case for which the p-value must hold.
TEST(Exceedance, is_never_smaller_than_the_tail_of_a_poisson_count) {
  for (const double certified : {1e-6, 1e-3, 0.1, 1.0, 4.0}) {
    double below = 0.0;
    double mass = std::exp(-certified);
    for (int events = 0; events < 12; ++events) {
      const double tail = 1.0 - below;
      const double p = exceedance_p_value({{.events = events, .certified = certified}});
      EXPECT_GE(p, std::min(1.0, tail) * (1.0 - 1e-6) - 1e-12) << certified << " " << events;
      below += mass;
      mass *= certified / (events + 1);
    }
  }
}

// Certificates that depend on the past, and a sequence that stops at its first event.
TEST(Exceedance, rejects_valid_certificates_no_more_often_than_it_says) {
  int rejected = 0;
  constexpr int kRuns = 4000;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    const Eigen::VectorXd uniform = models::uniform_sample(60, {.seed = 3, .episode = run});
    EventTally tally;
    double certified = 0.02;
    for (const double u : uniform) {
      tally.certified += certified;
      if (u <= certified) {
        ++tally.events;
        if (tally.events == 3) break;
        certified = 0.2;
      } else {
        certified = 0.02;
      }
    }
    rejected += exceedance_p_value({tally}) < 0.05 ? 1 : 0;
  }
  EXPECT_LT(rejected, kRuns / 20);
}

TEST(Exceedance, finds_certificates_that_are_half_of_what_they_should_be) {
  EventTally tally;
  const Eigen::VectorXd uniform = models::uniform_sample(4000, {.seed = 4});
  for (const double u : uniform) {
    tally.certified += 0.05;
    tally.events += u <= 0.1 ? 1 : 0;
  }
  EXPECT_LT(exceedance_p_value({tally}), 1e-6);
}

TEST(PeriodTallies, keep_even_and_odd_periods_apart_and_count_a_last_certificate_once_more) {
  PeriodTallies tallies;
  tallies.add(0, 0.25, false);
  tallies.add(1, 0.5, true);
  tallies.add(2, 0.125, true);
  tallies.end_episode(3, 0.125);
  ASSERT_EQ(tallies.tallies().size(), 2U);
  EXPECT_EQ(tallies.tallies()[0].events, 1);
  EXPECT_EQ(tallies.tallies()[0].certified, 0.375);
  EXPECT_EQ(tallies.tallies()[1].events, 1);
  EXPECT_EQ(tallies.tallies()[1].certified, 0.625);
}

TEST(Exceedance, refuses_impossible_arguments) {
  EXPECT_THROW((void)exceedance_p_value({}), std::invalid_argument);
  EXPECT_THROW((void)exceedance_p_value({{.events = -1, .certified = 0.0}}), std::invalid_argument);
  EXPECT_THROW((void)exceedance_p_value({{.events = 0, .certified = -0.1}}), std::invalid_argument);
  EXPECT_THROW((void)exceedance_p_value({{.events = 0, .certified = std::nan("")}}),
               std::invalid_argument);
}

}  // namespace exceedance_test
}  // namespace qsmpc::harness
