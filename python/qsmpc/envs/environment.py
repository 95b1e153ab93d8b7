"""One drive as a Gymnasium environment."""

from __future__ import annotations

import math
from typing import Any, Optional

import gymnasium
import numpy as np
from numpy.typing import ArrayLike, NDArray

from qsmpc._native import core
from qsmpc.envs.spaces import SEEDS, Task, action_space, information, observation_space
from qsmpc.episodes import Episode
from qsmpc.scenarios import Path, Scenario, Settings, as_scenario

Floats = NDArray[np.float64]


class Environment(gymnasium.Env[Floats, Floats]):
    """A scenario's plant with its disturbances; the action is the input of a control period.

    The observation is what a controller sees of the state, n. An action is −1 … 1 for each input,
    from its lower to its upper bound. The reward is minus the cost of the period, relative to that
    of the start; an unsafe end costs as much as standing still there until the step limit. An
    episode terminates with the outcomes ``reached``, ``collision``, ``left_bounds`` and ``fault``,
    and is truncated at the step limit.

    ``info`` has ``clearance`` (of the state at the end of the step, like the observation),
    ``unsafe``, ``cost``, ``outcome`` (empty while the episode is running), and ``certified``: an
    upper bound of the probability that the step's end is unsafe, for the action taken, certified
    before the step. It is NaN without ``certify``, after a reset, and if ``scenario.no_bound`` says
    that there is no bound.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 10}

    def __init__(
        self,
        scenario: Scenario | Path = "dubins_obstacles",
        settings: Settings = None,
        *,
        certify: bool = True,
        render_mode: Optional[str] = None,
        size: tuple[int, int] = (640, 360),
        camera: str = "chase",
    ) -> None:
        """``settings``: of the scenario, as in `load`. ``certify``: whether to certify steps, which
        takes most of their time. ``size`` and ``camera``: of rendered pictures."""
        if render_mode not in (None, "rgb_array"):
            raise ValueError(f"render_mode {render_mode!r}, expected None or 'rgb_array'")
        base = as_scenario(scenario)
        self.scenario = base.set(settings) if settings else base
        self.observation_space = observation_space(self.scenario)
        self.action_space = action_space(self.scenario)
        self.render_mode = render_mode
        self.metadata = {**self.metadata, "render_fps": round(1.0 / self.scenario.time_step)}
        self._certify = certify and not self.scenario.no_bound
        self._task = Task(self.scenario)
        self._drive = core.Drive(self.scenario.core)
        self._picture: Optional[core.DrivePicture] = None
        self._layout = (int(size[0]), int(size[1]), camera)

    def reset(
        self, *, seed: Optional[int] = None, options: Optional[dict[str, Any]] = None
    ) -> tuple[Floats, dict[str, Any]]:
        """Begins a drive. If given, ``seed`` is that of the drive, as in ``qsmpc run --seed``."""
        super().reset(seed=seed)
        drawn = int(self.np_random.integers(SEEDS)) if seed is None else int(seed)
        self._drive.begin(drawn, None, self._certify)
        return self._drive.observation, information(
            0.0, math.nan, self._drive.clearance, self._drive.outcome
        )

    def step(self, action: ArrayLike) -> tuple[Floats, float, bool, bool, dict[str, Any]]:
        if self._drive.outcome is not None:  # rare: the drive began at its end
            over = information(0.0, math.nan, self._drive.clearance, self._drive.outcome)
            return self._drive.observation, 0.0, True, False, over
        cost, certified, clearance = self._drive.advance(self._task.inputs(action))
        outcome = self._drive.outcome
        left = self.scenario.step_limit - self._drive.period
        terminated = outcome is not None and outcome != "timeout"
        return (
            self._drive.observation,
            self._task.reward(cost, outcome, left),
            terminated,
            outcome == "timeout",
            information(cost, certified, clearance, outcome),
        )

    def render(self) -> Optional[NDArray[np.uint8]]:
        """The current picture, height × width × 3; None without a render mode."""
        if self.render_mode is None:
            return None
        if self._picture is None:
            self._picture = core.DrivePicture(*self._layout)
        return self._picture.draw(self._drive)

    def episode(self) -> Episode:
        """The drive so far as an episode, which can be saved, drawn and reported on."""
        return Episode(self._drive.episode())

    def close(self) -> None:
        self._picture = None
