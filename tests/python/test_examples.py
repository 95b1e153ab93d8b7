"""The examples in Python, as their pages say."""

import json
import pathlib
import sys

import numpy as np
import pytest

import qsmpc

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples"


def test_a_trained_policy_arrives_and_an_untrained_one_does_not():
    sys.path.insert(0, str(EXAMPLES / "policy_training"))
    import train

    scenario = qsmpc.load("double_integrator")
    weights, history = train.train(scenario, rounds=15)
    assert history[-1] > history[0]
    trained = qsmpc.run(scenario, seed=1, controller=train.LinearPolicy(scenario, weights))
    untrained = qsmpc.run(
        scenario, seed=1, controller=train.LinearPolicy(scenario, np.zeros_like(weights))
    )
    assert trained.outcome == "reached"
    assert untrained.outcome != "reached"
    assert np.isfinite(trained.certificates["value"]).all()


@pytest.fixture
def problem_of(tmp_path):
    """What the examples with CasADi make of a scenario's message, which is that of the program."""
    sys.path.insert(0, str(EXAMPLES / "casadi_scenario_mpc"))
    from problem import Problem

    def make(name, settings):
        message = tmp_path / "message.json"
        keep = f"import sys; open({str(message)!r}, 'w').write(sys.stdin.readline())"
        outside = {
            "controller.kind": "external",
            "controller.command": [sys.executable, "-c", keep],
            "plant.kind": "analytic",
        }
        assert qsmpc.run(qsmpc.load(name, {**settings, **outside})).outcome == "fault"
        return Problem(json.loads(message.read_text()))

    return make


SYSTEMS = {
    "dubins_obstacles": {},
    "dubins_alley": {},
    "bicycle_obstacles": {},
    "double_integrator": {},
    "point_mass": {"model.damping": 0.3},
}


@pytest.mark.parametrize("name", SYSTEMS)
def test_casadi_has_the_dynamics_of_the_planner(name, problem_of):
    problem = problem_of(name, SYSTEMS[name])
    scenario = qsmpc.load(name, SYSTEMS[name])
    random = np.random.default_rng(1)
    states = scenario.initial_mean + random.uniform(-1.0, 1.0, (20, problem.state_dim))
    inputs = random.uniform(problem.lower, problem.upper, (20, problem.input_dim))
    expected = scenario.model().step(states, inputs)
    found = problem.step(states.T, inputs.T).full().T
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("name", ["dubins_obstacles", "bicycle_obstacles", "double_integrator"])
def test_casadi_has_no_clearance_that_is_too_large(name, problem_of):
    problem = problem_of(name, {})
    from problem import ROUNDING

    episode = qsmpc.run(name, seed=1)
    found = problem.clearance(episode.states.T).full().ravel()
    assert (found <= episode.clearances + 1e-12).all()
    # For a disc's centre at a corner, the larger of two distances is smaller than the Euclidean one
    # by at most a share of 1 − 1/√2; and where two sides are equally near, distances are rounded.
    radius = max((disc["radius"] for disc in problem.message["footprint"]), default=0.0)
    allowed = (1.0 - 0.5**0.5) * (episode.clearances + radius) + 2.0 * ROUNDING
    assert (found >= episode.clearances - allowed).all()
