"""Many drives in parallel, on threads, as a Gymnasium vector environment."""

from __future__ import annotations

from typing import Any, Optional

import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import ArrayLike, NDArray

from qsmpc._native import core
from qsmpc.envs.spaces import SEEDS, Task, action_space, information, observation_space
from qsmpc.scenarios import Path, Scenario, Settings, as_scenario

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]


class VectorEnvironment(VectorEnv[Floats, Floats, Floats]):
    """``num_envs`` environments of one scenario. The step after the end of a drive resets it and
    ignores its action, as ``AutoresetMode.NEXT_STEP`` requires."""

    metadata = {
        "render_modes": ["rgb_array"],
        "render_fps": 10,
        "autoreset_mode": AutoresetMode.NEXT_STEP,
    }

    def __init__(
        self,
        num_envs: int = 1,
        scenario: Scenario | Path = "dubins_obstacles",
        settings: Settings = None,
        *,
        certify: bool = True,
        threads: int = 1,
        render_mode: Optional[str] = None,
        size: tuple[int, int] = (640, 360),
        camera: str = "chase",
    ) -> None:
        """As `Environment`. ``threads``: the number used for steps; results do not depend on it."""
        if num_envs < 1 or threads < 1:
            raise ValueError("num_envs and threads must be at least 1")
        base = as_scenario(scenario)
        self.scenario = base.set(settings) if settings else base
        self.num_envs = num_envs
        self.single_observation_space = observation_space(self.scenario)
        self.single_action_space = action_space(self.scenario)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.render_mode = render_mode
        self.metadata = {**self.metadata, "render_fps": round(1.0 / self.scenario.time_step)}
        self._certify = certify and not self.scenario.no_bound
        self._task = Task(self.scenario)
        self._batch = core.DriveBatch(self.scenario.core, num_envs, threads)
        self._ended = np.zeros(num_envs, bool)
        self._pictures: list[core.DrivePicture] = []
        self._layout = (int(size[0]), int(size[1]), camera)

    def _move(self, inputs: Floats, seeds: list[int]) -> tuple[Any, ...]:
        observations, costs, certified, clearances, outcomes = self._batch.step(
            inputs, seeds, self._certify
        )
        info: dict[str, Any] = {}
        for n, outcome in enumerate(outcomes):
            each = information(costs[n], certified[n], clearances[n], outcome)
            info = self._add_info(info, each, n)
        return observations, costs, outcomes, info

    def reset(
        self,
        *,
        seed: int | list[int | None] | None = None,
        options: Optional[dict[str, Any]] = None,
    ) -> tuple[Floats, dict[str, Any]]:
        """Begins all drives with the seeds ``seed``, ``seed`` + 1, …, or with the listed ones."""
        super().reset(seed=seed if isinstance(seed, int) else None)
        if seed is None:
            seeds = self.np_random.integers(SEEDS, size=self.num_envs).tolist()
        elif isinstance(seed, int):
            seeds = list(range(seed, seed + self.num_envs))
        else:
            seeds = [int(self.np_random.integers(SEEDS)) if one is None else one for one in seed]
        idle = np.zeros(self.action_space.shape)
        observations, _, outcomes, info = self._move(idle, seeds)
        self._ended = np.array([outcome != "" for outcome in outcomes])
        return observations, info

    def step(self, actions: ArrayLike) -> tuple[Floats, Floats, Flags, Flags, dict[str, Any]]:
        ended = self._ended
        seeds = [int(self.np_random.integers(SEEDS)) if over else -1 for over in ended]
        observations, costs, outcomes, info = self._move(self._task.inputs(actions), seeds)
        rewards = np.zeros(self.num_envs)
        for n, outcome in enumerate(outcomes):
            if not ended[n]:
                left = self.scenario.step_limit - self._batch.at(n).period
                rewards[n] = self._task.reward(costs[n], outcome, left)
        truncations = np.array([outcome == "timeout" for outcome in outcomes])
        terminations = np.array([outcome not in ("", "timeout") for outcome in outcomes])
        self._ended = terminations | truncations
        return observations, rewards, terminations, truncations, info

    def render(self) -> Optional[tuple[NDArray[np.uint8], ...]]:
        """A picture of each drive; None without a render mode."""
        if self.render_mode is None:
            return None
        while len(self._pictures) < self.num_envs:
            self._pictures.append(core.DrivePicture(*self._layout))
        return tuple(
            picture.draw(self._batch.at(n)) for n, picture in enumerate(self._pictures)
        )

    def close_extras(self, **kwargs: Any) -> None:
        self._pictures = []
