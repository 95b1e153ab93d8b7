#include "harness/plant/mujoco/solid_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <variant>

#include <fmt/format.h>

#include "controller/regions/planar/planar_shape.hpp"
#include "harness/errors.hpp"

namespace qsmpc::harness {
namespace {

constexpr const char* kSolidName = "qsmpc_solid_";    // followed by a number
constexpr const char* kMovingName = "qsmpc_moving_";  // the same, for a body
constexpr double kFarAway = 1000.0;                   // m
constexpr double kHalfHeight = 5.0;                   // m, about the ground
constexpr int kSolidContacts = 500;                   // simultaneously
constexpr int kRowsPerContact = 4;                    // of a pyramidal friction cone
constexpr int kLowestBit = 8;  // lower bits are more likely to be used by the model

// Softer than wheels on the ground: a disturbance can put the vehicle 0.3 m deep into a block, and
// the response must not throw it into the air. Highest priority: the vehicle's own stiffness and
// friction are meant for the ground.
constexpr const char* kSolidContact =
    R"(contype="0" conaffinity="0" condim="3" priority="1000" friction="0.5 0.005 0.0001" )"
    R"(solref="0.05 1" solimp="0.9 0.95 0.001 0.5 2" margin="0" gap="0" mass="0" rgba="0 0 0 0")";

struct Interval {
  double lower;
  double upper;
};

Interval finite_interval(const controller::Box& box, int axis) {
  const double lower = box.lower[axis];
  const double upper = box.upper[axis];
  if (std::isfinite(lower)) return {lower, std::isfinite(upper) ? upper : lower + kFarAway};
  return {(std::isfinite(upper) ? upper : 0.0) - kFarAway, std::isfinite(upper) ? upper : kFarAway};
}

bool is_in_plane(const controller::Box& box, const models::SystemDescription& system) {
  return std::ranges::all_of(controller::bounded_axes(box), [&](const auto& interval) {
    return interval.axis == system.position_x || interval.axis == system.position_y;
  });
}

class SolidWriter {
 public:
  /// `normal` points away from the solid side.
  void plane(const Eigen::Vector2d& point, const Eigen::Vector2d& normal) {
    add(fmt::format(R"(type="plane" size="1 1 1" pos="{} {} 0" zaxis="{} {} 0")", point.x(),
                    point.y(), normal.x(), normal.y()));
  }
  void box(const Interval& x, const Interval& y) {
    add(fmt::format(R"(type="box" size="{} {} {}" pos="{} {} 0" quat="1 0 0 0")",
                    0.5 * (x.upper - x.lower), 0.5 * (y.upper - y.lower), kHalfHeight,
                    0.5 * (x.lower + x.upper), 0.5 * (y.lower + y.upper)));
  }

  void operator()(const controller::DiscShape& disc) {
    add(fmt::format(R"(type="cylinder" size="{} {}" pos="{} {} 0" quat="1 0 0 0")", disc.radius,
                    kHalfHeight, disc.centre.x(), disc.centre.y()));
  }
  void operator()(const controller::TurnedBoxShape& box) {
    add(fmt::format(R"(type="box" size="{} {} {}" pos="{} {} 0" quat="{} 0 0 {}")",
                    0.5 * box.size.x(), 0.5 * box.size.y(), kHalfHeight, box.centre.x(),
                    box.centre.y(), std::cos(0.5 * box.angle), std::sin(0.5 * box.angle)));
  }
  void operator()(const controller::HalfPlaneShape& half_plane) {
    const Eigen::Vector2d into = half_plane.normal.normalized();
    plane(half_plane.offset / half_plane.normal.norm() * into, -into);
  }
  void operator()(const controller::EllipseShape& ellipse) { prisms(ellipse); }
  void operator()(const controller::PolygonShape& polygon) { prisms(polygon); }

