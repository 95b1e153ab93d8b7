// Bit-exact comparison of traces.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <vector>

#include <gtest/gtest.h>

#include "harness/trace/trace.hpp"

namespace qsmpc::testing {

/// Whether two vectors or matrices have the same shape and the same bits, NaN and -0 included.
template <class Matrix>
[[nodiscard]] bool same_bits(const Matrix& a, const Matrix& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         (a.size() == 0 || std::memcmp(a.data(), b.data(),
                                       sizeof(double) * static_cast<std::size_t>(a.size())) == 0);
}

[[nodiscard]] inline bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

inline void expect_same_coordinates(const std::vector<models::Coordinate>& a,
                                    const std::vector<models::Coordinate>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].name, b[i].name);
    EXPECT_EQ(a[i].unit, b[i].unit);
    EXPECT_EQ(a[i].is_angle, b[i].is_angle) << a[i].name;
  }
}

inline void expect_same_system(const models::SystemDescription& a,
                               const models::SystemDescription& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.summary, b.summary);
  expect_same_coordinates(a.states, b.states);
  expect_same_coordinates(a.inputs, b.inputs);
  EXPECT_TRUE(same_bits(a.input_lower, b.input_lower));
  EXPECT_TRUE(same_bits(a.input_upper, b.input_upper));
  EXPECT_EQ(a.position_x, b.position_x);
  EXPECT_EQ(a.position_y, b.position_y);
  EXPECT_EQ(a.heading, b.heading);
}

inline void expect_same_stages(const harness::StepRecord& a, const harness::StepRecord& b) {
  ASSERT_EQ(a.plan_gains.size(), b.plan_gains.size());
  for (std::size_t s = 0; s < a.plan_gains.size(); ++s) {
    EXPECT_TRUE(same_bits(a.plan_gains[s], b.plan_gains[s]));
  }
  ASSERT_EQ(a.particles.size(), b.particles.size());
  for (std::size_t s = 0; s < a.particles.size(); ++s) {
    EXPECT_TRUE(same_bits(a.particles[s].locations, b.particles[s].locations));
    EXPECT_TRUE(same_bits(a.particles[s].weights, b.particles[s].weights));
  }
  ASSERT_EQ(a.budgets.size(), b.budgets.size());
  for (std::size_t s = 0; s < a.budgets.size(); ++s) {
    EXPECT_TRUE(same_bits(a.budgets[s].belief, b.budgets[s].belief));
    EXPECT_TRUE(same_bits(a.budgets[s].noise, b.budgets[s].noise));
    EXPECT_TRUE(same_bits(a.budgets[s].compression, b.budgets[s].compression));
    EXPECT_TRUE(same_bits(a.budgets[s].model, b.budgets[s].model));
    EXPECT_TRUE(same_bits(a.budgets[s].dynamics, b.budgets[s].dynamics));
    EXPECT_TRUE(same_bits(a.budgets[s].total, b.budgets[s].total));
    EXPECT_TRUE(same_bits(a.budgets[s].lipschitz, b.budgets[s].lipschitz));
  }
  ASSERT_EQ(a.certificates.size(), b.certificates.size());
  for (std::size_t s = 0; s < a.certificates.size(); ++s) {
    EXPECT_TRUE(same_bits(a.certificates[s].value, b.certificates[s].value));
    EXPECT_EQ(a.certificates[s].kind, b.certificates[s].kind);
    for (const controller::CertificateEntry& entry : controller::certificate_entries()) {
      EXPECT_TRUE(same_bits(a.certificates[s].of(entry.key), b.certificates[s].of(entry.key)))
          << entry.key;
    }
  }
}

inline void expect_same_step(const harness::StepRecord& a, const harness::StepRecord& b) {
  EXPECT_TRUE(same_bits(a.time, b.time));
  EXPECT_TRUE(same_bits(a.state, b.state));
  EXPECT_TRUE(same_bits(a.observation, b.observation));
  EXPECT_TRUE(same_bits(a.input, b.input));
  EXPECT_TRUE(same_bits(a.disturbance, b.disturbance));
  EXPECT_TRUE(same_bits(a.residual, b.residual));
  EXPECT_TRUE(same_bits(a.belief_mean, b.belief_mean));
  EXPECT_TRUE(same_bits(a.belief_covariance, b.belief_covariance));
  EXPECT_TRUE(same_bits(a.plan_inputs, b.plan_inputs));
  EXPECT_TRUE(same_bits(a.plan_states, b.plan_states));
  for (std::size_t part = 0; part < controller::cost_parts().size(); ++part) {
    EXPECT_TRUE(same_bits(a.cost[part], b.cost[part])) << controller::cost_parts()[part].name;
  }
  EXPECT_EQ(a.solver_status, b.solver_status);
  EXPECT_EQ(a.fallback, b.fallback);
  EXPECT_TRUE(same_bits(a.believed, b.believed));
  EXPECT_EQ(a.iterations, b.iterations);
  EXPECT_TRUE(same_bits(a.timing.quantise, b.timing.quantise));
  EXPECT_TRUE(same_bits(a.timing.propagate, b.timing.propagate));
  EXPECT_TRUE(same_bits(a.timing.optimise, b.timing.optimise));
  EXPECT_TRUE(same_bits(a.timing.certify, b.timing.certify));
  EXPECT_TRUE(same_bits(a.timing.total, b.timing.total));
  EXPECT_TRUE(same_bits(a.timing.simulate, b.timing.simulate));
  expect_same_stages(a, b);
}

}  // namespace qsmpc::testing
