"""The common parts of the environments: spaces, rewards and ``info``."""

from __future__ import annotations

from typing import Any, Optional

import numpy as np
from gymnasium import spaces
from numpy.typing import ArrayLike, NDArray

from qsmpc.scenarios import Scenario

Floats = NDArray[np.float64]

# Beyond any state of the shipped systems; Gymnasium warns about unbounded spaces.
MOST = 1e9
SEEDS = 2**31 - 1
UNSAFE = ("collision", "left_bounds")


def observation_space(scenario: Scenario) -> spaces.Box:
    """The space of observations: wider than the safe set, which a drive may leave at its end."""
    return spaces.Box(-MOST, MOST, scenario.initial_mean.shape, np.float64)


def action_space(scenario: Scenario) -> spaces.Box:
    """−1 … 1 for each input, from its lower to its upper bound."""
    return spaces.Box(-1.0, 1.0, scenario.input_bounds[0].shape, np.float64)


class Task:
    """The rewards of a scenario's drives, and the meaning of actions."""

    def __init__(self, scenario: Scenario) -> None:
        self.scenario = scenario
        self.lower, self.upper = scenario.input_bounds
        start = scenario.cost(scenario.initial_mean, np.clip(0.0 * self.lower, self.lower, self.upper))
        self.scale = start if start > 0.0 else 1.0

    def inputs(self, actions: ArrayLike) -> Floats:
        """Inputs for actions within −1 … 1 (clipped to this range)."""
        share = 0.5 * (np.clip(np.asarray(actions, float), -1.0, 1.0) + 1.0)
        # Rounding at the ends must not exceed the bounds.
        return np.clip(self.lower + share * (self.upper - self.lower), self.lower, self.upper)

    def reward(self, cost: float, outcome: Optional[str], periods_left: int) -> float:
        """−cost of the period; an unsafe end costs as much as standing still there would."""
        left = periods_left if outcome in UNSAFE else 0
        return -cost * (1 + left) / self.scale


def information(cost: float, certified: float, clearance: float, outcome: Optional[str]) -> dict[str, Any]:
    """What a step returns beside its observation and reward."""
    return {
        "clearance": clearance,
        "certified": certified,
        "cost": cost,
        "unsafe": bool(clearance <= 0.0),
        "outcome": outcome or "",
    }