  /// On its own body, positioned at the centre of the shape.
  void moving(const controller::PlanarShape& shape) {
    const Eigen::Vector2d centre = controller::shape_centre(shape);
    solids_.geoms += fmt::format("<body name=\"{}{}\" mocap=\"true\" pos=\"{} {} 0\">\n",
                                 kMovingName, moving_count_++, centre.x(), centre.y());
    std::visit(*this, controller::moved(shape, -centre));
    solids_.geoms += "</body>\n";
  }

  [[nodiscard]] Solids solids() const { return solids_; }

 private:
  void prisms(const controller::PlanarShape& shape) {
    for (const controller::ConvexPart& part : controller::convex_parts(shape)) prism(part.corners);
  }

  /// MuJoCo takes the convex hull of a mesh's vertices. They are relative to their mean, since
  /// MuJoCo stores them in single precision.
  void prism(const Eigen::Matrix2Xd& corners) {
    const Eigen::Vector2d middle = corners.rowwise().mean();
    std::string vertices;
    for (const auto& corner : corners.colwise()) {
      const Eigen::Vector2d at = corner - middle;
      vertices +=
          fmt::format("{0} {1} {2}  {0} {1} {3}  ", at.x(), at.y(), -kHalfHeight, kHalfHeight);
    }
    const std::string name = fmt::format("{}{}", kSolidName, count_);
    solids_.assets +=
        fmt::format("<mesh name=\"{}\" scale=\"1 1 1\" vertex=\"{}\"/>\n", name, vertices);
    add(fmt::format(R"(type="mesh" mesh="{}" pos="{} {} 0" quat="1 0 0 0")", name, middle.x(),
                    middle.y()));
  }

  void add(const std::string& shape) {
    solids_.geoms +=
        fmt::format("<geom name=\"{}{}\" {} {}/>\n", kSolidName, count_++, shape, kSolidContact);
  }

