// Pages of tables and figures that nothing moves in: of comparisons and campaigns.
//
//   framed_page({.title = "Plants", .version = kVersion, .kind = PageKind::kTables},
//               verdict_html({.mood = PageMood::kGood, .title = "All is well"}) +
//                   table_html({.label = "Outcomes", .heads = {"plant", "reached"},
//                               .rows = {{"car", "8"}}}));
//
// What is called HTML is put on the page as it is; everything else is escaped.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "harness/statistics/binomial_interval.hpp"

namespace qsmpc::harness {

enum class PageMood { kGood, kOpen, kBad };

/// What is to be known before the rest of a page or of a section.
struct PageVerdict {
  PageMood mood = PageMood::kBad;
  std::string title;                   ///< a few words
  std::vector<std::string> sentences;  ///< each a paragraph
};

[[nodiscard]] std::string verdict_html(const PageVerdict& verdict);

struct PageTable {
  std::string label;                           ///< for those who do not see it
  std::vector<std::string> heads;              ///< HTML, one a column
  std::vector<std::vector<std::string>> rows;  ///< HTML; the first cell is the row's head
  std::vector<std::size_t> text_columns = {};  ///< that are words, not numbers, besides the first
};

/// A table in a region that scrolls sideways, by keyboard too, where it is wider than the page.
[[nodiscard]] std::string table_html(const PageTable& table);

/// A `heading` and its note, in small print; no paragraph for an empty one.
[[nodiscard]] std::string section_head(const std::string& heading, const std::string& note);

/// HTML of a number, "–" where it is not finite; and of limits, in soft print.
[[nodiscard]] std::string number_html(double value);
[[nodiscard]] std::string interval_html(const RateInterval& limits);

}  // namespace qsmpc::harness
