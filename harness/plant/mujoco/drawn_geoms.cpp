#include "harness/plant/mujoco/drawn_geoms.hpp"

namespace qsmpc::harness {

void leave_out_drawn_geoms(mjModel& model) {
  if (model.npair > 0 || model.opt.density > 0.0 || model.opt.viscosity > 0.0) return;
  const auto is_drawn = [&model](int geom) {
    return model.geom_contype[geom] == 0 && model.geom_conaffinity[geom] == 0;
  };
  for (int body = 0; body < model.nbody; ++body) {
    int& first = model.body_geomadr[body];
    int& count = model.body_geomnum[body];
    while (count > 0 && is_drawn(first + count - 1)) --count;
    while (count > 0 && is_drawn(first)) {
      ++first;
      --count;
    }
  }
}

}  // namespace qsmpc::harness