  Solids solids_;
  int count_ = 0;
  int moving_count_ = 0;
};

/// A bit that no geom of the model uses.
int spare_bit(const NamedModel& named) {
  const mjModel& model = named.model;
  unsigned used = 0;
  for (int geom = 0; geom < model.ngeom; ++geom) {
    used |= static_cast<unsigned>(model.geom_contype[geom] | model.geom_conaffinity[geom]);
  }
  constexpr int kBits = 31;  // MuJoCo's integers are signed
  for (int bit = kBits - 1; bit >= kLowestBit; --bit) {
    if ((used & (1U << bit)) == 0) return 1 << bit;
  }
  throw InputError({.file = named.file,
                    .key = "plant.solid",
                    .found = "geoms whose contype and conaffinity use all bits",
                    .expected = "at least one of the bits 8 to 30 unused"});
}

}  // namespace

Solids solids_of(const controller::SafeSet& safe_set, const models::SystemDescription& system) {
  SolidWriter writer;
  const auto wall = [&](int axis, double place, double inward) {
    if (!std::isfinite(place)) return;
    const Eigen::Vector2d along =
        axis == system.position_x ? Eigen::Vector2d::UnitX() : Eigen::Vector2d::UnitY();
    writer.plane(place * along, inward * along);
  };
  for (const int axis : {system.position_x, system.position_y}) {
    wall(axis, safe_set.bounds.lower[axis], 1.0);
    wall(axis, safe_set.bounds.upper[axis], -1.0);
  }
  for (const controller::Obstacle& obstacle : safe_set.obstacles) {
    const controller::PlanarShape* shape = obstacle.shape();
    if (obstacle.motion) {
      writer.moving(*shape);
    } else if (shape != nullptr) {
      std::visit(writer, *shape);
    } else if (const controller::Box& box = *obstacle.box(); is_in_plane(box, system)) {
      writer.box(finite_interval(box, system.position_x), finite_interval(box, system.position_y));
    }
  }
  return writer.solids();
}

MujocoModelPtr load_with_solids(const std::string& mjcf, const controller::SafeSet& safe_set,
                                const models::SystemDescription& system) {
  const MujocoModelPtr plain = load_mujoco_model(mjcf);
  if (plain->opt.collision == mjCOL_PAIR) {
    throw InputError({.file = mjcf,
                      .key = "option collision",
                      .found = "predefined",
                      .expected = "all, or plant.solid: false"});
  }
  const Solids solids = solids_of(safe_set, system);
  MujocoModelPtr model = load_mujoco_model_with(
      mjcf,
      fmt::format("<size nconmax=\"{}\" njmax=\"{}\"/>\n<asset>\n{}</asset>\n"
                  "<worldbody>\n{}</worldbody>\n",
                  plain->nconmax + kSolidContacts, plain->njmax + kRowsPerContact * kSolidContacts,
                  solids.assets, solids.geoms));
  if ((model->opt.disableflags & mjDSBL_CONTACT) != 0) {
    std::fill_n(model->geom_contype, model->ngeom, 0);
    std::fill_n(model->geom_conaffinity, model->ngeom, 0);
    model->opt.disableflags &= ~mjDSBL_CONTACT;
  }
  return model;
}

SolidMap::SolidMap(const NamedModel& named, int carrier) : bit_(spare_bit(named)) {
  const mjModel& model = named.model;
  is_solid_.assign(static_cast<std::size_t>(model.ngeom), 0);
  for (int body = 0;; ++body) {
    const int found =
        mj_name2id(&model, mjOBJ_BODY, fmt::format("{}{}", kMovingName, body).c_str());
    if (found < 0) break;
    moving_.push_back(found);
  }
  const int root = model.body_rootid[carrier];
  for (int geom = 0; geom < model.ngeom; ++geom) {
    const std::string name = model.names + model.name_geomadr[geom];
    if (name.starts_with(kSolidName)) {
      solids_.push_back(geom);
      is_solid_[static_cast<std::size_t>(geom)] = 1;
    } else if (root > 0 && model.body_rootid[model.geom_bodyid[geom]] == root) {
      vehicle_.push_back(geom);
    }
  }
}

void SolidMap::set_standing(mjModel& model, bool standing) const {
  for (const int geom : solids_) model.geom_contype[geom] = standing ? bit_ : 0;
  for (const int geom : vehicle_) {
    int& affinity = model.geom_conaffinity[geom];
    affinity = standing ? affinity | bit_ : affinity & ~bit_;
  }
}

void SolidMap::place(const Eigen::Matrix3Xd& poses, const mjModel& model, mjData& data) const {
  for (std::size_t n = 0; n < moving_.size(); ++n) {
    const int body = moving_[n];
    const auto pose = poses.col(static_cast<Eigen::Index>(n));
    mjtNum* const place = data.mocap_pos + std::ptrdiff_t{3} * model.body_mocapid[body];
    for (int axis = 0; axis < 2; ++axis) place[axis] = model.body_pos[3 * body + axis] + pose[axis];
    mjtNum* const turn = data.mocap_quat + std::ptrdiff_t{4} * model.body_mocapid[body];
    turn[0] = std::cos(0.5 * pose[2]);
    turn[3] = std::sin(0.5 * pose[2]);
  }
}

double SolidMap::largest_force(const mjModel& model, const mjData& data) const {
  double largest = 0.0;
  for (int k = 0; k < data.ncon; ++k) {
    const mjContact& contact = data.contact[k];
    const bool is_solid = is_solid_[static_cast<std::size_t>(contact.geom1)] != 0 ||
                          is_solid_[static_cast<std::size_t>(contact.geom2)] != 0;
    if (!is_solid || contact.efc_address < 0) continue;
    std::array<double, 6> force{};
    mj_contactForce(&model, &data, k, force.data());
    largest = std::max(largest, force[0]);
  }
  return largest;
}

}  // namespace qsmpc::harness
