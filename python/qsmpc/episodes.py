"""Episodes: driven, read, written, shown."""

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
    """What may drive. A function of the situation will do, too.

    ``act`` answers an array of inputs. With an attribute ``plans = True`` it answers a plan instead,
    which is certified: an object or a dict with ``inputs`` (stages × m), and, where it has them,
    ``gains`` (stages × m × n), ``status`` and ``evaluations``; what `Planner` returns is one.
    ``reset(seed)``, where it is there, is called before each drive.
    """

    def act(self, situation: core.Situation) -> Any: ...


def _size(size: Optional[tuple[int, int]]) -> Optional[tuple[int, int]]:
    return None if size is None else (int(size[0]), int(size[1]))


class Episode:
    """The record of one drive, as arrays with a control period as a row.

    ``states``, ``times`` and ``clearances`` have a row more than there are ``steps``: the state in
    which the drive ended. What a controller does not have is empty, or not a number.
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
        """What broke; empty without a fault."""
        return self.core.fault

    @property
    def controller_log(self) -> str:
        """What a controller in a process of its own wrote to its standard error."""
        return self.core.controller_log

    @property
    def steps(self) -> int:
        return self.core.steps

    @property
    def duration(self) -> float:
        """s, to the end of the last control period."""
        return self.core.duration

    @property
    def summary(self) -> dict[str, Any]:
        """The numbers of ``summary.json``, under its keys."""
        if self._summary is None:
            self._summary = json.loads(self.core.summary_json())
        return self._summary

    @property
    def times(self) -> Floats:
        """s, of ``states``."""
        return self.core.times

    @property
    def states(self) -> Floats:
        """True states at the control instants, (steps + 1) × n."""
        return self.core.states

    @property
    def clearances(self) -> Floats:
        """Distances of these states to the unsafe set, steps + 1; at most 0 where it is unsafe."""
        return self.core.clearances

    @property
    def observations(self) -> Floats:
        """What the controller saw of the states, steps × n."""
        return self.core.observations

    @property
    def inputs(self) -> Floats:
        """Inputs that were applied, steps × m."""
        return self.core.inputs

    @property
    def disturbances(self) -> Floats:
        """What was added to the state at the end of each period, steps × n."""
        return self.core.disturbances

    @property
    def residuals(self) -> Floats:
        """What neither the model nor the disturbance explains of the next state, periods × n."""
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
        """Stages of each plan; 0 where the controller makes none."""
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
        """Expected costs of the plans by part, steps each."""
        return self.core.plan_costs

    @property
    def statuses(self) -> list[str]:
        """How the solver ended, for each step."""
        return self.core.statuses

    @property
    def has_particles(self) -> bool:
        return self.core.has_particles

    def particles(self, step: int, stage: int) -> tuple[Floats, Floats]:
        """Locations (points × n) and weights (points) of a stage of the plan of a step.

        Raises `IndexError` where there are none.
        """
        return self.core.particles(step, stage)

    @property
    def certificates(self) -> dict[str, Floats]:
        """Upper bounds of the probability to be unsafe, steps × stages (1 without plans).

        ``value`` is the least of ``c1`` … ``c4`` and, where it was worked out, ``c5``; ``thesis`` is the published value, and no bound.
        They are bounds unless ``scenario.no_bound`` says why not.
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
        """Writes what ``qsmpc run`` leaves, but the video: trace, summary, scenario and page."""
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
        """Writes a video; without settings as the scenario has them. MP4, WebM, GIF or WebP, by the
        ending of the path."""
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
        """The report as one page of HTML that needs nothing else."""
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
    """Drives one episode, with the scenario's controller or with one of your own.

    With ``out`` the trace is written there step by step and the other files of ``qsmpc run`` at the
    end; Ctrl-C leaves what was driven, and is raised then. ``on_step`` is told how many steps are
    done, and the time (s). An exception in a controller ends the drive as a fault of the
    controller. Raises `InputError` and `IoError`.
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
