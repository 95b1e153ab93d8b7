#include "harness/contest/sentences.hpp"

#include <cmath>

#include <fmt/format.h>

#include "harness/text/number_format.hpp"
#include "harness/text/printable.hpp"

namespace qsmpc::harness {
namespace {

constexpr std::size_t kNameLimit = 30;  // bytes of a controller's name in a sentence
constexpr double kLeastTold = 0.001;    // the smallest p-value that is given as a number

std::string percent(double share) { return format_percent(share) + " %"; }

std::string p_value(double p) { return p < kLeastTold ? "p < 0.001" : "p = " + format_short(p, 2); }

std::string name_of_controller(const ContestResults& results, std::size_t controller) {
  return printable(results.contest.controllers[controller].name, kNameLimit);
}

/// "−8 % [−11, −5]": the change given by a ratio of costs.
std::string cost_words(const CostDifference& cost) {
  const auto change = [](double ratio) { return format_short(100.0 * (ratio - 1.0), 2); };
  return fmt::format("{}{} % [{}, {}]", cost.ratio > 1.0 ? "+" : "", change(cost.ratio),
                     change(cost.ratio_interval.lower), change(cost.ratio_interval.upper));
}

std::string safety_words(const ContestResults& results, std::size_t controller) {
  const std::size_t reference = results.contest.reference;
  const Standing& own = results.overall[controller];
  const std::string other = name_of_controller(results, reference);
  std::string how =
      fmt::format("No significant difference in safety from {} in these drives", other);
  if (own.versus->safety() == MatchResult::kWin) how = "Safer than " + other;
  if (own.versus->safety() == MatchResult::kLoss) how = "Less safe than " + other;
  return fmt::format("{}: {} of its drives unsafe against {} ({})", how, percent(own.unsafe.rate),
                     percent(results.overall[reference].unsafe.rate),
                     p_value(own.versus->unsafe.p_value));
}

std::string arrival_words(const ContestResults& results, std::size_t controller) {
  const Standing& own = results.overall[controller];
  const MatchResult arrival = own.versus->arrival();
  if (arrival == MatchResult::kTie) return {};
  return fmt::format("; arrives {} often ({} against {}, {})",
                     arrival == MatchResult::kWin ? "more" : "less", percent(own.reached.rate),
                     percent(results.overall[results.contest.reference].reached.rate),
                     p_value(own.versus->reached.p_value));
}

std::string economy_words(const Versus& versus) {
  const CostDifference& cost = versus.cost;
  if (cost.pairs < kFewestPairs) return "; too few drives on which both arrive to compare costs";
  const MatchResult economy = versus.economy();
  return fmt::format("; where both arrive, {} ({})",
                     economy == MatchResult::kWin    ? "cheaper"
                     : economy == MatchResult::kLoss ? "more expensive"
                                                     : "no significant difference in cost",
                     cost_words(cost));
}

/// The risk that the controller estimated compared with the observed one.
std::string belief_words(const Standing& standing) {
  if (standing.believed.drives == 0) return "no estimate of its risk";
  const double believed = standing.believed.mean;
  const bool is_sure = believed < standing.unsafe.interval.lower;
  const bool is_timid = believed > standing.unsafe.interval.upper;
  return fmt::format("{} (expected {} unsafe periods per drive)",
                     is_sure    ? "underestimates its risk"
                     : is_timid ? "overestimates its risk"
                                : "estimates its risk correctly as far as these drives show",
                     format_short(believed, 2));
}

/// "; arrives within a certified risk of 0.02 in 98 % of its drives [95, 99.6], with every plan
/// certified within it in 90 % [84, 95]".
std::string kept_words(const ContestResults& results, const Standing& standing) {
  if (!standing.kept || !standing.promised) return {};
  const RateInterval& promised = standing.promised->interval;
  return fmt::format(
      "; arrives within a certified risk of {:g}{} in {} of its drives [{}, {}], with "
      "every plan certified within it in {} [{}, {}]",
      *results.contest.risk_limit, standing.no_bound.empty() ? "" : ", which is no bound here,",
      percent(standing.kept->rate), format_percent(standing.kept->interval.lower),
      format_percent(standing.kept->interval.upper), percent(standing.promised->rate),
      format_percent(promised.lower), format_percent(promised.upper));
}

std::string count_words(const CellCounts& counts) {
  return fmt::format("{}–{}–{}", counts.wins, counts.ties, counts.losses);
}

std::string cell_words(const ContestResults& results, std::size_t controller) {
  if (results.cells.size() < 2) return {};
  return fmt::format(" Wins–ties–losses of {}: safety {}, arrival {}, cost {}.",
                     results.cells.size(),
                     count_words(cell_counts(results, controller, &Versus::safety)),
                     count_words(cell_counts(results, controller, &Versus::arrival)),
                     count_words(cell_counts(results, controller, &Versus::economy)));
}

std::string reference_words(const ContestResults& results, const Standing& standing) {
  return fmt::format("The reference: {} of its drives arrive, {} [{}, {}] are unsafe; {}{}.",
                     percent(standing.reached.rate), percent(standing.unsafe.rate),
                     format_percent(standing.unsafe.interval.lower),
                     format_percent(standing.unsafe.interval.upper), belief_words(standing),
                     kept_words(results, standing));
}

}  // namespace

std::string contest_headline(const ContestResults& results) {
  if (results.done == 0) return "No drive is done.";
  std::string safest;
  double least = 2.0;
  std::string cheapest;
  double lowest = 1.0;
  for (std::size_t n = 0; n < results.overall.size(); ++n) {
    const Standing& standing = results.overall[n];
    const std::string name = name_of_controller(results, n);
    if (standing.unsafe.rate < least) {
      least = standing.unsafe.rate;
      safest = name;
    } else if (standing.unsafe.rate == least) {
      safest += ", " + name;
    }
    if (!standing.versus || standing.versus->economy() != MatchResult::kWin) continue;
    if (standing.versus->cost.ratio >= lowest) continue;
    lowest = standing.versus->cost.ratio;
    cheapest = name;
  }
  std::string text = fmt::format("Fewest unsafe drives: {} ({}). ", safest, percent(least));
  const std::string reference = name_of_controller(results, results.contest.reference);
  if (cheapest.empty()) {
    return text + "Where both arrive, none is cheaper than " + reference + ".";
  }
  return text + fmt::format("Cheapest where both arrive: {}, {} % below {}.", cheapest,
                            format_short(100.0 * (1.0 - lowest), 2), reference);
}

std::string words_about(const ContestResults& results, std::size_t controller) {
  const Standing& standing = results.overall[controller];
  if (standing.drives == 0) return "No drive is done.";
  if (!standing.versus) return reference_words(results, standing);
  if (standing.versus->unsafe.pairs == 0) return "No drive can be compared with the reference yet.";
  return safety_words(results, controller) + arrival_words(results, controller) +
         economy_words(*standing.versus) + "; " + belief_words(standing) +
         kept_words(results, standing) + "." + cell_words(results, controller);
}

}  // namespace qsmpc::harness
