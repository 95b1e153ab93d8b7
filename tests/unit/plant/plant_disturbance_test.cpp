// The effect of disturbances on each plant that offers them, period by period, compared with an
// undisturbed twin.
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include <boost/math/distributions/normal.hpp>
#include <gtest/gtest.h>

#include "models/random/random_numbers.hpp"
#include "tests/support/effort.hpp"
#include "tests/unit/plant/shipped_plants.hpp"

namespace qsmpc::harness {
namespace plant_disturbance_test {

/// Number of periods: a disturbance by force is found by shooting, with several simulations per
/// period. The limits below depend on this number.
int periods_of(bool force) {
  return force ? testing::by_effort(100, 150, 2000) : testing::by_effort(500, 750, 2000);
}

struct Disturbed {
  std::string name;
  std::string system;
  std::string mjcf;
  std::vector<double> start;  // before each period; the heading is drawn
  std::vector<double> input_scale;
  std::vector<double> variances;  // planned
  bool force = false;
};

std::ostream& operator<<(std::ostream& out, const Disturbed& plant) { return out << plant.name; }

Eigen::VectorXd vector_of(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// A covariance with these variances and a correlation of 0.3 between the first two states.
Eigen::MatrixXd covariance_of(const Disturbed& plant) {
  Eigen::MatrixXd covariance = vector_of(plant.variances).asDiagonal();
  constexpr double kCorrelation = 0.3;
  covariance(0, 1) = kCorrelation * std::sqrt(covariance(0, 0) * covariance(1, 1));
  covariance(1, 0) = covariance(0, 1);
  return covariance;
}

class PlantDisturbance : public ::testing::TestWithParam<Disturbed> {};

TEST_P(PlantDisturbance, has_the_planned_covariance) {
  const Disturbed& plant = GetParam();
  const int periods = periods_of(plant.force);
  const Eigen::MatrixXd covariance = covariance_of(plant);
  const Eigen::Index dim = covariance.rows();
  MujocoPlantSetup setup = shipped_setup(plant.system, plant.mjcf);
  const auto twin = make_mujoco_plant(setup);
  if (plant.force) setup.force_covariance = covariance;
  const auto disturbed = make_mujoco_plant(setup);
  const models::GaussianSampler noise(Eigen::VectorXd::Zero(dim), covariance);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(dim);
  Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(dim, dim);
  Eigen::VectorXd misses = Eigen::VectorXd::Zero(dim);
  for (int k = 0; k < periods; ++k) {
    const auto step = static_cast<std::uint64_t>(k);
    const Eigen::VectorXd random =
        2.0 * models::uniform_sample(
                  4, {.seed = 5, .stream = models::RandomStream::kInput, .step = step})
                  .array() -
        1.0;
    Eigen::VectorXd start = vector_of(plant.start);
    if (setup.system.heading >= 0) start[setup.system.heading] = 3.0 * random[3];
    const Eigen::VectorXd scale = vector_of(plant.input_scale);
    const Eigen::VectorXd input = scale.cwiseProduct(random.head(scale.size()));
    const Eigen::VectorXd planned = noise.sample({.seed = 5, .step = step});
    twin->reset(start);
    disturbed->reset(start);
    const PlantStep moved = disturbed->advance(input, planned);
    ASSERT_FALSE(moved.fault.has_value()) << *moved.fault;
    const Eigen::VectorXd effect =
        moved.state - twin->advance(input, Eigen::VectorXd::Zero(dim)).state;
    sum += effect;
    squares += effect * effect.transpose();
    misses += (effect - planned).cwiseAbs2();
  }
  // All entries of mean and covariance are jointly within their limits with 99 % (Bonferroni).
  const double entries = static_cast<double>(dim * (dim + 3)) / 2.0;
  const double limit = boost::math::quantile(boost::math::normal(), 1.0 - 0.01 / (2.0 * entries));
  const Eigen::VectorXd mean = sum / periods;
  const Eigen::MatrixXd found = squares / periods - mean * mean.transpose();
  for (Eigen::Index i = 0; i < dim; ++i) {
    EXPECT_LE(std::abs(mean[i]), limit * std::sqrt(covariance(i, i) / periods)) << i;
    for (Eigen::Index j = 0; j <= i; ++j) {
      const double deviation = std::sqrt(
          (covariance(i, i) * covariance(j, j) + covariance(i, j) * covariance(i, j)) / periods);
      EXPECT_LE(std::abs(found(i, j) - covariance(i, j)), limit * deviation) << i << ' ' << j;
    }
    RecordProperty("relative_miss_" + std::to_string(i),
                   std::to_string(std::sqrt(misses[i] / periods / covariance(i, i))));
  }
}

std::vector<Disturbed> disturbed_plants() {
  const Disturbed planar{.name = "dubins_planar",
                         .system = "dubins",
                         .mjcf = "dubins_planar.xml",
                         .start = {1.0, -2.0, 0.0},
                         .input_scale = {2.0},
                         .variances = {0.01, 0.01, 0.001}};
  Disturbed car = planar;
  car.name = "dubins_car";
  car.mjcf = "dubins_car.xml";
  const Disturbed bicycle{.name = "bicycle_planar",
                          .system = "bicycle",
                          .mjcf = "bicycle_planar.xml",
                          .start = {1.0, -2.0, 0.0, 8.0, 0.0, 0.0},
                          .input_scale = {2.0, 0.2},
                          .variances = {0.01, 0.01, 0.001, 0.01, 0.01, 0.001}};
  Disturbed full_size = bicycle;
  full_size.name = "bicycle_car";
  full_size.mjcf = "bicycle_car.xml";
  const Disturbed slider{.name = "slider",
                         .system = "double_integrator",
                         .mjcf = "double_integrator_slider.xml",
                         .start = {0.5, -0.3},
                         .input_scale = {2.0},
                         .variances = {0.001, 0.001}};
  const Disturbed cart_pole{.name = "cart_pole",
                            .system = "cart_pole",
                            .mjcf = "cart_pole.xml",
                            .start = {0.5, -0.3, 0.4, 1.0},
                            .input_scale = {10.0},
                            .variances = {0.001, 0.002, 0.001, 0.004}};
  std::vector<Disturbed> all;
  for (const Disturbed& plant : {planar, car, bicycle, full_size, slider, cart_pole}) {
    all.push_back(plant);
    all.push_back(plant);
    all.back().name += "_by_force";
    all.back().force = true;
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(all, PlantDisturbance, ::testing::ValuesIn(disturbed_plants()),
                         [](const auto& test) { return test.param.name; });

}  // namespace plant_disturbance_test
}  // namespace qsmpc::harness
