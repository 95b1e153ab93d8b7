"""Plans from any belief, and certificates of any plans, without a plant."""

from __future__ import annotations

import math
from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from qsmpc._native import core
from qsmpc.scenarios import Path, Scenario, as_scenario

Floats = NDArray[np.float64]
_UNKNOWN = 1_000_000  # periods left, if unknown


def _moment(
    scenario: Scenario,
    situation: Optional[core.Situation],
    mean: Optional[ArrayLike],
    covariance: Optional[ArrayLike],
    observation: Optional[ArrayLike],
    period: int,
    periods_left: int,
    deadline: float,
    waypoints_passed: Optional[int] = None,
) -> core.Moment:
    if situation is not None:
        return core.Moment.of(
            situation.belief_mean,
            situation.belief_covariance,
            situation.observation,
            situation.period,
            situation.periods_left,
            situation.deadline,
            situation.obstacles,
            situation.waypoints_passed,
        )
    at = scenario.initial_mean if mean is None else np.asarray(mean, float)
    spread = scenario.initial_covariance if covariance is None else np.asarray(covariance, float)
    seen = at if observation is None else np.asarray(observation, float)
    if spread.ndim == 1:
        spread = np.diag(spread)
    return core.Moment.of(at, spread, seen, period, periods_left, deadline, None, waypoints_passed)


class Plan:
    """A controller's decision with its certificates."""

    __slots__ = ("core", "no_bound")

    def __init__(self, plan: core.Plan, no_bound: str = "") -> None:
        self.core = plan
        #: Why the certificates are not upper bounds; empty if they are.
        self.no_bound = no_bound

    @property
    def input(self) -> Floats:
        """The input for this period, m."""
        return self.core.input

    @property
    def inputs(self) -> Floats:
        """Nominal inputs, stages × m; empty if the controller plans nothing."""
        return self.core.inputs

    @property
    def states(self) -> Floats:
        """The model's path under these inputs from the belief's mean, (stages + 1) × n."""
        return self.core.states

    @property
    def gains(self) -> Floats:
        """Feedback gains of the inputs on the state's deviation from that path, stages × m × n."""
        return self.core.gains

    @property
    def status(self) -> str:
        """The solver's status; empty without a solver."""
        return self.core.status

    @property
    def evaluations(self) -> int:
        return self.core.evaluations

    @property
    def fallback(self) -> bool:
        """Whether no usable plan was found, so that the previous plan is continued."""
        return self.core.fallback

    @property
    def believed(self) -> float:
        """The controller's own estimate of the probability that the next state is unsafe, not a
        bound; NaN if it has none."""
        return self.core.believed

    @property
    def costs(self) -> dict[str, float]:
        """The expected cost by part; NaN if the controller has none."""
        return self.core.costs

    @property
    def certificates(self) -> dict[str, Floats]:
        """Upper bounds of the probability of being unsafe, one per stage, as in `Episode`."""
        return self.core.certificates

    @property
    def horizon_bound(self) -> float:
        """Upper bound of the probability of being unsafe at any stage."""
        return self.core.horizon_bound

    @property
    def w2_bounds(self) -> Floats:
        """2-Wasserstein errors of the particles, from stage 0 on."""
        return self.core.w2_bounds

    @property
    def particle_stages(self) -> int:
        """Number of stages with particles, including stage 0; 0 if there are none."""
        return self.core.particle_stages

    def particles(self, stage: int) -> tuple[Floats, Floats]:
        """Locations (points × n) and weights (points) of a stage. Raises `IndexError`."""
        return self.core.particles(stage)

    @property
    def solve_ms(self) -> float:
        """Wall-clock time of deciding and certifying, ms."""
        return self.core.solve_ms

    def __repr__(self) -> str:
        words = ""
        if self.certificates["value"].size:
            sign = "no bound:" if self.no_bound else "<="
            words = f", P(unsafe) {sign} {self.horizon_bound:.3g}"
        return f"<qsmpc.Plan input {self.input}, {self.status or 'no solver'}{words}>"


