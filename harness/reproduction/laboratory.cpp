#include "harness/reproduction/laboratory.hpp"

#include <algorithm>
#include <limits>
#include <mutex>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "controller/certification/certificate.hpp"
#include "harness/episode/driver_pool.hpp"
#include "harness/episode/episode.hpp"
#include "harness/scenario/plant_choice.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/threads/executor.hpp"
#include "harness/threads/workers.hpp"
#include "harness/trace/episode_view.hpp"

namespace qsmpc::harness {
namespace {

std::string label_of(const Variant& variant) {
  std::string label = variant.scenario;
  for (const std::string& override : variant.overrides) label += " " + override;
  return label + " on " + variant.plant;
}

EpisodeDigest digest_of(const Trace& trace) {
  const EpisodeView view(trace);
  const Summary& summary = view.summary();
  EpisodeDigest digest{.seed = trace.seed,
                       .arrived = summary.time_to_target.has_value(),
                       .unsafe = summary.collision,
                       .duration = static_cast<double>(summary.steps) * trace.scenario.time_step,
                       .cost = summary.closed_loop_cost,
                       .min_clearance = summary.min_clearance,
                       .timing = summary.breakdown};
  digest.states = view.states();
  digest.inputs.resize(trace.scenario.controller.input_lower.size(), std::ssize(trace.steps));
  for (std::size_t k = 0; k < trace.steps.size(); ++k) {
    const StepRecord& step = trace.steps[k];
    digest.inputs.col(static_cast<Eigen::Index>(k)) = step.input;
    digest.optimisation_s +=
        1e-3 * (step.timing.quantise + step.timing.propagate + step.timing.optimise);
    digest.costs.push_back(step.cost.total());
    digest.next_step.push_back(step.certificates.front().value);
    digest.particles.push_back(step.certificates.front().of("c1"));
    digest.published.push_back(step.certificates.front().of("thesis"));
    digest.plan_risk.push_back(controller::horizon_bound(step.certificates));
  }
  return digest;
}

}  // namespace

Scenario scenario_of(const Variant& variant) {
  std::vector<std::string> overrides = variant.overrides;
  overrides.emplace_back("vehicle.footprint=point");  // the thesis has no other
  Scenario scenario = with_plant(load_scenario(variant.scenario, overrides), variant.plant);
  // One thread per episode, and no dependence on its speed.
  scenario.controller.threads = 1;
  scenario.controller.deadline = std::numeric_limits<double>::infinity();
  return scenario;
}

Laboratory::Laboratory(LaboratoryOptions options)
    : options_(std::move(options)),
      threads_(usable_threads(options_.threads)),
      run_(executor_of(threads_)) {}

void Laboratory::at_work(const std::string& what) const {
  if (stopped()) throw Stopped{};
  if (options_.on_work) options_.on_work(what);
}

const Sample& Laboratory::sample(const Variant& variant, int count) {
  if (count == 0) count = options_.seeds;
  const std::string label = label_of(variant);
  const std::string key = fmt::format("{}, {}", label, count);
  if (const auto known = samples_.find(key); known != samples_.end()) return known->second;
  Sample sample{.scenario = scenario_of(variant)};
  if (options_.step_limit > 0) {
    sample.scenario.step_limit = std::min(sample.scenario.step_limit, options_.step_limit);
  }
  sample.episodes.resize(static_cast<std::size_t>(count));
  at_work(label);
  std::mutex mutex;
  int done = 0;
  DriverPool drivers(static_cast<std::size_t>(threads_));
  run_(count, [&](int n) {
    if (stopped()) return;
    EpisodeOptions options;
    options.seed = sample.scenario.seed + static_cast<std::uint64_t>(n);
    options.should_stop = [this] { return stopped(); };
    Trace trace = drivers.run(sample.scenario, options);
    sample.episodes[static_cast<std::size_t>(n)] = digest_of(trace);
    if (n == 0) sample.first = std::move(trace);
    const std::lock_guard lock(mutex);
    if (options_.on_work) {
      options_.on_work(fmt::format("{}: {} of {}", label, ++done, count));
    }
  });
  if (stopped()) throw Stopped{};
  return samples_.emplace(key, std::move(sample)).first->second;
}

std::vector<double> over_episodes(const Sample& sample,
                                  const std::function<double(const EpisodeDigest&)>& number) {
  std::vector<double> numbers;
  for (const EpisodeDigest& episode : sample.episodes) numbers.push_back(number(episode));
  return numbers;
}

int safe_arrivals(const Sample& sample) {
  return static_cast<int>(std::ranges::count_if(sample.episodes, [](const EpisodeDigest& episode) {
    return episode.arrived && !episode.unsafe;
  }));
}

}  // namespace qsmpc::harness
