// The experiments one by one, as the table in experiment.cpp lists them. Each fills in the rows,
// claims, figures and remarks of a result; the caller fills in name, title and time.
#pragma once

#include "harness/reproduction/laboratory.hpp"
#include "harness/reproduction/result.hpp"

namespace qsmpc::harness {

/// Fig. 4-1: a belief propagated along a turn, as points and as samples.
[[nodiscard]] ExperimentResult propagation_along_a_turn(Laboratory& laboratory);

/// Fig. 4-2: the same with noise, with and without compression.
[[nodiscard]] ExperimentResult propagation_with_noise(Laboratory& laboratory);

/// Table 5-1 and Fig. 5-1: distances of points and of few samples to many samples.
[[nodiscard]] ExperimentResult prediction_quality(Laboratory& laboratory);

/// Algorithms 3 and 4: the published probability, its errors, and valid bounds.
[[nodiscard]] ExperimentResult published_certificate(Laboratory& laboratory);

/// Table 5-2 and Fig. 5-2: open and closed loop in a corridor, with the noise propagated.
[[nodiscard]] ExperimentResult corridor_with_noise(Laboratory& laboratory);

/// Table 5-3 and Fig. 5-3: the same, without the noise in the prediction.
[[nodiscard]] ExperimentResult corridor_with_unseen_noise(Laboratory& laboratory);

/// Table 5-4 and Fig. 5-4: obstacles, two solvers, three numbers of points.
[[nodiscard]] ExperimentResult obstacles_by_solver(Laboratory& laboratory);

/// Table 5-5 and Fig. 5-5: the bicycle, three numbers of points.
[[nodiscard]] ExperimentResult bicycle_by_points(Laboratory& laboratory);

/// Fig. 5-6: the bicycle with noise and compression.
[[nodiscard]] ExperimentResult bicycle_with_noise(Laboratory& laboratory);

/// Table B-4: the double integrator.
[[nodiscard]] ExperimentResult double_integrator_at_rest(Laboratory& laboratory);

/// Table B-5: the pendulum on a cart.
[[nodiscard]] ExperimentResult cart_pole_upright(Laboratory& laboratory);

/// Every scenario on its analytic plant and on its MuJoCo plants.
[[nodiscard]] ExperimentResult scenarios_on_plants(Laboratory& laboratory);

}  // namespace qsmpc::harness
