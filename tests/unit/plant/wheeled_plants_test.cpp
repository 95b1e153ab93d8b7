// The wheeled cars: stable over their whole range, with tyres of the specified stiffness.
#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <gtest/gtest.h>

#include "models/dynamics/bicycle.hpp"
#include "models/random/random_numbers.hpp"
#include "tests/support/effort.hpp"
#include "tests/unit/plant/shipped_plants.hpp"

namespace qsmpc::harness {
namespace wheeled_plants_test {

using testing::by_effort;

constexpr double kPeriod = 0.1;  // s

/// 20 seconds of driving, a minute with --slow.
int period_count() { return by_effort(50, 200, 600); }

double uniform(std::uint64_t seed, int period, Eigen::Index which, double lower, double upper) {
  const Eigen::VectorXd values =
      models::uniform_sample(2, {.seed = seed,
                                 .stream = models::RandomStream::kInput,
                                 .step = static_cast<std::uint64_t>(period)});
  return lower + (upper - lower) * values[which];
}

/// How upright a sprung free body is: the cosine of its tilt.
double uprightness(const MotionSample& sample) {
  const Eigen::Quaterniond rotation(sample.qpos[3], sample.qpos[4], sample.qpos[5], sample.qpos[6]);
  return (rotation * Eigen::Vector3d::UnitZ()).z();
}

/// Parameters: the simulator's time step (s) and the speed (m/s).
class SmallCar : public ::testing::TestWithParam<std::tuple<double, double>> {};

TEST_P(SmallCar, is_stable_under_random_inputs) {
  const auto [time_step, speed] = GetParam();
  MujocoPlantSetup setup = shipped_setup("dubins", "dubins_car.xml");
  setup.parameters["speed"] = speed;
  setup.time_step = time_step;
  const auto car = make_mujoco_plant(setup);
  const MotionSample start = car->reset(Eigen::Vector3d(0.0, 0.0, 0.0));
  Eigen::VectorXd before = car->state();
  for (int k = 0; k < period_count(); ++k) {
    const Eigen::VectorXd input = Eigen::VectorXd::Constant(1, uniform(1, k, 0, -2.0, 2.0));
    const PlantStep step = car->advance(input, Eigen::Vector3d::Zero());
    ASSERT_FALSE(step.fault.has_value()) << *step.fault;
    for (const MotionSample& sample : step.motion) {
      ASSERT_GT(uprightness(sample), 0.98) << sample.time;
      ASSERT_NEAR(sample.qpos[2], start.qpos[2], 0.01) << sample.time;
    }
    const double way = (step.state - before).head<2>().norm();
    ASSERT_NEAR(way, speed * kPeriod, 0.12 * speed * kPeriod + 0.004) << k;
    before = step.state;
  }
}

INSTANTIATE_TEST_SUITE_P(all, SmallCar,
                         ::testing::Combine(::testing::Values(0.0005, 0.001, 0.002),
                                            ::testing::Values(0.5, 1.0, 1.5, 2.0, 3.0)));

double kinetic_energy(const models::ParameterMap& constants, const Eigen::VectorXd& state) {
  const double forward = state[models::Bicycle::kLongitudinalSpeed];
  const double lateral = state[models::Bicycle::kLateralSpeed];
  const double yaw_rate = state[models::Bicycle::kYawRate];
  return 0.5 * constants.at("mass") * (forward * forward + lateral * lateral) +
         0.5 * constants.at("yaw_inertia") * yaw_rate * yaw_rate;
}

/// Parameters: as above. The acceleration is random about the value that holds the speed.
class FullSizeCar : public ::testing::TestWithParam<std::tuple<double, double>> {};

TEST_P(FullSizeCar, is_stable_under_random_inputs) {
  const auto [time_step, speed] = GetParam();
  MujocoPlantSetup setup = shipped_setup("bicycle", "bicycle_car.xml");
  setup.time_step = time_step;
  const auto car = make_mujoco_plant(setup);
  Eigen::VectorXd state(6);
  state << 0.0, 0.0, 0.0, speed, 0.0, 0.0;
  const MotionSample start = car->reset(state);
  for (int k = 0; k < period_count(); ++k) {
    const double forward = car->state()[models::Bicycle::kLongitudinalSpeed];
    const double acceleration =
        std::clamp(2.0 * (speed - forward) + uniform(2, k, 0, -2.0, 2.0), -5.0, 2.0);
    const double steering = uniform(2, k, 1, -0.78, 0.78);
    const PlantStep step =
        car->advance(Eigen::Vector2d(acceleration, steering), Eigen::VectorXd::Zero(6));
    ASSERT_FALSE(step.fault.has_value()) << *step.fault;
    for (const MotionSample& sample : step.motion) {
      ASSERT_GT(uprightness(sample), 0.97) << sample.time;
      ASSERT_NEAR(sample.qpos[2], start.qpos[2], 0.12) << sample.time;
    }
    // At speed, full lock makes it slide and spin; it must not gain energy.
    const double most = 0.5 * setup.parameters.at("mass") * (speed + 1.5) * (speed + 1.5);
    ASSERT_LT(kinetic_energy(setup.parameters, step.state), most) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(all, FullSizeCar,
                         ::testing::Combine(::testing::Values(0.0005, 0.001, 0.002),
                                            ::testing::Values(1.0, 3.0, 8.0, 15.0)));

/// The stiffnesses of both axles, N/rad, from steady cornering at small slip: with both derivatives
/// zero, l_f F_f = l_r F_r and F_f + F_r = m v ω, and slip angles from the speeds.
Eigen::Vector2d identified_stiffnesses(double speed, double steering) {
  MujocoPlantSetup setup = shipped_setup("bicycle", "bicycle_car.xml");
  const auto car = make_mujoco_plant(setup);
  const models::ParameterMap& constants = setup.parameters;
  const double front = constants.at("front_axle_distance");
  const double rear = constants.at("rear_axle_distance");
  Eigen::VectorXd state(6);
  state << 0.0, 0.0, 0.0, speed, 0.0, 0.0;
  car->reset(state);
  for (int k = 0; k < 60; ++k) {
    const double acceleration = 2.0 * (speed - car->state()[models::Bicycle::kLongitudinalSpeed]);
    (void)car->advance(Eigen::Vector2d(acceleration, steering), Eigen::VectorXd::Zero(6));
  }
  state = car->state();
  const double forward = state[models::Bicycle::kLongitudinalSpeed];
  const double lateral = state[models::Bicycle::kLateralSpeed];
  const double yaw_rate = state[models::Bicycle::kYawRate];
  const double force = constants.at("mass") * forward * yaw_rate;
  const double front_slip = (lateral + front * yaw_rate) / forward - steering;
  const double rear_slip = (lateral - rear * yaw_rate) / forward;
  return {-force * rear / (front + rear) / front_slip, -force * front / (front + rear) / rear_slip};
}

TEST(FullSizeCar, corners_on_the_stiffnesses_of_table_b_2) {
  const models::ParameterMap constants = default_parameters("bicycle");
  for (const double speed : {8.0, 15.0}) {
    const Eigen::Vector2d found = identified_stiffnesses(speed, 0.01);
    RecordProperty("front_at_" + std::to_string(static_cast<int>(speed)), std::to_string(found[0]));
    RecordProperty("rear_at_" + std::to_string(static_cast<int>(speed)), std::to_string(found[1]));
    EXPECT_NEAR(found[0] / -constants.at("front_tyre_stiffness"), 1.0, 0.05);
    EXPECT_NEAR(found[1] / -constants.at("rear_tyre_stiffness"), 1.0, 0.05);
  }
}

TEST(FullSizeCar, gains_the_acceleration_that_is_asked_for) {
  const MujocoPlantSetup setup = shipped_setup("bicycle", "bicycle_car.xml");
  const auto car = make_mujoco_plant(setup);
  Eigen::VectorXd state(6);
  state << 0.0, 0.0, 0.0, 10.0, 0.0, 0.0;
  car->reset(state);
  Eigen::VectorXd before = car->state();
  for (int k = 0; k < 10; ++k) {
    before = car->state();
    (void)car->advance(Eigen::Vector2d(1.0, 0.0), Eigen::VectorXd::Zero(6));
  }
  const double gained = car->state()[models::Bicycle::kLongitudinalSpeed] -
                        before[models::Bicycle::kLongitudinalSpeed];
  EXPECT_NEAR(gained, kPeriod, 0.002 * kPeriod);
}

/// Shipped car: system, file, initial state, noise variances.
struct PushedCar {
  std::string system;
  std::string mjcf;
  std::vector<double> start;
  std::vector<double> variances;
  double speed;  // m/s
};

std::ostream& operator<<(std::ostream& out, const PushedCar& car) { return out << car.mjcf; }

class PushedCars : public ::testing::TestWithParam<PushedCar> {};

// A vehicle that had turned over or slid sideways would not advance by its speed in the next
// period.
TEST_P(PushedCars, drive_on_upright_under_forces_of_several_times_their_weight) {
  const PushedCar& tested = GetParam();
  MujocoPlantSetup setup = shipped_setup(tested.system, tested.mjcf);
  const auto dim = static_cast<Eigen::Index>(tested.start.size());
  const Eigen::Map<const Eigen::VectorXd> start(tested.start.data(), dim);
  const Eigen::Map<const Eigen::VectorXd> variances(tested.variances.data(), dim);
  setup.force_covariance = variances.asDiagonal();
  const auto car = make_mujoco_plant(setup);
  car->reset(start);
  const models::GaussianSampler noise(Eigen::VectorXd::Zero(dim), setup.force_covariance);
  Eigen::VectorXd before = car->state();
  for (int k = 0; k < 100; ++k) {
    Eigen::VectorXd input =
        Eigen::VectorXd::Zero(static_cast<Eigen::Index>(setup.system.inputs.size()));
    if (dim > 3) input[0] = std::clamp(2.0 * (tested.speed - before[3]), -5.0, 2.0);
    const Eigen::VectorXd planned =
        noise.sample({.seed = 6, .step = static_cast<std::uint64_t>(k)});
    const PlantStep step = car->advance(input, planned);
    ASSERT_FALSE(step.fault.has_value()) << *step.fault;
    ASSERT_GT(uprightness(step.motion.back()), 0.99) << k;
    const double speed = dim > 3 ? before[3] : tested.speed;
    const Eigen::Vector2d way = (step.state - before - planned).head<2>();
    ASSERT_NEAR(way.norm(), speed * kPeriod, 0.06 + 0.05 * speed * kPeriod) << k;
    before = step.state;
  }
}

INSTANTIATE_TEST_SUITE_P(all, PushedCars,
                         ::testing::Values(PushedCar{.system = "dubins",
                                                     .mjcf = "dubins_car.xml",
                                                     .start = {0.0, 0.0, 0.0},
                                                     .variances = {0.01, 0.01, 0.001},
                                                     .speed = 1.5},
                                           PushedCar{
                                               .system = "bicycle",
                                               .mjcf = "bicycle_car.xml",
                                               .start = {0.0, 0.0, 0.0, 8.0, 0.0, 0.0},
                                               .variances = {0.01, 0.01, 0.001, 0.01, 0.01, 0.001},
                                               .speed = 8.0}));

}  // namespace wheeled_plants_test
}  // namespace qsmpc::harness
