// The experiments of the reference thesis, named after their table or figure.
//
//   Laboratory laboratory({.seeds = 50});
//   const Reproduction done = reproduce({"table-5-2"}, laboratory, {});
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/reproduction/laboratory.hpp"
#include "harness/reproduction/result.hpp"

namespace qsmpc::harness {

struct ExperimentEntry {
  std::string name;                    ///< e.g. "table-5-2"
  std::string title;                   ///< one line
  std::vector<std::string> aliases{};  ///< other names: those of its figures
};

/// All of them in the thesis's order, followed by those that go beyond it.
[[nodiscard]] const std::vector<ExperimentEntry>& experiments();

/// The experiments selected by `names` (names, aliases, "all"), each once, in the order of
/// experiments(); all of them if `names` is empty. Throws InputError on an unknown name, listing
/// those that exist.
[[nodiscard]] std::vector<std::string> experiments_named(const std::vector<std::string>& names);

/// Runs one experiment. Throws std::invalid_argument on an unknown name, Stopped if `laboratory` is
/// told to stop, and InputError on a scenario that is missing or wrong.
[[nodiscard]] ExperimentResult do_experiment(const std::string& name, Laboratory& laboratory);

/// Called with the results so far, each time an experiment is finished.
using OnExperiment = std::function<void(const Reproduction&)>;

/// Runs the experiments `names`, as returned by `experiments_named`, one after the other. If the
/// work is abandoned, the finished ones are returned and `complete` is false.
[[nodiscard]] Reproduction reproduce(const std::vector<std::string>& names, Laboratory& laboratory,
                                     const OnExperiment& on_experiment);

}  // namespace qsmpc::harness
