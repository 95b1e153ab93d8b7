"""What an installed Python module must do, wherever it is called from: drive, draw, start controllers.

    python3 module.py              with Gymnasium, where it is installed: python3 module.py gymnasium

Ends with an exception where it does not.
"""

import pathlib
import sys
import tempfile

import numpy as np

import qsmpc

SETTINGS = {"limit.steps": 3, "controller.horizon": 5}


class Straight:
    """A controller; also that of the process that `starts_controllers` starts."""

    def __init__(self, scenario):
        del scenario

    def act(self, situation):
        return [-0.5 * situation.observation[2]]


def drives_and_draws(folder):
    """An episode of a shipped scenario in MuJoCo, read again, and its video."""
    episode = qsmpc.run(qsmpc.load("dubins_obstacles", SETTINGS), seed=1)
    assert episode.steps == 3, episode.outcome
    assert np.isfinite(episode.certificates["value"]).all()
    episode.save(folder / "episode")
    again = qsmpc.read(folder / "episode")
    assert np.array_equal(again.states, episode.states)
    video = folder / "episode.mp4"
    episode.video(video, size=(320, 180))
    assert video.read_bytes()[4:8] == b"ftyp"


def starts_controllers():
    """A controller in a process of its own, which qsmpc-host starts, drives as it does in this one."""
    scenario = qsmpc.load("dubins_obstacles", SETTINGS)
    inside = qsmpc.run(scenario, seed=1, controller=Straight({}))
    command = [sys.executable, str(pathlib.Path(__file__).resolve()), "serve"]
    outside = qsmpc.run(
        scenario.set({"controller.kind": "external", "controller.command": command}), seed=1
    )
    assert outside.fault == "", outside.fault
    assert np.array_equal(inside.states, outside.states)


def makes_environments():
    """The shipped scenarios are environments, single and in vectors."""
    import gymnasium

    import qsmpc.envs

    assert qsmpc.envs.environment_ids()
    env = gymnasium.make("qsmpc/dubins_obstacles-v0", render_mode="rgb_array")
    env.reset(seed=1)
    _, _, _, _, info = env.step(np.zeros(1))
    assert 0 <= info["certified"] <= 1
    assert env.render().std() > 0
    env.close()
    envs = gymnasium.make_vec("qsmpc/dubins_obstacles-v0", num_envs=3, threads=2, certify=False)
    states, _ = envs.reset(seed=1)
    assert states.shape == (3, 3)
    envs.close()


if __name__ == "__main__":
    if sys.argv[1:] == ["serve"]:
        qsmpc.serve(Straight)
        sys.exit()
    with tempfile.TemporaryDirectory() as name:
        drives_and_draws(pathlib.Path(name))
    starts_controllers()
    if sys.argv[1:] == ["gymnasium"]:
        makes_environments()
    print(f"the module {qsmpc.__version__} of {pathlib.Path(qsmpc.__file__).parent} does what it must")
