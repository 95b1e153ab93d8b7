// The experiments of the reference thesis, by the name of their table or figure.
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

/// All of them, in the thesis's order; then what goes beyond it.
[[nodiscard]] const std::vector<ExperimentEntry>& experiments();

/// The experiments that `names` mean, in the table's order and each once: names, aliases, "all";
/// all where `names` is empty. Throws InputError on another, with those that exist.
[[nodiscard]] std::vector<std::string> experiments_named(const std::vector<std::string>& names);

/// Does one experiment. Throws std::invalid_argument on an unknown name, Stopped where `laboratory`
/// is told to stop, and InputError on a scenario that is missing or wrong.
[[nodiscard]] ExperimentResult do_experiment(const std::string& name, Laboratory& laboratory);

/// Told of what is done so far, each time an experiment is.
using OnExperiment = std::function<void(const Reproduction&)>;

/// Does the experiments called `names`, as `experiments_named` gives them, one after the other.
/// Where the work is given up, what is finished is returned and `complete` is false.
[[nodiscard]] Reproduction reproduce(const std::vector<std::string>& names, Laboratory& laboratory,
                                     const OnExperiment& on_experiment);

}  // namespace qsmpc::harness
