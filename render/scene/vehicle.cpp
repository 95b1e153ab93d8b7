#include "render/scene/vehicle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <stdexcept>

#include <mujoco/mujoco.h>

#include "models/constants.hpp"
#include "render/gl/shadow.hpp"
#include "render/gl/solid_mesh.hpp"
#include "render/palette.hpp"
#include "render/scene/mujoco_guard.hpp"

namespace qsmpc::render {
namespace {

constexpr int kSpareGeoms = 64;  // MuJoCo's own decorations
constexpr int kHiddenGroup = 5;  // mjvOption draws groups 0 to 2 unless told otherwise
constexpr int kLastVisibleGroup = 2;
constexpr double kAxisTolerance = 1e-6;

struct ModelDeleter {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct DataDeleter {
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using ModelPointer = std::unique_ptr<mjModel, ModelDeleter>;
using DataPointer = std::unique_ptr<mjData, DataDeleter>;

ModelPointer load_model(const std::string& path) {
  // MuJoCo's XML reader keeps state of its own in the process.
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  std::array<char, 1000> words{};
  ModelPointer model(
      mj_loadXML(path.c_str(), nullptr, words.data(), static_cast<int>(words.size())));
  if (!model) {
    throw std::runtime_error("vehicle \"" + path + "\": " + words.data());
  }
  return model;
}

// The ground and the sky are drawn by ScenePainter: MuJoCo's textured ones take most of a frame.
void prepare_model(mjModel& model, int width, int height) {
  for (int geom = 0; geom < model.ngeom; ++geom) {
    if (model.geom_type[geom] == mjGEOM_PLANE && model.geom_bodyid[geom] == 0) {
      model.geom_group[geom] = kHiddenGroup;
    }
  }
  model.vis.global.offwidth = width;
  model.vis.global.offheight = height;
  model.vis.quality.offsamples = 0;  // smooth_edges instead
  model.vis.quality.shadowsize = 0;
}

bool is_visible(const mjModel& model, int geom) {
  return model.geom_group[geom] <= kLastVisibleGroup && model.geom_type[geom] != mjGEOM_PLANE;
}

// Whether it is a part of the vehicle, not of the terrain: what is welded to the world stands.
bool is_vehicle(const mjModel& model, int geom) {
  return is_visible(model, geom) && model.body_weldid[model.geom_bodyid[geom]] != 0;
}

Colour colour_of(const mjModel& model, int geom) {
  const int material = model.geom_matid[geom];
  const float* const rgba = material < 0
                                ? model.geom_rgba + static_cast<std::ptrdiff_t>(4) * geom
                                : model.mat_rgba + static_cast<std::ptrdiff_t>(4) * material;
  return {rgba[0], rgba[1], rgba[2], rgba[3]};
}

// The file's lamps may be any: too bright, none, or about another place. With these a face towards
// the sun has the colour that the file gives it.
void light(mjvScene& scene) {
  constexpr std::array<float, 3> kSun{0.30F, -0.36F, -0.90F};
  constexpr float kAmbient = 0.52F;
  constexpr float kSunlight = 0.50F;
  constexpr float kSparkle = 0.08F;
  mjvLight sun{};
  std::copy(kSun.begin(), kSun.end(), sun.dir);
  sun.attenuation[0] = 1.0F;
  sun.cutoff = 180.0F;
  sun.directional = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    sun.ambient[i] = kAmbient;
    sun.diffuse[i] = kSunlight;
    sun.specular[i] = kSparkle;
  }
  scene.lights[0] = sun;
  scene.nlight = 1;
}

// Half sides of the box about a geom, in its own axes.
SpacePoint half_sides(const mjModel& model, int geom) {
  const mjtNum* const size = model.geom_size + static_cast<std::ptrdiff_t>(3) * geom;
  switch (model.geom_type[geom]) {
    case mjGEOM_SPHERE:
      return {size[0], size[0], size[0]};
    case mjGEOM_CAPSULE:
      return {size[0], size[0], size[1] + size[0]};
    case mjGEOM_CYLINDER:
      return {size[0], size[0], size[1]};
    default:
      return {size[0], size[1], size[2]};
  }
}

SolidShape solid_shape(const mjModel& model, int geom) {
  switch (model.geom_type[geom]) {
    case mjGEOM_SPHERE:
    case mjGEOM_ELLIPSOID:
      return SolidShape::kEllipsoid;
    case mjGEOM_CAPSULE:
    case mjGEOM_CYLINDER:
      return SolidShape::kCylinder;
    default:
      return SolidShape::kBox;
  }
}

SolidPlace solid_place(const mjModel& model, const mjData& data, int geom) {
  SolidPlace place;
  place.half_sides = half_sides(model, geom);
  std::copy_n(data.geom_xpos + static_cast<std::ptrdiff_t>(3) * geom, 3, place.centre.begin());
  std::copy_n(data.geom_xmat + static_cast<std::ptrdiff_t>(9) * geom, 9, place.axes.begin());
  return place;
}

// The surface of all parts of the vehicle where `data` has them, as triangles; meshes as boxes.
template <typename ColourOf>
std::vector<ColouredPoint> surface_of(const mjModel& model, const mjData& data,
                                      const ColourOf& colour) {
  std::vector<ColouredPoint> corners;
  for (int geom = 0; geom < model.ngeom; ++geom) {
    if (!is_vehicle(model, geom)) continue;
    append_solid(solid_shape(model, geom), solid_place(model, data, geom), colour(geom), corners);
  }
  return corners;
}

std::vector<SpacePoint> box_corners(const mjModel& model, const mjData& data, int geom) {
  const SpacePoint half = half_sides(model, geom);
  const mjtNum* const centre = data.geom_xpos + static_cast<std::ptrdiff_t>(3) * geom;
  const mjtNum* const axes = data.geom_xmat + static_cast<std::ptrdiff_t>(9) * geom;
  std::vector<SpacePoint> corners(8);
  for (unsigned corner = 0; corner < 8; ++corner) {
    for (std::size_t row = 0; row < 3; ++row) {
      double value = centre[row];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double sign = ((corner >> axis) & 1U) != 0U ? 1.0 : -1.0;
        value += sign * axes[3 * row + axis] * half[axis];
      }
      corners[corner][row] = value;
    }
  }
  return corners;
}

// z (m) of the lowest place that a geom reaches while the last hinge that tilts it turns.
double lowest_place(const mjModel& model, const mjData& data, int geom) {
  const std::vector<SpacePoint> corners = box_corners(model, data, geom);
  for (int body = model.geom_bodyid[geom]; body > 0; body = model.body_parentid[body]) {
    for (int joint = model.body_jntadr[body];
         joint < model.body_jntadr[body] + model.body_jntnum[body]; ++joint) {
      const mjtNum* const axis = data.xaxis + static_cast<std::ptrdiff_t>(3) * joint;
      const mjtNum* const anchor = data.xanchor + static_cast<std::ptrdiff_t>(3) * joint;
      if (model.jnt_type[joint] != mjJNT_HINGE || std::abs(axis[2]) > 1.0 - kAxisTolerance)
        continue;
      double reach = 0.0;
      for (const SpacePoint& corner : corners) {
        reach = std::max(
            reach, std::hypot(corner[0] - anchor[0], corner[1] - anchor[1], corner[2] - anchor[2]));
      }
      return anchor[2] - reach;
    }
  }
  double lowest = kInfinity;
  for (const SpacePoint& corner : corners) lowest = std::min(lowest, corner[2]);
  return lowest;
}

// Address in qpos of the first joint of `type` about or along `axis`, or -1.
int joint_address(const mjModel& model, int type, std::size_t axis) {
  for (int joint = 0; joint < model.njnt; ++joint) {
    const mjtNum* const direction = model.jnt_axis + static_cast<std::ptrdiff_t>(3) * joint;
    if (model.jnt_type[joint] == type && std::abs(direction[axis] - 1.0) < kAxisTolerance) {
      return model.jnt_qposadr[joint];
    }
  }
  return -1;
}

void set_pose(const mjModel& model, const PlanarPose& pose, mjtNum* qpos) {
  for (int joint = 0; joint < model.njnt; ++joint) {
    if (model.jnt_type[joint] == mjJNT_FREE) {
      mjtNum* const free = qpos + model.jnt_qposadr[joint];
      free[0] = pose.x;
      free[1] = pose.y;
      free[3] = std::cos(0.5 * pose.heading);
      free[4] = 0.0;
      free[5] = 0.0;
      free[6] = std::sin(0.5 * pose.heading);
      return;
    }
  }
  const std::array<std::pair<int, double>, 3> values{
      std::pair{joint_address(model, mjJNT_SLIDE, 0), pose.x},
      std::pair{joint_address(model, mjJNT_SLIDE, 1), pose.y},
      std::pair{joint_address(model, mjJNT_HINGE, 2), pose.heading}};
  for (const auto& [address, value] : values) {
    if (address >= 0) {
      qpos[address] = value;
    }
  }
}

}  // namespace

struct Vehicle::Simulator {
  ModelPointer model;
  DataPointer data;
  DataPointer ghost_data;
  mjvOption option{};
  mjvCamera camera{};
  mjvScene scene{};
  mjrContext context{};
  mjrRect viewport{};
  double length = 0.0;
  double lift = 0.0;                     // m, that everything is drawn higher
  std::vector<unsigned char> bottom_up;  // the picture as OpenGL has it, rows from the bottom

