"""Scenarios: loading, changing, querying."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from qsmpc._native import core

Settings = Optional[Mapping[str, Any]]
Path = Union[str, "os.PathLike[str]"]


def _text(value: Any) -> str:
    """A value as YAML on one line: JSON is valid YAML, and a string is used as it is."""
    if isinstance(value, str):
        return value
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    return json.dumps(value, default=lambda other: other.tolist())


def overrides(settings: Settings) -> list[str]:
    """KEY=VALUE for each setting, as after ``--set``."""
    return [f"{key}={_text(value)}" for key, value in (settings or {}).items()]


@dataclass(frozen=True, eq=False)
class Shape:
    """An obstacle that is a shape in the plane of position."""

    index: int  #: among all obstacles, as in ``safe_set.obstacles.INDEX``
    kind: str  #: ``disc``, ``ellipse``, ``box``, ``polygon`` or ``half_plane``
    #: As in the scenario: the keys of the kind; for a polygon, its corners.
    values: Any
    #: Corners × 2, counterclockwise, m; arcs as chords, a half-plane as a rectangle of 10 km.
    outline: NDArray[np.float64]


class Scenario:
    """An experiment: system, plant, noise, map, target, controller. Immutable.

    Made by `load` and `parse`, or from another one by `set`.
    """

    __slots__ = ("core",)

    def __init__(self, scenario: core.Scenario) -> None:
        self.core = scenario

    @property
    def name(self) -> str:
        return self.core.name

    @property
    def description(self) -> str:
        return self.core.description

    @property
    def system(self) -> str:
        """The name of the system, e.g. ``dubins``."""
        return self.core.system

    @property
    def plant(self) -> str:
        """The kind of plant: ``analytic`` or ``mujoco``."""
        return self.core.plant

    @property
    def controller(self) -> str:
        """The kind of controller, e.g. ``quantised``."""
        return self.core.controller

    @property
    def seed(self) -> int:
        return self.core.seed

    @property
    def time_step(self) -> float:
        """The control period, s."""
        return self.core.time_step

    @property
    def step_limit(self) -> int:
        """Control periods after which an episode ends."""
        return self.core.step_limit

    @property
    def horizon(self) -> int:
        """Stages of a plan."""
        return self.core.horizon

    @property
    def initial_mean(self) -> NDArray[np.float64]:
        """Mean of the state at the start, n."""
        return self.core.initial_mean

    @property
    def initial_covariance(self) -> NDArray[np.float64]:
        """Covariance of the state at the start, n × n."""
        return self.core.initial_covariance

    @property
    def disturbance_covariance(self) -> NDArray[np.float64]:
        """Covariance of the noise per period, n × n."""
        return self.core.disturbance_covariance

    @property
    def target(self) -> NDArray[np.float64]:
        """The target state, n."""
        return self.core.target

    @property
    def target_radius(self) -> float:
        """The distance at which the target is reached: m, or in the norm of all states for a system
        without a position in the plane."""
        return self.core.target_radius

    @property
    def input_bounds(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Lower and upper bounds of the inputs, m each."""
        return self.core.input_lower, self.core.input_upper

    @property
    def bounds(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Lower and upper bounds of the safe states, n each; infinite if there is none."""
        return self.core.bounds_lower, self.core.bounds_upper

    @property
    def obstacles(self) -> list[tuple[NDArray[np.float64], NDArray[np.float64]]]:
        """Lower and upper corners of the unsafe boxes, n each; infinite in states that an obstacle
        does not restrict. Obstacles that are not boxes of states are `shapes`."""
        return self.core.obstacles

    @property
    def shapes(self) -> list[Shape]:
        """The obstacles that are shapes in the plane of position."""
        outlines = self.core.shape_outlines
        if not outlines:
            return []
        entries = self.to_dict()["safe_set"]["obstacles"]
        return [
            Shape(index, *next(iter(entries[index].items())), outline)
            for index, outline in outlines
        ]

    @property
    def footprint(self) -> NDArray[np.float64]:
        """The discs that cover the vehicle, discs × 3: radius, and the centre's offsets forward and
        left of the position, m. Empty for a point vehicle."""
        return self.core.footprint

    @property
    def no_bound(self) -> str:
        """Why certificates are not upper bounds here; empty if they are."""
        return self.core.no_bound

    def cost(self, state: ArrayLike, input: ArrayLike) -> float:
        """½ |x − r|²_Q + |u|²_R of one period; an episode's cost is their sum."""
        return self.core.cost(np.asarray(state, float), np.asarray(input, float))

    def set(self, settings: Settings = None, **more: Any) -> Scenario:
        """A copy with these settings: ``scenario.set({"controller.horizon": 8}, seed=3)``.

        Raises `InputError`.
        """
        return Scenario(self.core.changed(overrides({**(settings or {}), **more})))

    def model(self) -> Model:
        """The planner's model, to be stepped and linearised."""
        return Model(self)

    def warnings(self) -> list[str]:
        """Warnings before it is driven, one sentence each."""
        return self.core.warnings()

    def to_yaml(self) -> str:
        """The scenario file with every key written out."""
        return self.core.to_yaml()

    def to_dict(self) -> dict[str, Any]:
        """Every key with its value, as in the scenario file."""
        return self.core.to_dict()

    def __getitem__(self, key: str) -> Any:
        """The value of a dotted key: ``scenario["controller.horizon"]``."""
        value: Any = self.to_dict()
        for part in key.split("."):
            if not isinstance(value, dict) or part not in value:
                raise KeyError(key)
            value = value[part]
        return value

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Scenario) and self.to_yaml() == other.to_yaml()

    def __hash__(self) -> int:
        return hash(self.to_yaml())

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (self.core.to_yaml(),)

    def __repr__(self) -> str:
        return (
            f"<qsmpc.Scenario {self.name}: {self.system}, {self.plant} plant, "
            f"{self.controller} controller>"
        )


