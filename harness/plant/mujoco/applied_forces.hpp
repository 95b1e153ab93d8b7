// Forces that a MuJoCo model cannot express itself and that the plant works out at every time step:
// tyres, at axles of a body in the plane or at wheels on the ground. Private to the MuJoCo plant.
#pragma once

#include <variant>
#include <vector>

#include <Eigen/Core>

#include "harness/mujoco/named_model.hpp"
#include "harness/scenario/plant_mapping.hpp"
#include "models/dynamics/dynamics.hpp"

namespace qsmpc::harness {

/// The forces of Eq. 5-4 on a body in the plane. With v, v_y the speeds along and across it at its
/// origin, ω its yaw rate, and l the distance of an axle's site before the origin,
///
///     across at an axle:  −C ((v_y + l ω)/max(|v|, slowest) − δ),  δ at the front axle only,
///     along:              m (a − v_y ω),
///
/// where m is the mass of the whole vehicle. The second is what makes the forward speed's rate
/// equal to the wanted a: the equations have no v_y ω in it, and a body in the plane has.
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

/// Tyres of wheels that stand on the ground. At the point below a wheel's centre, at the speed
/// (v, v_y) along and across the wheel, with the wheel's spin Ω about its axle and radius r,
///
///     s = (C_x (rΩ − v), −C_y v_y)/max(|v|, slowest),   force = s μN g(|s|/μN)/|s|,
///
/// with the Fiala brush's g(ρ) = ρ − ρ²/3 + ρ³/27 below ρ = 3 and 1 above: linear in small slips,
/// limited by friction times load N. With h the time step and λ the rate at which such a force
/// brings its slip to zero, C_x is taken over 1 + hλ and C_y over max(1, 2hλ): a force then never
/// turns its slip round within a step, at any speed. Along, this leaves the force as it is, since
/// it is the axle's torque that determines it; across, C_y is cut at speeds near `slowest` only.
/// N is what the ground pressed with in the last step, or what the wheel carries at rest.
class TyreForceBinding {
 public:
  TyreForceBinding(const NamedModel& named, const TyreForces& forces);

  /// Of the wheels, N.
  [[nodiscard]] const Eigen::VectorXd& loads() const { return loads_; }
  void set_loads(const Eigen::VectorXd& loads) { loads_ = loads; }
  /// Notes the loads. data: after a whole step or mj_forward.
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
