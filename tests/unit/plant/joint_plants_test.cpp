// Plants in MuJoCo's own joints follow their systems' equations, with the integrator's order.
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "models/random/random_numbers.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/plant/shipped_plants.hpp"

namespace qsmpc::harness {
namespace joint_plants_test {

constexpr double kPeriod = 0.1;  // s
constexpr int kPeriods = 20;

struct JointPlant {
  std::string system;
  std::string mjcf;
  std::vector<double> start;
  std::vector<double> input_scale;  // of random inputs
  double coarse_step;               // s
  int order;                        // of convergence
  /// The system whose small steps approximate the same continuous-time equations.
  std::string reference_system;
  models::ParameterMap parameters{};  // of that system, in addition to the defaults
};

std::ostream& operator<<(std::ostream& out, const JointPlant& plant) { return out << plant.mjcf; }

Eigen::VectorXd vector_of(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

Eigen::VectorXd input_of(const JointPlant& plant, int period) {
  const Eigen::VectorXd scale = vector_of(plant.input_scale);
  const models::RandomKey key{.seed = 4,
                              .stream = models::RandomStream::kInput,
                              .step = static_cast<std::uint64_t>(period)};
  return scale.cwiseProduct(2.0 * models::uniform_sample(scale.size(), key).array().matrix() -
                            Eigen::VectorXd::Ones(scale.size()));
}

/// The states at the ends of the periods, from small steps of the analytic system.
std::vector<Eigen::VectorXd> analytic_states(const JointPlant& plant, int steps_per_period) {
  const auto model =
      models::make_dynamics(plant.reference_system, plant.parameters, kPeriod / steps_per_period);
  models::StateBatch state = vector_of(plant.start);
  models::StateBatch next = state;
  std::vector<Eigen::VectorXd> states;
  for (int k = 0; k < kPeriods; ++k) {
    const models::StateBatch input = input_of(plant, k);
    for (int i = 0; i < steps_per_period; ++i) {
      model->step(state, input, next);
      state.swap(next);
    }
    states.emplace_back(state.col(0));
  }
  return states;
}

/// The largest deviation from `truth` over periods and states.
double setup_error(const JointPlant& plant, const MujocoPlantSetup& setup,
                   const std::vector<Eigen::VectorXd>& truth) {
  const auto vehicle = make_mujoco_plant(setup);
  vehicle->reset(vector_of(plant.start));
  double error = 0.0;
  for (int k = 0; k < kPeriods; ++k) {
    const PlantStep step = vehicle->advance(
        input_of(plant, k), Eigen::VectorXd::Zero(static_cast<Eigen::Index>(plant.start.size())));
    EXPECT_FALSE(step.fault.has_value()) << *step.fault;
    error =
        std::max(error, (step.state - truth[static_cast<std::size_t>(k)]).cwiseAbs().maxCoeff());
  }
  return error;
}

/// The same for the shipped file.
double plant_error(const JointPlant& plant, double time_step,
                   const std::vector<Eigen::VectorXd>& truth) {
  MujocoPlantSetup setup = shipped_setup(plant.system, plant.mjcf, kPeriod);
  setup.time_step = time_step;
  return setup_error(plant, setup, truth);
}

class JointPlants : public ::testing::TestWithParam<JointPlant> {};

TEST_P(JointPlants, converge_to_their_systems_with_the_integrators_order) {
  const JointPlant& plant = GetParam();
  // The reference is of first order at worst; Richardson extrapolation over two step sizes removes
  // that.
  constexpr int kFine = 4000;
  const std::vector<Eigen::VectorXd> coarse = analytic_states(plant, kFine);
  std::vector<Eigen::VectorXd> truth = analytic_states(plant, 2 * kFine);
  if (plant.order == 1) {
    for (std::size_t k = 0; k < truth.size(); ++k) truth[k] = 2.0 * truth[k] - coarse[k];
  }
  const double first = plant_error(plant, plant.coarse_step, truth);
  const double second = plant_error(plant, plant.coarse_step / 2.0, truth);
  const double third = plant_error(plant, plant.coarse_step / 4.0, truth);
  ::testing::Test::RecordProperty("error_at_coarse_step", std::to_string(first));
  EXPECT_NEAR(std::log2(first / second), plant.order, 0.2);
  EXPECT_NEAR(std::log2(second / third), plant.order, 0.2);
}

INSTANTIATE_TEST_SUITE_P(all, JointPlants,
                         ::testing::Values(JointPlant{.system = "dubins",
                                                      .mjcf = "dubins_planar.xml",
                                                      .start = {1.0, -2.0, 0.7},
                                                      .input_scale = {2.0},
                                                      .coarse_step = 0.002,
                                                      .order = 1,
                                                      .reference_system = "dubins_rk4"},
                                           JointPlant{.system = "bicycle",
                                                      .mjcf = "bicycle_planar.xml",
                                                      .start = {1.0, -2.0, 0.7, 8.0, 0.2, 0.1},
                                                      .input_scale = {2.0, 0.2},
                                                      .coarse_step = 0.001,
                                                      .order = 1,
                                                      .reference_system = "bicycle"},
                                           JointPlant{.system = "cart_pole",
                                                      .mjcf = "cart_pole.xml",
                                                      .start = {0.5, -0.3, 2.0, 1.0},
                                                      .input_scale = {10.0},
                                                      .coarse_step = 0.02,
                                                      .order = 4,
                                                      .reference_system = "cart_pole"}),
                         [](const auto& test) { return test.param.system; });

// A third-party file whose joints are damped.
TEST(JointPlants, a_damped_cart_pole_answers_as_the_damped_system) {
  std::ostringstream stream;
  stream << std::ifstream(QSMPC_SOURCE_DIR "/models/mjcf/cart_pole.xml").rdbuf();
  const std::string slide = R"(<joint name="slide" )";
  const std::string hinge = R"(<joint name="hinge" )";
  std::string text = stream.str();
  text.insert(text.find(slide) + slide.size(), R"(damping="2" )");
  text.insert(text.find(hinge) + hinge.size(), R"(damping="0.05" )");
  const testing::TemporaryFolder folder;

  JointPlant plant{.system = "cart_pole",
                   .mjcf = folder.file("damped.xml", text),
                   .start = {0.5, -0.3, 2.0, 1.0},
                   .input_scale = {10.0},
                   .coarse_step = 0.01,
                   .order = 4,
                   .reference_system = "cart_pole",
                   .parameters = {{"cart_damping", 2.0}, {"pole_damping", 0.05}}};
  MujocoPlantSetup setup = shipped_setup(plant.system, "cart_pole.xml", kPeriod);
  setup.mjcf = plant.mjcf;
  setup.time_step = plant.coarse_step;
  // Fourth-order Runge-Kutta with steps of 0.01 s, over 2 s.
  EXPECT_LT(setup_error(plant, setup, analytic_states(plant, 1000)), 1e-4);
  plant.parameters = {};
  EXPECT_GT(setup_error(plant, setup, analytic_states(plant, 1000)), 0.5);
}

TEST(JointPlants, the_slider_is_the_double_integrator) {
  const JointPlant plant{.system = "double_integrator",
                         .mjcf = "double_integrator_slider.xml",
                         .start = {0.5, -0.3},
                         .input_scale = {2.0},
                         .coarse_step = 0.1,
                         .order = 4,
                         .reference_system = "double_integrator"};
  const std::vector<Eigen::VectorXd> truth = analytic_states(plant, 1);
  EXPECT_LT(plant_error(plant, 0.1, truth), 1e-13);
  EXPECT_LT(plant_error(plant, 0.01, truth), 1e-13);
}

TEST(JointPlants, the_crossed_rails_are_the_point_mass) {
  const JointPlant plant{.system = "point_mass",
                         .mjcf = "point_mass.xml",
                         .start = {0.5, -0.3, 0.8, -1.1},
                         .input_scale = {2.0, 1.0},
                         .coarse_step = 0.1,
                         .order = 4,
                         .reference_system = "point_mass"};
  const std::vector<Eigen::VectorXd> truth = analytic_states(plant, 1);
  EXPECT_LT(plant_error(plant, 0.1, truth), 1e-13);
  EXPECT_LT(plant_error(plant, 0.01, truth), 1e-13);
}

}  // namespace joint_plants_test
}  // namespace qsmpc::harness