class Model:
    """The planner's model of a scenario: x⁺ = f(x, u) over one control period."""

    __slots__ = ("core",)

    def __init__(self, scenario: Scenario) -> None:
        self.core = core.Model(scenario.core)

    @property
    def name(self) -> str:
        return self.core.name

    @property
    def states(self) -> list[tuple[str, str]]:
        """Name and unit of each state."""
        return self.core.states

    @property
    def inputs(self) -> list[tuple[str, str]]:
        """Name and unit of each input."""
        return self.core.inputs

    @property
    def angles(self) -> list[bool]:
        """Whether values of a state that are 2π apart are equivalent."""
        return self.core.angles

    @property
    def position(self) -> tuple[int, int]:
        """Indices of the states that are x and y in the plane; −1 if there are none."""
        return self.core.position

    @property
    def heading(self) -> int:
        """Index of the state that is the heading; −1 if there is none."""
        return self.core.heading

    def step(self, states: ArrayLike, inputs: ArrayLike) -> NDArray[np.float64]:
        """The next states (N × n) of ``states`` (N × n) under ``inputs`` (N × m, or 1 × m for all).

        Raises `ValueError` on other sizes.
        """
        return self.core.step(np.atleast_2d(np.asarray(states, float)), np.atleast_2d(np.asarray(inputs, float)))

    def jacobians(
        self, state: ArrayLike, input: ArrayLike
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """∂f/∂x (n × n) and ∂f/∂u (n × m) at one point. Raises `ValueError` on other sizes."""
        return self.core.jacobians(np.asarray(state, float), np.asarray(input, float))


def _restored(text: str) -> Scenario:
    return Scenario(core.recorded_scenario(text))


def load(path_or_name: Path, settings: Settings = None) -> Scenario:
    """The scenario in a file, or the shipped one of that name, with ``settings`` applied.

    Settings are dotted keys and their values, e.g. ``{"controller.horizon": 8, "target.state": [3,
    0, 0]}``; a string is parsed as YAML. Raises `InputError`.
    """
    return Scenario(core.load_scenario(os.fspath(path_or_name), overrides(settings)))


def parse(text: str, settings: Settings = None, folder: Path = "") -> Scenario:
    """The scenario in a YAML text, whose files are looked up in ``folder``. Raises `InputError`."""
    return Scenario(core.parse_scenario(text, os.fspath(folder), overrides(settings)))


def as_scenario(scenario: Scenario | Path) -> Scenario:
    """A scenario, or the one given by a path or name."""
    return scenario if isinstance(scenario, Scenario) else load(scenario)


def scenarios() -> dict[str, str]:
    """The shipped scenarios, each with a one-line description."""
    return dict(core.scenarios())


def systems() -> dict[str, str]:
    """The systems that have models."""
    return dict(core.systems())


def controllers() -> dict[str, str]:
    """The built-in controllers, for ``controller.kind``."""
    return dict(core.controllers())