class Planner:
    """The controller of a scenario, to be called at any belief, e.g. in a custom loop.

        planner = qsmpc.Planner("dubins_obstacles")
        plan = planner.decide(mean=[0, 0, 0], covariance=[0.01, 0.01, 0.001])
        plan.input, plan.horizon_bound

    It remembers its last plan and starts from it: call `reset` before another drive. Use it from
    one thread at a time. It is itself a controller for `run`, with plans.
    """

    plans = True

    def __init__(self, scenario: Scenario | Path, *, certify: bool = True) -> None:
        """``certify``: whether plans come with certificates."""
        self.scenario = as_scenario(scenario)
        self._certify = certify
        self._core = core.Planner(self.scenario.core)

    def reset(self, seed: int = 0) -> None:
        """Forgets the periods so far. ``seed``: for controllers that draw random numbers."""
        self._core.reset(seed)

    def act(self, situation: core.Situation) -> Plan:
        """The plan in a situation of `run`."""
        return self.decide(situation)

    def decide(
        self,
        situation: Optional[core.Situation] = None,
        *,
        mean: Optional[ArrayLike] = None,
        covariance: Optional[ArrayLike] = None,
        observation: Optional[ArrayLike] = None,
        period: int = 0,
        periods_left: int = _UNKNOWN,
        deadline: float = math.inf,
        waypoints_passed: Optional[int] = None,
    ) -> Plan:
        """Plans in a situation, or from a belief with ``mean`` (n) and ``covariance`` (n × n, or
        its diagonal), by default those of the scenario's initial state.

        ``observation`` is the observed current state, by default the mean; ``deadline`` (s from
        now) is when the best plan so far is returned; ``waypoints_passed``, for a scenario with
        waypoints, says which is next, by default the first. Raises `ValueError`.
        """
        moment = _moment(
            self.scenario,
            situation,
            mean,
            covariance,
            observation,
            period,
            periods_left,
            deadline,
            waypoints_passed,
        )
        return Plan(self._core.decide(moment, self._certify), self.scenario.no_bound)


class Certifier:
    """Certifies inputs and plans from any source for a scenario's model and unsafe set."""

    def __init__(self, scenario: Scenario | Path) -> None:
        self.scenario = as_scenario(scenario)
        self._core = core.Certifier(self.scenario.core)

    def plan(
        self,
        inputs: ArrayLike,
        gains: Optional[ArrayLike] = None,
        *,
        mean: Optional[ArrayLike] = None,
        covariance: Optional[ArrayLike] = None,
        observation: Optional[ArrayLike] = None,
        period: int = 0,
    ) -> Plan:
        """Certifies every stage of the policy u = sat(v + K (x − x̄)) with ``inputs`` v (stages ×
        m) and ``gains`` K (stages × m × n; none: open loop) from a belief as in `Planner.decide`.

        Raises `ValueError` on wrong sizes and on inputs outside their bounds.
        """
        moment = _moment(
            self.scenario, None, mean, covariance, observation, period, _UNKNOWN, math.inf
        )
        all_gains: Any = None if gains is None else np.ascontiguousarray(gains, float)
        return Plan(
            self._core.plan(np.asarray(inputs, float), all_gains, moment), self.scenario.no_bound
        )

    def input(
        self,
        input: ArrayLike,
        *,
        mean: Optional[ArrayLike] = None,
        covariance: Optional[ArrayLike] = None,
        observation: Optional[ArrayLike] = None,
        period: int = 0,
    ) -> Plan:
        """Certifies only the next state, under ``input`` (m), from what is known about the state
        once it has been observed. Raises as `plan`."""
        moment = _moment(
            self.scenario, None, mean, covariance, observation, period, _UNKNOWN, math.inf
        )
        return Plan(self._core.input(np.asarray(input, float), moment), self.scenario.no_bound)
