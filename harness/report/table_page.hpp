// Static pages of tables and figures, for comparisons and campaigns.
//
//   framed_page({.title = "Plants", .version = kVersion, .kind = PageKind::kTables},
//               verdict_html({.mood = PageMood::kGood, .title = "All is well"}) +
//                   table_html({.label = "Outcomes", .heads = {"plant", "reached"},
//                               .rows = {{"car", "8"}}}));
//
// Fields documented as HTML are put on the page unchanged; everything else is escaped.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "harness/statistics/binomial_interval.hpp"

namespace qsmpc::harness {

enum class PageMood { kGood, kOpen, kBad };

/// The main statement of a page or section, shown before the rest.
struct PageVerdict {
  PageMood mood = PageMood::kBad;
  std::string title;                   ///< a few words
  std::vector<std::string> sentences;  ///< one paragraph each
};

[[nodiscard]] std::string verdict_html(const PageVerdict& verdict);

struct PageTable {
  std::string label;                           ///< for screen readers
  std::vector<std::string> heads;              ///< HTML, one per column
  std::vector<std::vector<std::string>> rows;  ///< HTML; the first cell is the row's header
  std::vector<std::size_t> text_columns = {};  ///< columns of text rather than numbers, besides the
                                               ///< first
};

/// A table in a region that scrolls sideways, also by keyboard, if it is wider than the page.
[[nodiscard]] std::string table_html(const PageTable& table);

/// A `heading` and its note, in small print; no paragraph for an empty one.
[[nodiscard]] std::string section_head(const std::string& heading, const std::string& note);

/// HTML of a number, "–" if it is not finite; and of limits, in soft print.
[[nodiscard]] std::string number_html(double value);
[[nodiscard]] std::string interval_html(const RateInterval& limits);

}  // namespace qsmpc::harness
