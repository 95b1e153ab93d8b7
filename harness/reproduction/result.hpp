// What reproducing an experiment of the reference thesis gives: plain values, from which the table,
// the page and the JSON are made. Nothing in them is written by hand but the published numbers.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "harness/figures/svg_figure.hpp"

namespace qsmpc::harness {

/// Where a quantity stands in a table of the thesis's own shape; its unit is in the row's name.
struct TablePlace {
  std::string table;   ///< what is said of the whole table; may be empty
  std::string row;     ///< e.g. "100 samples"
  std::string column;  ///< e.g. "step 3"
};

/// One quantity, as the thesis has it and as it is measured here.
struct ResultRow {
  std::string quantity;
  std::string unit{};  ///< SI symbol; empty: a number without one
  std::optional<double>
      published{};  ///< in the thesis, in the same unit; none: it has no such value
  double here = std::numeric_limits<double>::quiet_NaN();
  std::string note{};                 ///< what has to be known to compare the two; may be empty
  std::optional<TablePlace> place{};  ///< none: it stands in a list
};

/// here / published; none where nothing is published, or 0, or where the ratio is not finite.
[[nodiscard]] std::optional<double> ratio_of(const ResultRow& row);

/// Something that the thesis or this program claims, put to the test.
struct Claim {
  std::string statement;
  bool holds = false;
  std::string evidence{};  ///< the numbers
};

/// A figure: panels that stand together, and the name of its file.
struct ResultFigure {
  std::string file;  ///< e.g. "figure-5-2.svg"
  std::string title;
  std::string caption{};
  std::vector<Panel> panels{};
};

struct ExperimentResult {
  std::string name;   ///< e.g. "table-5-2"
  std::string title;  ///< what is shown
  std::vector<ResultRow> rows{};
  std::vector<Claim> claims{};
  std::vector<ResultFigure> figures{};
  std::vector<std::string>
      remarks{};         ///< where and why it differs from the thesis; one a paragraph
  double seconds = 0.0;  ///< wall clock that it took
};

/// What the numbers were measured on.
struct Machine {
  std::string processor;  ///< as the system names it
  int cores = 0;          ///< that a program may run on at once
  std::string compiler;
};

[[nodiscard]] Machine this_machine();

/// All that one call reproduces.
struct Reproduction {
  std::string version;
  Machine machine;
  int seeds = 0;
  int threads = 0;
  std::vector<ExperimentResult> experiments{};  ///< that are finished, in the thesis's order
  bool complete = false;                        ///< whether all that were asked for are
  double seconds = 0.0;
};

}  // namespace qsmpc::harness
