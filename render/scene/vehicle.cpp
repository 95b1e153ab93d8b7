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
#include "render/palette.hpp"
#include "render/scene/mujoco_guard.hpp"
#include "render/scene/vehicle_geometry.hpp"

namespace qsmpc::render {
namespace {

constexpr int kSpareGeoms = 64;  // MuJoCo's own decorations
constexpr int kHiddenGroup = 5;  // not a visible group
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
  // MuJoCo's XML reader has process-wide state.
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

// ScenePainter draws the ground and the sky: MuJoCo's textured ones take most of a frame's time.
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

// The file's lights may be too bright, missing or aimed elsewhere. With these lights a face towards
// the sun has the colour given by the file.
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
  double lift = 0.0;                     // m, by which everything is raised
  std::vector<unsigned char> bottom_up;  // OpenGL's picture, rows from the bottom

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

  // The part of a forward pass that drawing needs, without contacts and dynamics.
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

  // Raises the vehicle so that no part reaches the ground for any angles of its hinges.
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
  mjr_setBuffer(mjFB_OFFSCREEN, &s.context);  // another vehicle may have set its own
  mjv_updateScene(s.model.get(), s.data.get(), &s.option, nullptr, &s.camera, mjCAT_ALL, &s.scene);
  light(s.scene);
  // The view's lens instead of MuJoCo's, as for later drawing.
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
  constexpr float kNearest = 0.35F;  // of its opacity, where it coincides with the vehicle
  const double apart = std::hypot(pose.x - frame.pose.x, pose.y - frame.pose.y);
  const auto share = static_cast<float>(length() > 0.0 ? std::min(apart / length(), 1.0) : 1.0);
  const Colour colour =
      palette::kGhost.with_alpha(palette::kGhost.alpha * (kNearest + (1.0F - kNearest) * share));
  return vehicle_surface(model, data, [&colour](int) { return colour; });
}

VehicleMarks Vehicle::marks(const Frame& frame) {
  constexpr float kHiddenOpacity = 0.55F;
  const mjModel& model = *simulator_->model;
  return {.length = length(),
          .shadows = shadows(),
          .surface = vehicle_surface(
              model, *simulator_->data,
              [&model](int geom) { return colour_of(model, geom).with_alpha(kHiddenOpacity); }),
          .ghost = ghost(frame)};
}

double Vehicle::length() const { return simulator_->length; }

std::optional<SpacePoint> Vehicle::top() const {
  const mjModel& model = *simulator_->model;
  std::optional<SpacePoint> highest;
  for (int geom = 0; geom < model.ngeom; ++geom) {
    if (!is_vehicle(model, geom)) continue;
    for (const SpacePoint& corner : box_corners(model, *simulator_->data, geom)) {
      if (!highest || corner[2] > (*highest)[2]) highest = corner;
    }
  }
  return highest;
}

double Vehicle::lift() const { return simulator_->lift; }

}  // namespace qsmpc::render