  Simulator(const std::string& path, int width, int height, bool raised)
      : model(load_model(path)), viewport{0, 0, width, height} {
    prepare_model(*model, width, height);
    data.reset(mj_makeData(model.get()));
    ghost_data.reset(mj_makeData(model.get()));
    if (!data || !ghost_data) {
      throw std::runtime_error("vehicle \"" + path + "\": MuJoCo cannot allocate its data");
    }
    mjv_defaultOption(&option);
    mjv_defaultCamera(&camera);
    mjv_defaultScene(&scene);
    mjr_defaultContext(&context);
    update_positions();
    measure_length();
    if (raised) lift_off();
    try {
      make_drawing_resources(path);
    } catch (...) {
      free_drawing_resources();
      throw;
    }
  }

  ~Simulator() { free_drawing_resources(); }
  Simulator(const Simulator&) = delete;
  Simulator& operator=(const Simulator&) = delete;

  void make_drawing_resources(const std::string& path) {
    mjv_makeScene(model.get(), &scene, model->ngeom + kSpareGeoms);
    for (const int flag : {mjRND_SHADOW, mjRND_REFLECTION, mjRND_SKYBOX, mjRND_FOG, mjRND_HAZE}) {
      scene.flags[flag] = 0;
    }
    mjr_makeContext(model.get(), &context, mjFONTSCALE_50);
    mjr_setBuffer(mjFB_OFFSCREEN, &context);
    if (context.currentBuffer != mjFB_OFFSCREEN || context.offWidth < viewport.width ||
        context.offHeight < viewport.height) {
      throw std::runtime_error("vehicle \"" + path + "\": no off-screen buffer of " +
                               std::to_string(viewport.width) + "x" +
                               std::to_string(viewport.height) + " pixels");
    }
  }

