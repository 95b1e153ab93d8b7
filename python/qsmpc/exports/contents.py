"""The content of the files for third-party viewers as plain arrays, independent of the format."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import NDArray

from qsmpc._native import core
from qsmpc.episodes import Episode, read
from qsmpc.scenarios import Path

Floats = NDArray[np.float64]
Colour = tuple[float, float, float, float]

INFO, WARNING, ERROR = "info", "warning", "error"

#: The probability that the ellipses of beliefs contain.
ELLIPSE_PROBABILITY = 0.95
_ELLIPSE_POINTS = 48
_ARC_POINTS = 24
_CIRCLE_POINTS = 48
_MARGIN = 1.0  # around the drive, where the safe set has no bound

# sRGB and opacity, from Okabe and Ito's palette; visible on light and on dark backgrounds.
SKY: Colour = (0.34, 0.71, 0.91, 1.0)
BLUE: Colour = (0.00, 0.45, 0.70, 1.0)
GREEN: Colour = (0.00, 0.62, 0.45, 1.0)
ORANGE: Colour = (0.90, 0.62, 0.00, 1.0)
VERMILION: Colour = (0.84, 0.37, 0.00, 1.0)
SOLID: Colour = (0.50, 0.50, 0.50, 0.8)
PARTIAL: Colour = (0.50, 0.50, 0.50, 0.3)


@dataclass(frozen=True)
class Series:
    """A number over time. Non-finite values are left out."""

    group: str  #: series of one group are plotted together, e.g. ``state``
    name: str
    unit: str
    nanoseconds: NDArray[np.int64]
    values: Floats


@dataclass(frozen=True)
class Event:
    """A message at a time."""

    nanoseconds: int
    level: str
    text: str


@dataclass(frozen=True)
class Box:
    """A rectangle of the map."""

    lower: Floats
    upper: Floats
    is_partial: bool  #: whether it is unsafe only for some values of other states


def _nanoseconds(seconds: Floats) -> NDArray[np.int64]:
    """Rounded, so that 0.7 s does not become 699 999 999 ns."""
    return np.rint(np.asarray(seconds, float) * 1e9).astype(np.int64)


def _circle(radius: float, points: int) -> Floats:
    angles = np.linspace(0.0, 2.0 * np.pi, points)
    return radius * np.column_stack([np.cos(angles), np.sin(angles)])


def _within(corners: Floats, lower: Floats, upper: Floats) -> Floats:
    """The part of a polygon within a rectangle, corners × 2 (Sutherland and Hodgman)."""
    for axis in (0, 1):
        for sign, bound in ((1.0, lower[axis]), (-1.0, -upper[axis])):
            inside = sign * corners[:, axis] - bound
            kept: list[Floats] = []
            for k in range(len(corners)):
                before = k - 1
                if (inside[before] < 0.0) != (inside[k] < 0.0):
                    share = inside[before] / (inside[before] - inside[k])
                    kept.append(corners[before] + share * (corners[k] - corners[before]))
                if inside[k] >= 0.0:
                    kept.append(corners[k])
            corners = np.array(kept).reshape(-1, 2)
    return corners


class DriveMap:
    """An episode on a map of two of its states: the plane of its position, if it has one."""

    def __init__(self, episode: Episode, axes: tuple[int, int, bool]) -> None:
        self.episode = episode
        self.axes = list(axes[:2])
        self.is_plane = axes[2]
        self.heading = core.heading(episode.core) if self.is_plane else -1
        scenario = episode.scenario
        path = self.points(episode.states)
        path = np.vstack([path[np.isfinite(path).all(axis=1)], self.points(scenario.target)])
        lower, upper = (self.points(bound) for bound in scenario.bounds)
        self._bounds = lower, upper
        #: Corners of the shown area: the bounds, or around the drive where there are none.
        self.lower = np.where(np.isfinite(lower), lower, path.min(axis=0) - _MARGIN)
        self.upper = np.where(np.isfinite(upper), upper, path.max(axis=0) + _MARGIN)
        #: A length that scales lines and marks.
        self.size = float((self.upper - self.lower).max())

    def points(self, states: Floats) -> Floats:
        """The positions of states (… × n) on the map, … × 2."""
        return np.asarray(states)[..., self.axes]

    def headings(self, states: Floats) -> Floats:
        """Headings of states (… × n), rad; 0 for a system without heading."""
        if self.heading < 0:
            return np.zeros(np.shape(states)[:-1])
        return np.asarray(states)[..., self.heading]

    def obstacles(self) -> list[Box]:
        """Boxes of the unsafe set that restrict the states of the map, within the shown area."""
        boxes = []
        for lower, upper in self.episode.scenario.obstacles:
            restricted = np.isfinite(lower) | np.isfinite(upper)
            if not restricted[self.axes].any():
                continue
            others = np.delete(restricted, self.axes)
            low, high = (
                np.clip(self.points(end), self.lower, self.upper) for end in (lower, upper)
            )
            boxes.append(Box(low, high, is_partial=bool(others.any())))
        return boxes

    def shapes(self) -> list[Floats]:
        """Closed lines (points × 2) around the obstacles that are shapes in the plane, within the
        shown area."""
        if not self.is_plane:
            return []
        outlines = [
            _within(shape.outline, self.lower, self.upper)
            for shape in self.episode.scenario.shapes
        ]
        return [np.vstack([outline, outline[:1]]) for outline in outlines if len(outline)]

    def walls(self) -> list[Floats]:
        """Lines (2 × 2) where the safe set ends."""
        lines = []
        for axis in (0, 1):
            for bound in (self._bounds[0][axis], self._bounds[1][axis]):
                if np.isfinite(bound):
                    line = np.array([self.lower, self.upper])
                    line[:, axis] = bound
                    lines.append(line)
        return lines

    def target(self) -> Floats:
        """The circle around the target within which a drive has arrived, points × 2."""
        scenario = self.episode.scenario
        return self.points(scenario.target) + _circle(scenario.target_radius, _CIRCLE_POINTS)

    def body(self) -> list[Floats]:
        """Outlines (points × 2) of the vehicle in its own frame; none for a point."""
        lines = []
        for x, y, radius, start, end in core.body_outline(self.episode.scenario.core):
            angles = np.linspace(start, end, _ARC_POINTS)
            lines.append([x, y] + radius * np.column_stack([np.cos(angles), np.sin(angles)]))
        return lines

    def belief_ellipses(self) -> Floats:
        """Ellipses of the belief of each period, steps × points × 2."""
        means = self.points(self.episode.belief_means)
        covariances = self.episode.belief_covariances[:, self.axes][:, :, self.axes]
        radius = math.sqrt(-2.0 * math.log(1.0 - ELLIPSE_PROBABILITY))
        circle = _circle(radius, _ELLIPSE_POINTS)
        ellipses = np.full((len(means), _ELLIPSE_POINTS, 2), np.nan)
        for k in np.flatnonzero(np.isfinite(covariances).all(axis=(1, 2))):
            # Covariances may be singular, where a Cholesky factor would fail.
            values, vectors = np.linalg.eigh(covariances[k])
            root = vectors * np.sqrt(np.maximum(values, 0.0))
            ellipses[k] = means[k] + circle @ root.T
        return ellipses

    def plans(self) -> Floats:
        """Nominal paths, steps × (stages + 1) × 2; NaN without a plan."""
        return self.points(self.episode.plan_states)

    def particles(self, step: int, stage: int) -> tuple[Floats, Floats]:
        """Positions (points × 2) and weights of a stage's particles; empty if there are none."""
        try:
            locations, weights = self.episode.particles(step, stage)
        except IndexError:  # the plan of this step has no particles
            return np.empty((0, 2)), np.empty(0)
        return self.points(locations), weights


