// The result of reproducing an experiment of the reference thesis: plain values, from which the
// table, the page and the JSON are made. Only the published numbers in them are written by hand.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "harness/figures/svg_figure.hpp"

namespace qsmpc::harness {

/// The place of a quantity in a table laid out as in the thesis; its unit is in the row's name.
struct TablePlace {
  std::string table;   ///< caption of the whole table; may be empty
  std::string row;     ///< e.g. "100 samples"
  std::string column;  ///< e.g. "step 3"
};

/// One quantity, as published in the thesis and as measured here.
struct ResultRow {
  std::string quantity;
  std::string unit{};  ///< SI symbol; empty: a pure number
  std::optional<double>
      published{};  ///< in the thesis, in the same unit; none: it has no such value
  double here = std::numeric_limits<double>::quiet_NaN();
  std::string note{};                 ///< caveats for comparing the two; may be empty
  std::optional<TablePlace> place{};  ///< nothing: it is shown in a list
};

/// here / published; nothing if there is no published value, if it is 0, or if the ratio is not
/// finite.
[[nodiscard]] std::optional<double> ratio_of(const ResultRow& row);

/// A tested claim of the thesis or of this program.
struct Claim {
  std::string statement;
  bool holds = false;
  std::string evidence{};  ///< the numbers
};

/// A figure: panels shown together, and the name of its file.
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
      remarks{};         ///< where and why it differs from the thesis; one per paragraph
  double seconds = 0.0;  ///< wall-clock time taken
};

/// The machine on which the numbers were measured.
struct Machine {
  std::string processor;  ///< as named by the system
  int cores = 0;          ///< that a program may use concurrently
  std::string compiler;
};

[[nodiscard]] Machine this_machine();

/// Everything that one call reproduces.
struct Reproduction {
  std::string version;
  Machine machine;
  int seeds = 0;
  int threads = 0;
  std::vector<ExperimentResult> experiments{};  ///< finished ones, in the thesis's order
  bool complete = false;                        ///< whether all requested ones are finished
  double seconds = 0.0;
};

}  // namespace qsmpc::harness
