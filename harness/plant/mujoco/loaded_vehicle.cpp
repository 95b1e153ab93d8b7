#include "harness/plant/mujoco/loaded_vehicle.hpp"

#include <fmt/format.h>

#include "harness/errors.hpp"
#include "harness/mujoco/named_model.hpp"
#include "harness/plant/mujoco/solid_map.hpp"
#include "harness/plant/mujoco/vehicle_variation.hpp"
#include "harness/scenario/plant_mapping_reader.hpp"

namespace qsmpc::harness {
namespace {

void check_time_step(const NamedModel& named, const PlantMapping& mapping) {
  if (!mapping.time_steps) return;
  const double step = named.model.opt.timestep;
  constexpr double kRounding = 1.0 + 1e-9;
  if (step * kRounding >= mapping.time_steps->least &&
      step <= mapping.time_steps->most * kRounding) {
    return;
  }
  throw InputError(
      {.file = named.file,
       .key = "plant.time_step",
       .found = fmt::format("{} s", step),
       .expected = fmt::format("{} to {} s", mapping.time_steps->least, mapping.time_steps->most)});
}

}  // namespace

LoadedVehicle load_vehicle(const MujocoPlantSetup& setup) {
  LoadedVehicle loaded{.model = setup.solid
                                    ? load_with_solids(setup.mjcf, *setup.solid, setup.system)
                                    : load_mujoco_model(setup.mjcf),
                       .mapping = {}};
  const NamedModel named{.model = *loaded.model, .file = setup.mjcf};
  loaded.mapping =
      setup.mapping
          ? *setup.mapping
          : own_plant_mapping(custom_text(*loaded.model, kMappingText), setup.mjcf,
                              {.description = setup.system, .parameters = setup.parameters});
  if (setup.time_step) loaded.model->opt.timestep = *setup.time_step;
  check_time_step(named, loaded.mapping);
  vary_vehicle(named, *loaded.model, loaded.mapping, setup.variation);
  return loaded;
}

}  // namespace qsmpc::harness
