"""Episodes driven from Python."""

import json
import os
import signal
import subprocess
import sys
import threading
import time

import h5py
import numpy as np
import pytest

import qsmpc

PROGRAM = os.environ["QSMPC_PROGRAM"]


def datasets(path):
    """All datasets of a trace but wall-clock times, by name."""
    values = {}

    def keep(name, item):
        if isinstance(item, h5py.Dataset) and not name.startswith("timing"):
            values[name] = item[()]

    with h5py.File(path) as file:
        file.visititems(keep)
    return values


def test_an_episode_is_that_of_the_program_bit_for_bit(small, tmp_path):
    scenario = tmp_path / "small.yaml"
    scenario.write_text(small.to_yaml())
    subprocess.run(
        [PROGRAM, "run", scenario, "--seed", "5", "--no-video", "--quiet", "--fail-on", "none",
         "--out", tmp_path / "program"],
        check=True, capture_output=True,
    )
    qsmpc.run(small, seed=5, out=tmp_path / "python")
    theirs, ours = (datasets(tmp_path / who / "episode.h5") for who in ("program", "python"))
    assert theirs.keys() == ours.keys() and len(ours) > 20
    for name, value in theirs.items():
        np.testing.assert_array_equal(value, ours[name], err_msg=name)
    for file in ("summary.json", "scenario.yaml", "report.html"):
        assert (tmp_path / "python" / file).stat().st_size > 0


def test_the_planner_as_a_python_object_drives_the_same_way(small):
    program = qsmpc.run(small, seed=2)
    python = qsmpc.run(small, seed=2, controller=qsmpc.Planner(small))
    np.testing.assert_array_equal(program.states, python.states)
    np.testing.assert_array_equal(program.inputs, python.inputs)
    np.testing.assert_array_equal(program.plan_gains, python.plan_gains)


def test_the_planner_as_a_python_object_drives_over_waypoints():
    eight = qsmpc.load("waypoints", {
        "plant.kind": "analytic",
        "controller.horizon": 8,
        "controller.quantisation": "{state: 20, noise: 20, compressed: 20}",
        "limit.steps": 60,
    })
    passed = []

    class Watcher(qsmpc.Planner):
        def act(self, situation):
            passed.append(situation.waypoints_passed)
            return super().act(situation)

    program = qsmpc.run(eight, seed=2)
    python = qsmpc.run(eight, seed=2, controller=Watcher(eight))
    np.testing.assert_array_equal(program.states, python.states)
    assert passed[0] == 0 and passed[-1] >= 2 and sorted(passed) == passed
    with pytest.raises(ValueError, match="waypoints_passed"):
        qsmpc.Planner(eight).decide(waypoints_passed=-1)


def test_the_planner_as_a_python_object_knows_obstacles_that_move():
    square = qsmpc.load("crossing", {
        "plant.kind": "analytic",
        "controller.horizon": 6,
        "controller.quantisation": "{state: 20, noise: 20, compressed: 20}",
        "limit.steps": 25,
    })
    told = []

    class Watcher(qsmpc.Planner):
        def act(self, situation):
            told.append(situation.obstacles)
            return super().act(situation)

    program = qsmpc.run(square, seed=2)
    python = qsmpc.run(square, seed=2, controller=Watcher(square))
    np.testing.assert_array_equal(program.states, python.states)
    np.testing.assert_array_equal(program.certificates["value"], python.certificates["value"])
    assert len(told) == python.steps and len(told[0]) == 12
    stages = told[-1][0]
    assert len(stages) == 7
    assert np.trace(stages[6][0].covariance) > np.trace(stages[0][0].covariance)
    assert len(told[0][5][3]) == 2 and sum(way.weight for way in told[0][5][3]) == pytest.approx(1)
    # Without a situation it plans with the prior knowledge, before any observation.
    plan = qsmpc.Planner(square).decide()
    assert plan.certificates["value"][-1] < 0.01


def test_arrays_have_a_period_as_a_row(small):
    episode = qsmpc.run(small, seed=1)
    steps, stages = episode.steps, small.horizon
    assert episode.states.shape == (steps + 1, 3) == (episode.times.size, 3)
    assert episode.inputs.shape == (steps, 1)
    assert episode.plan_inputs.shape == (steps, stages, 1)
    assert episode.plan_states.shape == (steps, stages + 1, 3)
    assert episode.plan_gains.shape == (steps, stages, 1, 3)
    assert episode.certificates["value"].shape == (steps, stages)
    points, weights = episode.particles(3, 2)
    assert points.shape == (20, 3) and weights.sum() == pytest.approx(1.0)
    # The plan starts from the belief, and its first input applies to the observed state.
    np.testing.assert_allclose(episode.plan_states[4, 0], episode.belief_means[4])
    gap = episode.observations[4] - episode.plan_states[4, 0]
    expected = episode.plan_inputs[4, 0] + episode.plan_gains[4, 0] @ gap
    low, high = small.input_bounds
    np.testing.assert_allclose(episode.inputs[4], np.clip(expected, low, high), rtol=1e-9)
    with pytest.raises(IndexError):
        episode.particles(steps, 0)