  void free_drawing_resources() {
    mjr_freeContext(&context);
    mjv_freeScene(&scene);
  }

  // What drawing needs of a forward pass, without contacts and dynamics.
  void update_positions() {
    mj_kinematics(model.get(), data.get());
    mj_comPos(model.get(), data.get());
    mj_camlight(model.get(), data.get());
    mj_tendon(model.get(), data.get());
    raise(*data);
  }

  void raise(mjData& moved) const {
    for (int geom = 0; geom < model->ngeom; ++geom) {
      moved.geom_xpos[static_cast<std::ptrdiff_t>(3) * geom + 2] += lift;
    }
  }

  // So that no part reaches the ground however its hinges turn.
  void lift_off() {
    constexpr double kGap = 0.05;  // m
    double lowest = 0.0;
    for (int geom = 0; geom < model->ngeom; ++geom) {
      if (is_vehicle(*model, geom)) lowest = std::min(lowest, lowest_place(*model, *data, geom));
    }
    if (lowest < 0.0) lift = kGap - lowest;
  }

  void measure_length() {
    std::array<double, 3> lower{kInfinity, kInfinity, kInfinity};
    std::array<double, 3> upper{-kInfinity, -kInfinity, -kInfinity};
    for (int geom = 0; geom < model->ngeom; ++geom) {
      if (!is_vehicle(*model, geom)) continue;
      for (const SpacePoint& corner : box_corners(*model, *data, geom)) {
        for (std::size_t i = 0; i < 3; ++i) {
          lower[i] = std::min(lower[i], corner[i]);
          upper[i] = std::max(upper[i], corner[i]);
        }
      }
    }
    length = std::max({upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2], 0.0});
  }
};

Vehicle::Vehicle(const std::string& mjcf_path, int width, int height, bool raised) {
  install_mujoco_guard();
  simulator_ = std::make_unique<Simulator>(mjcf_path, width, height, raised);
}

Vehicle::~Vehicle() = default;

void Vehicle::place(const Frame& frame) {
  const mjModel& model = *simulator_->model;
  std::vector<double> qpos = frame.qpos;
  if (qpos.empty()) {
    qpos.assign(model.qpos0, model.qpos0 + model.nq);
    set_pose(model, frame.pose, qpos.data());
  }
  if (qpos.size() != static_cast<std::size_t>(model.nq)) {
    throw std::invalid_argument("frame: qpos has " + std::to_string(qpos.size()) +
                                " values, the vehicle has " + std::to_string(model.nq));
  }
  for (const double value : qpos) {
    if (!std::isfinite(value)) {
      throw std::invalid_argument("frame: the vehicle's position is not finite");
    }
  }
  std::copy(qpos.begin(), qpos.end(), simulator_->data->qpos);
  simulator_->update_positions();
}

