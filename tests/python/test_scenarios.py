"""Scenarios in Python."""

import pickle

import numpy as np
import pytest

import qsmpc


def test_every_shipped_scenario_loads_and_says_what_it_holds():
    assert len(qsmpc.scenarios()) >= 17
    for name in qsmpc.scenarios():
        scenario = qsmpc.load(name)
        assert scenario["name"] == name
        assert scenario["time_step"] == scenario.time_step
        assert scenario.initial_covariance.shape == (len(scenario.model().states),) * 2


def test_settings_are_applied_to_a_copy(small):
    changed = small.set({"controller.horizon": 7, "target.state": np.array([3.0, 1.0, 0.0])}, seed=4)
    assert (changed.horizon, changed.seed) == (7, 4)
    assert changed.target.tolist() == [3.0, 1.0, 0.0]
    assert (small.horizon, small.seed) == (5, 0)


def test_shapes_are_told_beside_boxes_with_their_values_and_outlines(small):
    scenario = small.set(
        {
            "safe_set.obstacles": [
                {"x": [2, 4]},
                {"disc": {"centre": [8, 3], "radius": 0.5}},
                {"polygon": [[5, 9], [6, 9], [6, 10]]},
                {"half_plane": {"normal": [0, -1], "offset": 0.75}},
            ]
        }
    )
    assert len(scenario.obstacles) == 1
    disc, polygon, half_plane = scenario.shapes
    assert (disc.index, disc.kind) == (1, "disc")
    assert disc.values == {"centre": [8, 3], "radius": 0.5}
    distances = np.hypot(*(disc.outline - [8, 3]).T)
    np.testing.assert_allclose(distances, 0.5, rtol=2e-3)
    assert polygon.outline.tolist() == [[5, 9], [6, 9], [6, 10]]
    assert (half_plane.index, half_plane.outline.shape) == (3, (4, 2))
    assert half_plane.outline[:, 1].max() == pytest.approx(-0.75)
    assert small.shapes == []


def test_an_error_says_where_and_what_is_expected():
    with pytest.raises(qsmpc.InputError) as caught:
        qsmpc.load("dubins_obstacles", {"controller.horizon": 0})
    assert caught.value.file == "--set"
    assert caught.value.key == "controller.horizon"
    assert caught.value.found == "0"
    assert "controller.horizon" in str(caught.value)
    assert isinstance(caught.value, ValueError)


def test_a_name_that_is_none_suggests_the_nearest():
    with pytest.raises(qsmpc.InputError, match="dubins_obstacles"):
        qsmpc.load("dubins_obstacle")


def test_a_missing_key_is_a_key_error(small):
    with pytest.raises(KeyError):
        small["controller.horizont"]


def test_a_scenario_survives_text_and_pickle(small):
    assert qsmpc.parse(small.to_yaml()) == small
    assert pickle.loads(pickle.dumps(small)) == small


def test_the_model_steps_many_states_at_once():
    model = qsmpc.load("dubins_obstacles").model()
    assert [name for name, _ in model.states] == ["x", "y", "heading"]
    states = np.array([[0.0, 0.0, 0.0], [1.0, 2.0, np.pi / 2]])
    together = model.step(states, [[0.5]])
    alone = np.vstack([model.step(state[None], [[0.5]]) for state in states])
    np.testing.assert_array_equal(together, alone)
    with pytest.raises(ValueError, match="expected 3"):
        model.step([[0.0, 0.0]], [[0.5]])


def test_jacobians_are_the_slopes_of_a_step():
    model = qsmpc.load("bicycle_obstacles").model()
    state, input = np.array([0.0, 0.0, 0.1, 4.0, 0.1, 0.2]), np.array([0.5, 0.1])
    by_state, by_input = model.jacobians(state, input)
    width = 1e-6
    for slopes, at in ((by_state, state), (by_input, input)):
        for i in range(at.size):
            ends = []
            for sign in (-1.0, 1.0):
                moved = at.copy()
                moved[i] += sign * width
                pair = (moved, input) if at is state else (state, moved)
                ends.append(model.step(pair[0][None], pair[1][None])[0])
            np.testing.assert_allclose((ends[1] - ends[0]) / (2 * width), slopes[:, i], atol=1e-6)
