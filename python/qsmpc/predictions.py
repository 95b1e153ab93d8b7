"""The prediction of one plan, without a plant: ``qsmpc predict``."""

from __future__ import annotations

import json
import os
from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from qsmpc._native import core
from qsmpc.scenarios import Path, Scenario, as_scenario

Floats = NDArray[np.float64]


class Prediction:
    """A plan from the scenario's initial belief, its particles, errors and certificates."""

    __slots__ = ("core", "_numbers")

    def __init__(self, prediction: core.Prediction) -> None:
        self.core = prediction
        self._numbers: Optional[dict[str, Any]] = None

    @property
    def numbers(self) -> dict[str, Any]:
        """The content of ``predict.json``, by key: ``stages``, ``cost``, …"""
        if self._numbers is None:
            self._numbers = json.loads(self.core.to_json())
        return self._numbers

    @property
    def inputs(self) -> Floats:
        """Nominal inputs, stages × m."""
        return self.core.inputs

    @property
    def states(self) -> Floats:
        """The model's path under these inputs, (stages + 1) × n."""
        return self.core.states

    @property
    def certificates(self) -> Floats:
        """The smallest upper bound of the probability of being unsafe, one per stage."""
        return np.array([stage["certificate"]["value"] for stage in self.numbers["stages"]], float)

    @property
    def horizon_bound(self) -> float:
        """Upper bound of the probability of being unsafe at any stage."""
        return self.core.horizon_bound

    def particles(self, stage: int) -> tuple[Floats, Floats]:
        """Locations (points × n) and weights (points) of a stage, from 0. Raises `IndexError`."""
        return self.core.particles(stage)

    def save(self, folder: Path) -> None:
        """Writes the files of ``qsmpc predict``."""
        self.core.save(os.fspath(folder))

    def __str__(self) -> str:
        return self.core.table()


def predict(
    scenario: Scenario | Path, inputs: Optional[ArrayLike] = None, *, monte_carlo: int = 0
) -> Prediction:
    """Plans for the scenario's initial belief, or takes ``inputs`` (stages × m), and certifies.

    ``monte_carlo``: number of paths of the model to simulate as a check. Raises `ValueError` on
    inputs of the wrong size or outside their bounds.
    """
    given = None if inputs is None else np.asarray(inputs, float)
    return Prediction(core.predict(as_scenario(scenario).core, given, monte_carlo))
