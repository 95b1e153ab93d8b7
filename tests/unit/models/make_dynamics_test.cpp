// The table of systems refuses unknown names and lists the known ones.
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "models/dynamics/dynamics.hpp"

namespace qsmpc::models {
namespace make_dynamics_test {

using ::testing::HasSubstr;

std::string refusal_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "nothing was refused";
}

TEST(MakeDynamics, unknown_system_is_refused_with_the_known_names) {
  const std::string message = refusal_of([] { (void)make_dynamics("hovercraft", {}, 0.1); });
  EXPECT_THAT(message, HasSubstr("hovercraft"));
  for (const SystemEntry& entry : systems()) EXPECT_THAT(message, HasSubstr(entry.name));
}

TEST(MakeDynamics, unknown_parameter_is_refused_with_the_known_names) {
  for (const SystemEntry& entry : systems()) {
    const std::string message = refusal_of([&] {
      (void)make_dynamics(entry.name, {{"wingspan", 1.0}}, 0.1);
    });
    EXPECT_THAT(message, HasSubstr("wingspan"));
    for (const auto& [name, value] : entry.defaults) EXPECT_THAT(message, HasSubstr(name));
  }
}

TEST(MakeDynamics, every_parameter_has_a_unit) {
  for (const SystemEntry& entry : systems()) {
    EXPECT_EQ(entry.units.size(), entry.defaults.size()) << entry.name;
    for (const auto& [name, value] : entry.defaults)
      EXPECT_TRUE(entry.units.contains(name)) << name;
  }
}

TEST(MakeDynamics, invalid_time_steps_are_refused) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const SystemEntry& entry : systems()) {
    for (const double time_step : {0.0, -0.1, infinity, std::nan("")}) {
      EXPECT_THROW((void)make_dynamics(entry.name, {}, time_step), std::invalid_argument);
    }
  }
}

TEST(MakeDynamics, invalid_speeds_are_refused) {
  for (const double speed : {-1.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
    EXPECT_THAT(refusal_of([&] {
                  (void)make_dynamics("dubins", {{"speed", speed}}, 0.1);
                }),
                HasSubstr("speed"));
  }
}

TEST(MakeDynamics, parameters_left_out_take_their_defaults) {
  for (const SystemEntry& entry : systems()) {
    const auto implicit = make_dynamics(entry.name, {}, 0.1);
    const auto given = make_dynamics(entry.name, entry.defaults, 0.1);
    const StateBatch state = StateBatch::Constant(implicit->state_dim(), 1, 0.3);
    const StateBatch input = StateBatch::Constant(implicit->input_dim(), 1, 0.2);
    StateBatch first(state.rows(), 1);
    StateBatch second(state.rows(), 1);
    implicit->step(state, input, first);
    given->step(state, input, second);
    EXPECT_EQ(first, second);
  }
}

}  // namespace make_dynamics_test
}  // namespace qsmpc::models
