#include "harness/episode/trace_header.hpp"

#include "harness/assembly/assembly.hpp"
#include "harness/assembly/chosen_points.hpp"
#include "harness/errors.hpp"
#include "harness/plant/plant_registry.hpp"
#include "harness/scenario/scenario_file.hpp"
#include "harness/version.hpp"

namespace qsmpc::harness {

Trace trace_header(const Scenario& scenario, std::uint64_t seed) {
  const Scenario driven = with_chosen_points(scenario);
  Trace header =
      trace_header(driven, model_of(driven)->description(), seed, driven.disturbance.seeds);
  header.vehicle_digest = digest_if_there(driven);
  return header;
}

Trace trace_header(const Scenario& scenario, const models::SystemDescription& system,
                   std::uint64_t seed, const std::vector<models::NoiseSeed>& noise) {
  Trace trace;
  trace.scenario = scenario;
  trace.scenario.safe_set.forecast = nullptr;  // belongs to the drive
  trace.scenario.seed = seed;
  trace.scenario.disturbance.seeds = noise;
  trace.scenario_text = to_yaml(trace.scenario);
  trace.system = system;
  trace.seed = seed;
  trace.version = kVersion;
  return trace;
}

std::string digest_if_there(const Scenario& scenario) {
  try {
    return plant_digest(scenario);
  } catch (const InputError&) {
    return {};
  }
}

}  // namespace qsmpc::harness