void Vehicle::draw(const View& view) {
  Simulator& s = *simulator_;
  mjr_setBuffer(mjFB_OFFSCREEN, &s.context);  // another vehicle may have drawn to its own
  mjv_updateScene(s.model.get(), s.data.get(), &s.option, nullptr, &s.camera, mjCAT_ALL, &s.scene);
  light(s.scene);
  // Our own lens instead of MuJoCo's: what is drawn later has the same.
  for (mjvGLCamera& eye : s.scene.camera) {
    for (std::size_t i = 0; i < 3; ++i) {
      eye.pos[i] = static_cast<float>(view.position[i]);
      eye.forward[i] = static_cast<float>(view.forward[i]);
      eye.up[i] = static_cast<float>(view.up[i]);
    }
    eye.frustum_center = 0.0F;
    eye.frustum_top = static_cast<float>(view.half_height);
    eye.frustum_bottom = static_cast<float>(-view.half_height);
    eye.frustum_near = static_cast<float>(view.near_plane);
    eye.frustum_far = static_cast<float>(view.far_plane);
  }
  mjr_render(s.viewport, &s.scene, &s.context);
}

void Vehicle::read_picture(Image& out) {
  Simulator& s = *simulator_;
  const auto row = 3 * static_cast<std::size_t>(s.viewport.width);
  const auto rows = static_cast<std::size_t>(s.viewport.height);
  s.bottom_up.resize(row * rows);
  out.width = s.viewport.width;
  out.height = s.viewport.height;
  out.rgb.resize(row * rows);
  mjr_readPixels(s.bottom_up.data(), nullptr, s.viewport, &s.context);
  for (std::size_t y = 0; y < rows; ++y) {
    std::copy_n(s.bottom_up.data() + (rows - 1 - y) * row, row, out.rgb.data() + y * row);
  }
}

std::vector<std::vector<PlanarPoint>> Vehicle::shadows() const {
  const mjModel& model = *simulator_->model;
  std::vector<std::vector<PlanarPoint>> outlines;
  for (int geom = 0; geom < model.ngeom; ++geom) {
    if (is_vehicle(model, geom)) {
      outlines.push_back(cast_shadow(box_corners(model, *simulator_->data, geom)));
    }
  }
  return outlines;
}

std::vector<ColouredPoint> Vehicle::ghost(const Frame& frame) {
  if (!frame.ghost) return {};
  const PlanarPose& pose = *frame.ghost;
  if (!std::isfinite(pose.x) || !std::isfinite(pose.y) || !std::isfinite(pose.heading)) {
    throw std::invalid_argument("frame: the ghost's pose is not finite");
  }
  const mjModel& model = *simulator_->model;
  mjData& data = *simulator_->ghost_data;
  std::copy_n(simulator_->data->qpos, model.nq, data.qpos);
  if (frame.ghost_qpos.size() == static_cast<std::size_t>(model.nq)) {
    std::copy(frame.ghost_qpos.begin(), frame.ghost_qpos.end(), data.qpos);
  } else {
    set_pose(model, pose, data.qpos);
  }
  mj_kinematics(&model, &data);
  simulator_->raise(data);
  constexpr float kNearest = 0.35F;  // of its opacity, where it stands in the vehicle
  const double apart = std::hypot(pose.x - frame.pose.x, pose.y - frame.pose.y);
  const auto share = static_cast<float>(length() > 0.0 ? std::min(apart / length(), 1.0) : 1.0);
  const Colour colour =
      palette::kGhost.with_alpha(palette::kGhost.alpha * (kNearest + (1.0F - kNearest) * share));
  return surface_of(model, data, [&colour](int) { return colour; });
}

VehicleMarks Vehicle::marks(const Frame& frame) {
  constexpr float kHiddenOpacity = 0.55F;
  const mjModel& model = *simulator_->model;
  return {.length = length(),
          .shadows = shadows(),
          .surface = surface_of(
              model, *simulator_->data,
              [&model](int geom) { return colour_of(model, geom).with_alpha(kHiddenOpacity); }),
          .ghost = ghost(frame)};
}

double Vehicle::length() const { return simulator_->length; }

double Vehicle::lift() const { return simulator_->lift; }

}  // namespace qsmpc::render
