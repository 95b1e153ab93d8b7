// Forces that a MuJoCo model cannot express, computed by the plant at every time step: tyre forces
// at the axles of a planar body or at wheels on the ground. Private to the MuJoCo plant.
#pragma once

#include <variant>
#include <vector>

#include <Eigen/Core>

#include "harness/mujoco/named_model.hpp"
#include "harness/scenario/plant_mapping.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// The forces of Eq. 5-4 on a body in the plane. With v, v_y the longitudinal and lateral speed at
/// its origin, ω its yaw rate, and l the distance of an axle's site ahead of the origin,
///
///     across at an axle:  −C ((v_y + l ω)/max(|v|, slowest) − δ),  δ at the front axle only,
///     along:              m (a − v_y ω),
///
/// where m is the mass of the whole vehicle. The second force makes the rate of the forward speed
/// equal to the commanded a: it cancels the v_y ω term, which a body in the plane has and the
/// equations do not.
class AxleForceBinding {
 public:
  AxleForceBinding(const NamedModel& named, const AxleForces& forces,
                   const models::SystemDescription& system);

  /// Adds the forces to data.xfrc_applied. data: after mj_step1. input: input_dim.
  void apply(mjData& data, const Eigen::VectorXd& input) const;
  /// Multiplies the stiffnesses.
  void scale_friction(double factor);

 private:
  const mjModel& model_;
  int body_;
  Eigen::Index acceleration_;
  Eigen::Index steering_;
  int front_site_;
  int rear_site_;
  double front_stiffness_;
  double rear_stiffness_;
  double slowest_;
  double mass_;
};

/// Forces of tyres that touch the ground. At the point below a wheel's centre, with the wheel's
/// longitudinal and lateral speed (v, v_y), spin Ω about its axle and radius r,
///
///     s = (C_x (rΩ − v), −C_y v_y)/max(|v|, slowest),   force = s μN g(|s|/μN)/|s|,
///
/// with g(ρ) = ρ − ρ²/3 + ρ³/27 for ρ < 3 and 1 otherwise (Fiala's brush model): linear for small
/// slip, limited by friction times load N. With h the time step and λ the rate at which such a
/// force drives its slip to zero, C_x is divided by 1 + hλ and C_y by max(1, 2hλ), so that a force
/// never reverses its slip within a step, at any speed. The longitudinal force is unaffected, since
/// the axle's torque determines it; C_y is reduced only at speeds near `slowest`. N is the ground's
/// contact force in the last step, or the wheel's static load.
class TyreForceBinding {
 public:
  TyreForceBinding(const NamedModel& named, const TyreForces& forces);

  /// Loads of the wheels, N.
  [[nodiscard]] const Eigen::VectorXd& loads() const { return loads_; }
  void set_loads(const Eigen::VectorXd& loads) { loads_ = loads; }
  /// Records the loads. data: after a whole step or mj_forward.
  void weigh(const mjData& data);
  /// Adds the forces to data.xfrc_applied. data: after mj_step1.
  void apply(mjData& data) const;

  /// Multiplies friction and the cornering stiffness.
  void scale_friction(double factor);

 private:
  struct Wheel {
    int body;
    int joint;
    int dof;
    double radius;     ///< m
    double inertia;    ///< of the wheel about its axle, kg m²
    double stiffness;  ///< C_y, N/rad
  };

  const mjModel& model_;
  double longitudinal_stiffness_;
  double friction_;
  double slowest_;
  std::vector<Wheel> wheels_;
  Eigen::VectorXd loads_;  // N
};

}  // namespace qsmpc::harness
