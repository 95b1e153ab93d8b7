#include "harness/reproduction/experiment.hpp"

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include "harness/errors.hpp"
#include "harness/reproduction/experiments.hpp"
#include "harness/scenario/known_names.hpp"
#include "harness/threads/interruption.hpp"
#include "harness/version.hpp"

namespace qsmpc::harness {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kAll = "all";

struct Experiment {
  ExperimentEntry entry;
  ExperimentResult (*run)(Laboratory&);
};

const std::vector<Experiment>& table() {
  static const std::vector<Experiment> all{
      {{"figure-4-1", "A Gaussian belief along a turn: points against samples", {}},
       propagation_along_a_turn},
      {{"figure-4-2", "A belief with noise: what compression saves and loses", {}},
       propagation_with_noise},
      {{"table-5-1", "Prediction quality: distance to 2,000 samples", {"figure-5-1"}},
       prediction_quality},
      {{"algorithm-4", "The published probability of the unsafe set, and bounds", {"algorithm-3"}},
       published_certificate},
      {{"table-5-2", "A turn in a corridor: open and closed loop, full noise", {"figure-5-2"}},
       corridor_with_noise},
      {{"table-5-3", "The same, with noise that the planner does not see", {"figure-5-3"}},
       corridor_with_unseen_noise},
      {{"table-5-4", "Obstacles: two solvers, three numbers of points", {"figure-5-4"}},
       obstacles_by_solver},
      {{"table-5-5", "Bicycle among obstacles: three numbers of points", {"figure-5-5"}},
       bicycle_by_points},
      {{"figure-5-6", "Bicycle with noise and compression", {}}, bicycle_with_noise},
      {{"table-b-4", "Double integrator", {}}, double_integrator_at_rest},
      {{"table-b-5", "Pendulum on a cart", {}}, cart_pole_upright},
      {{"plants", "Every scenario on the model and on MuJoCo vehicles", {}}, scenarios_on_plants}};
  return all;
}

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

bool means(const ExperimentEntry& entry, const std::string& name) {
  return name == kAll || name == entry.name || std::ranges::count(entry.aliases, name) > 0;
}

std::vector<std::string> known_names() {
  std::vector<std::string> known{kAll};
  for (const ExperimentEntry& entry : experiments()) {
    known.push_back(entry.name);
    known.insert(known.end(), entry.aliases.begin(), entry.aliases.end());
  }
  return known;
}

}  // namespace

const std::vector<ExperimentEntry>& experiments() {
  static const std::vector<ExperimentEntry> entries = [] {
    std::vector<ExperimentEntry> all;
    for (const Experiment& experiment : table()) all.push_back(experiment.entry);
    return all;
  }();
  return entries;
}

std::vector<std::string> experiments_named(const std::vector<std::string>& names) {
  const std::vector<std::string> known = known_names();
  for (const std::string& name : names) {
    if (std::ranges::count(known, name) > 0) continue;
    throw InputError({.key = "experiment", .found = name, .expected = expected_names(name, known)});
  }
  std::vector<std::string> chosen;
  for (const ExperimentEntry& entry : experiments()) {
    const bool wanted = names.empty() || std::ranges::any_of(names, [&](const std::string& name) {
                          return means(entry, name);
                        });
    if (wanted) chosen.push_back(entry.name);
  }
  return chosen;
}

ExperimentResult do_experiment(const std::string& name, Laboratory& laboratory) {
  for (const Experiment& experiment : table()) {
    if (experiment.entry.name != name) continue;
    const Clock::time_point start = Clock::now();
    ExperimentResult result = experiment.run(laboratory);
    result.name = experiment.entry.name;
    result.title = experiment.entry.title;
    result.seconds = seconds_since(start);
    return result;
  }
  throw std::invalid_argument("no experiment is called '" + name + "'");
}

Reproduction reproduce(const std::vector<std::string>& names, Laboratory& laboratory,
                       const OnExperiment& on_experiment) {
  const Clock::time_point start = Clock::now();
  Reproduction all{.version = kVersion,
                   .machine = this_machine(),
                   .seeds = laboratory.seeds(),
                   .threads = laboratory.threads()};
  const std::vector<std::string> chosen = experiments_named(names);
  for (const std::string& name : chosen) {
    try {
      all.experiments.push_back(do_experiment(name, laboratory));
    } catch (const Stopped&) {
      break;
    } catch (const Interrupted&) {
      break;
    }
    all.complete = all.experiments.size() == chosen.size();
    all.seconds = seconds_since(start);
    if (on_experiment) on_experiment(all);
  }
  return all;
}

}  // namespace qsmpc::harness
