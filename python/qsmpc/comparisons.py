"""How far plants are from the planner's model: ``qsmpc compare``."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray

from qsmpc._native import core
from qsmpc.scenarios import Path, Scenario, as_scenario


class Comparison:
    """Plants compared with the model: in closed loop, period by period and along a plan."""

    __slots__ = ("core", "_numbers")

    def __init__(self, comparison: core.Comparison) -> None:
        self.core = comparison
        self._numbers: Optional[dict[str, Any]] = None

    @property
    def plants(self) -> list[str]:
        return self.core.plants

    @property
    def numbers(self) -> dict[str, Any]:
        """The content of ``comparison.json``, by key."""
        if self._numbers is None:
            self._numbers = json.loads(self.core.to_json())
        return self._numbers

    def residuals(self, plant: str) -> NDArray[np.float64]:
        """One-step residuals of a plant in all periods of its episodes, periods × n.

        Raises `KeyError`.
        """
        return self.core.residuals(plant)

    def save(self, folder: Path) -> None:
        """Writes the files of ``qsmpc compare``: numbers, data, figures, page."""
        self.core.save(os.fspath(folder))

    def __str__(self) -> str:
        return self.core.table()


def compare(
    scenario: Scenario | Path,
    plants: Sequence[str] = (),
    *,
    episodes: int = 50,
    paths: int = 1000,
    threads: int = 0,
) -> Comparison:
    """Compares plants, by their names or files; by default ``analytic`` and the scenario's own.

    ``threads``: at most this many; 0 for all cores. Results do not depend on it. Raises
    `InputError`.
    """
    names = [plants] if isinstance(plants, str) else list(plants)
    return Comparison(core.compare(as_scenario(scenario).core, names, episodes, paths, threads))