def test_what_is_saved_is_read_again(small, tmp_path):
    episode = qsmpc.run(small, seed=1)
    episode.save(tmp_path)
    again = qsmpc.read(tmp_path)
    np.testing.assert_array_equal(episode.states, again.states)
    assert json.loads((tmp_path / "summary.json").read_text())["outcome"] == again.outcome
    assert again.summary["cost"] == episode.summary["cost"]


def test_a_function_drives_and_is_certified_step_by_step(small):
    episode = qsmpc.run(small, controller=lambda now: -0.5 * now.observation[2:])
    np.testing.assert_allclose(episode.inputs, -0.5 * episode.observations[:, 2:])
    assert episode.certificates["value"].shape == (episode.steps, 1)
    assert episode.stages == 0


class Straight:
    """Counts how it is called."""

    def __init__(self):
        self.seeds, self.periods = [], []

    def reset(self, seed):
        self.seeds.append(seed)

    def act(self, situation):
        self.periods.append(situation.period)
        return [0.0]


def test_a_controller_is_reset_and_asked_once_per_period(small):
    controller = Straight()
    episode = qsmpc.run(small, seed=9, controller=controller)
    assert controller.seeds == [9]
    assert controller.periods == list(range(episode.steps))


@pytest.mark.parametrize(
    ("act", "words"),
    [
        (lambda now: 1 / 0, "ZeroDivisionError"),
        (lambda now: [float("nan")], "nan"),
        (lambda now: [0.0, 1.0], "2 numbers"),
        (lambda now: [1e6], "out of its bounds"),
        (lambda now: None, "array of inputs"),
        (lambda now: "left", "ValueError"),
        (lambda now: [[0.0]], "dimensions"),
    ],
)
def test_a_wrong_answer_is_a_fault_of_the_controller(small, act, words):
    def late(now):
        return [0.0] if now.period < 2 else act(now)

    episode = qsmpc.run(small, controller=late)
    assert episode.outcome == "fault"
    assert episode.steps == 2
    assert "period 2" in episode.fault and words in episode.fault


def test_a_controller_that_is_late_is_a_fault(small):
    def slow(now):
        time.sleep(0.05)
        return [0.0]

    episode = qsmpc.run(small.set({"controller.deadline": 0.01}), controller=slow)
    assert episode.outcome == "fault" and "controller.deadline" in episode.fault


def test_what_is_no_controller_is_refused(small):
    with pytest.raises(TypeError):
        qsmpc.run(small, controller=3)


def test_other_threads_run_while_an_episode_is_driven(small):
    counted = 0
    done = threading.Event()

    def count():
        nonlocal counted
        while not done.is_set():
            counted += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    before = counted
    qsmpc.run("dubins_obstacles", seed=1)
    after = counted
    done.set()
    thread.join()
    assert after > before


def test_ctrl_c_is_raised_and_leaves_what_was_driven(tmp_path):
    code = (
        "import qsmpc, sys\n"
        "def told(step, time):\n"
        "    if step == 3: print('driving', flush=True)\n"
        "try:\n"
        f"    qsmpc.run('dubins_obstacles', out={str(tmp_path)!r}, on_step=told)\n"
        "except KeyboardInterrupt:\n"
        "    sys.exit(7)\n"
    )
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE) as process:
        assert process.stdout.readline() == b"driving\n"
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=60) == 7
    episode = qsmpc.read(tmp_path)
    assert episode.outcome == "interrupted" and episode.steps >= 3


def test_an_episode_shows_itself(small, tmp_path):
    episode = qsmpc.run(small, seed=1)
    assert "<svg" in episode._repr_html_() and episode.outcome in episode._repr_html_()
    assert episode.page().startswith("<!DOCTYPE html>")
    episode.still(tmp_path / "still.png", 0.5, size=(320, 180))
    assert (tmp_path / "still.png").read_bytes().startswith(b"\x89PNG")
    import matplotlib

    matplotlib.use("Agg")
    axes = episode.plot()
    assert len(axes.patches) == 3  # two obstacles and the target


def test_an_episode_shows_shapes(small):
    import matplotlib

    matplotlib.use("Agg")
    shapes = [{"box": {"centre": [3, 3], "size": [2, 1], "angle": 0.4}}]
    episode = qsmpc.run(small.set({"safe_set.obstacles": shapes}), seed=1)
    assert "<polygon" in episode._repr_html_()
    box, _ = episode.plot().patches
    np.testing.assert_allclose(box.get_xy()[:4], episode.scenario.shapes[0].outline)


def test_a_python_controller_serves_the_program(small, tmp_path):
    program = tmp_path / "straight.py"
    program.write_text(
        "import qsmpc\n"
        "class Straight:\n"
        "    def __init__(self, scenario): print('for', scenario['name'])\n"
        "    def act(self, now): return -0.5 * now.observation[2:]\n"
        "qsmpc.serve(Straight)\n"
    )
    served = small.set(
        {"controller.kind": "external", "controller.command": [sys.executable, str(program)]}
    )
    there = qsmpc.run(served, seed=1)
    here = qsmpc.run(small, seed=1, controller=lambda now: -0.5 * now.observation[2:])
    assert there.outcome == here.outcome != "fault"
    np.testing.assert_array_equal(there.states, here.states)
    assert "for dubins_obstacles" in there.controller_log
