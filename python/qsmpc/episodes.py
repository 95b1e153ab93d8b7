"""Episodes: driving, reading, writing, showing."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from typing import Any, Optional, Protocol, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from qsmpc._native import core
from qsmpc.scenarios import Path, Scenario, as_scenario

Floats = NDArray[np.float64]


class Controller(Protocol):
    """The interface of controllers. A function of the situation works as well.

    ``act`` returns an array of inputs. With an attribute ``plans = True`` it returns a plan
    instead, which is certified: an object or a dict with ``inputs`` (stages × m) and, optionally,
    ``gains`` (stages × m × n), ``status`` and ``evaluations``, such as that returned by `Planner`.
    ``reset(seed)``, if defined, is called before each drive.
    """

    def act(self, situation: core.Situation) -> Any: ...


def _size(size: Optional[tuple[int, int]]) -> Optional[tuple[int, int]]:
    return None if size is None else (int(size[0]), int(size[1]))


class Episode:
    """The record of one drive, as arrays with one row per control period.

    ``states``, ``times`` and ``clearances`` have one row more than ``steps``: the final state of
    the drive. What a controller does not provide is empty or NaN.
    """

    __slots__ = ("core", "_summary")

    def __init__(self, episode: core.Episode) -> None:
        self.core = episode
        self._summary: Optional[dict[str, Any]] = None

    @property
    def scenario(self) -> Scenario:
        return Scenario(self.core.scenario)

    @property
    def seed(self) -> int:
        return self.core.seed

    @property
    def outcome(self) -> str:
        """``reached``, ``collision``, ``left_bounds``, ``timeout``, ``fault`` or ``interrupted``."""
        return self.core.outcome

    @property
    def fault(self) -> str:
        """The cause of a fault; empty without one."""
        return self.core.fault

    @property
    def controller_log(self) -> str:
        """What an external controller wrote to its standard error."""
        return self.core.controller_log

    @property
    def steps(self) -> int:
        return self.core.steps

    @property
    def duration(self) -> float:
        """Time to the end of the last control period, s."""
        return self.core.duration

    @property
    def summary(self) -> dict[str, Any]:
        """The numbers of ``summary.json``, by key."""
        if self._summary is None:
            self._summary = json.loads(self.core.summary_json())
        return self._summary

    @property
    def times(self) -> Floats:
        """Times of ``states``, s."""
        return self.core.times

    @property
    def states(self) -> Floats:
        """True states at the control instants, (steps + 1) × n."""
        return self.core.states

    @property
    def clearances(self) -> Floats:
        """Distances of these states to the unsafe set, steps + 1; at most 0 for unsafe states."""
        return self.core.clearances

    @property
    def observations(self) -> Floats:
        """The states as observed by the controller, steps × n."""
        return self.core.observations

    @property
    def inputs(self) -> Floats:
        """Applied inputs, steps × m."""
        return self.core.inputs

    @property
    def disturbances(self) -> Floats:
        """The noise added to the state at the end of each period, steps × n."""
        return self.core.disturbances

    @property
    def residuals(self) -> Floats:
        """The part of the next state that model and disturbance do not explain, periods × n."""
        return self.core.residuals

    @property
    def belief_means(self) -> Floats:
        """Means of the beliefs that the plans were made for, steps × n."""
        return self.core.belief_means

    @property
    def belief_covariances(self) -> Floats:
        """Their covariances, steps × n × n."""
        return self.core.belief_covariances

    @property
    def stages(self) -> int:
        """Stages of each plan; 0 if the controller makes none."""
        return self.core.stages

    @property
    def plan_inputs(self) -> Floats:
        """Nominal inputs of the plans, steps × stages × m."""
        return self.core.plan_inputs

    @property
    def plan_states(self) -> Floats:
        """Nominal states of the plans, steps × (stages + 1) × n."""
        return self.core.plan_states

    @property
    def plan_gains(self) -> Floats:
        """Gains of the plans, steps × stages × m × n."""
        return self.core.plan_gains

    @property
    def plan_costs(self) -> dict[str, Floats]:
        """Expected costs of the plans by part; each has length steps."""
        return self.core.plan_costs

    @property
    def statuses(self) -> list[str]:
        """The solver's status at each step."""
        return self.core.statuses

    @property
    def has_particles(self) -> bool:
        return self.core.has_particles

    def particles(self, step: int, stage: int) -> tuple[Floats, Floats]:
        """Locations (points × n) and weights (points) of a stage of the plan of a step.

        Raises `IndexError` if there are none.
        """
        return self.core.particles(step, stage)

    @property
    def certificates(self) -> dict[str, Floats]:
        """Upper bounds of the probability of being unsafe, steps × stages (1 without plans).

        ``value`` is the least of ``c1`` … ``c4`` and, if computed, ``c5``; ``thesis`` is the
        published value, which is not a bound. The others are bounds unless ``scenario.no_bound``
        says why not.
        """
        return self.core.certificates

    @property
    def w2_bounds(self) -> Floats:
        """2-Wasserstein errors of the particles, steps × (stages + 1)."""
        return self.core.w2_bounds

    @property
    def timings(self) -> dict[str, Floats]:
        """Wall-clock times, ms: quantise, propagate, optimise, certify, total, simulate."""
        return self.core.timings

    @property
    def motion(self) -> tuple[Floats, Floats]:
        """Times (samples) and joint positions (samples × nq) of the MuJoCo vehicle."""
        return self.core.motion

    def save(self, folder: Path) -> None:
        """Writes the files of ``qsmpc run`` except the video: trace, summary, scenario and page."""
        self.core.save(os.fspath(folder))

    def video(
        self,
        path: Path,
        *,
        camera: str = "",
        size: Optional[tuple[int, int]] = None,
        fps: Optional[int] = None,
        speed: float = 1.0,
    ) -> None:
        """Writes a video, by default with the scenario's settings. The format (MP4, WebM, GIF or
        WebP) follows from the path's extension."""
        self.core.write_video(os.fspath(path), camera, _size(size), fps, float(speed))

    def still(
        self,
        path: Path,
        time: float,
        *,
        camera: str = "",
        size: Optional[tuple[int, int]] = None,
    ) -> None:
        """Writes the picture at a time (s) as PNG."""
        self.core.write_still(os.fspath(path), float(time), camera, _size(size))

    def page(self) -> str:
        """The report as one self-contained HTML page."""
        return self.core.page()

    def figures(self, folder: Path) -> list[str]:
        """Writes figures for papers, SVG and PDF, into ``folder/figures``. Returns their paths."""
        return self.core.write_figures(os.fspath(folder))

    def plot(self, axes: Any = None) -> Any:
        """The map of the drive on Matplotlib's ``axes``, new ones by default. Returns them."""
        from qsmpc.plotting import plot_episode

        return plot_episode(self, axes)

    def _repr_html_(self) -> str:
        from qsmpc.notebook import episode_html

        return episode_html(self)

    def __repr__(self) -> str:
        return (
            f"<qsmpc.Episode {self.core.scenario.name}, seed {self.seed}: {self.outcome} after "
            f"{self.duration:.1f} s>"
        )


def run(
    scenario: Scenario | Path,
    *,
    seed: Optional[int] = None,
    controller: Union[Controller, Callable[[core.Situation], ArrayLike], None] = None,
    plant_seed: Optional[int] = None,
    out: Optional[Path] = None,
    on_step: Optional[Callable[[int, float], None]] = None,
) -> Episode:
    """Drives one episode with the scenario's controller or a custom one.

    With ``out`` the trace is written there step by step and the other files of ``qsmpc run`` at the
    end; after Ctrl-C they hold what was driven, and KeyboardInterrupt is raised. ``on_step`` is
    called with the number of finished steps and the time (s). An exception in a controller ends the
    drive as a fault of the controller. Raises `InputError` and `IoError`.
    """
    scenario = as_scenario(scenario)
    return Episode(
        core.run(
            scenario.core,
            controller,
            scenario.seed if seed is None else seed,
            plant_seed,
            "" if out is None else os.fspath(out),
            on_step,
        )
    )


def read(path: Path) -> Episode:
    """The episode in a trace file, or in the folder of one. Raises `InputError` and `IoError`."""
    return Episode(core.read_episode(os.fspath(path)))