class Contents:
    """The content shown for an episode, or for the one at a path."""

    def __init__(self, trace: Union[Episode, Path]) -> None:
        self.episode = trace if isinstance(trace, Episode) else read(trace)
        self.scenario = self.episode.scenario
        axes = core.map_axes(self.episode.core)
        #: None for a system without any position state.
        self.map: Optional[DriveMap] = None if axes is None else DriveMap(self.episode, axes)
        self.state_nanoseconds = _nanoseconds(self.episode.times)
        self.step_nanoseconds = self.state_nanoseconds[: self.episode.steps]

    @property
    def title(self) -> str:
        return f"{self.scenario.name}, seed {self.episode.seed}"

    def about(self) -> dict[str, str]:
        """A description of the episode in words."""
        episode = self.episode
        words = {
            "scenario": self.scenario.name,
            "description": self.scenario.description,
            "system": self.scenario.system,
            "plant": self.scenario.plant,
            "controller": self.scenario.controller,
            "seed": str(episode.seed),
            "outcome": episode.outcome,
            "duration": f"{episode.duration:g} s, {episode.steps} periods",
            "version": episode.core.version,
            "certificates": "upper bounds of the probability of being unsafe",
        }
        if episode.fault:
            words["fault"] = episode.fault
        if self.scenario.no_bound:
            words["certificates"] = f"no bounds: {self.scenario.no_bound}"
        return words

    def series(self) -> Iterator[Series]:
        """Every number that is plotted over time."""
        episode = self.episode
        states, inputs = core.coordinates(episode.core)
        yield from self._columns("state", states, episode.states)
        yield from self._columns("observation", states, episode.observations)
        yield from self._columns("belief", states, episode.belief_means)
        yield from self._columns("input", inputs, episode.inputs)
        unit = core.clearance_unit(episode.core)
        yield self._series("clearance", "clearance", unit, episode.clearances)
        certified = episode.certificates["value"]
        yield self._series("certificate", "next_step", "", certified[:, 0])
        if episode.stages > 0:
            # By the union bound, like the program's own `horizon`.
            horizon = np.minimum(certified.sum(axis=1), 1.0)
            yield self._series("certificate", "horizon", "", horizon)
        limit = episode.summary["mission"]["limit"]
        if limit is not None:
            yield self._series("risk", "spent", "", np.nancumsum(certified[:, 0]))
            yield self._series("risk", "limit", "", np.full(episode.steps, float(limit)))

    def events(self) -> list[Event]:
        """Changes of the solver's status, and the outcome of the drive."""
        events = []
        before = None
        for nanoseconds, status in zip(self.step_nanoseconds, self.episode.statuses):
            if status and status != before:
                level = INFO if status == "converged" else WARNING
                events.append(Event(int(nanoseconds), level, f"solver: {status}"))
            before = status
        outcome = self.episode.outcome
        words = f"{outcome}: {self.episode.fault}" if self.episode.fault else outcome
        level = {"reached": INFO, "timeout": WARNING, "interrupted": WARNING}.get(outcome, ERROR)
        end = int(self.state_nanoseconds[-1]) if self.state_nanoseconds.size else 0
        events.append(Event(end, level, f"outcome: {words}"))
        return events

    def _series(self, group: str, name: str, unit: str, values: Any) -> Series:
        numbers = np.asarray(values, float)
        known = np.isfinite(numbers)
        times = self.state_nanoseconds[: len(numbers)]
        return Series(group, name, unit, times[known], numbers[known])

    def _columns(
        self, group: str, coordinates: list[tuple[str, str]], rows: Floats
    ) -> Iterator[Series]:
        for (name, unit), values in zip(coordinates, np.asarray(rows).T):
            yield self._series(group, name, unit, values)
