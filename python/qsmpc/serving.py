"""A Python controller as a separate process, for the command line and for campaigns."""

from __future__ import annotations

import json
import math
import os
import sys
from types import SimpleNamespace
from typing import Any, Callable, Union

import numpy as np

PROTOCOL = 1


def _plain(value: Any) -> Any:
    """Arrays as lists."""
    return value.tolist() if hasattr(value, "tolist") else value


def _answer(value: Any, plans: bool) -> dict[str, Any]:
    if isinstance(value, dict) and ("plan" in value or "input" in value):
        return value
    if not plans:
        return {"input": np.atleast_1d(np.asarray(value, float)).tolist()}
    get = value.get if isinstance(value, dict) else lambda key: getattr(value, key, None)
    plan = {key: _plain(get(key)) for key in ("inputs", "gains", "status", "evaluations")}
    return {"plan": {key: part for key, part in plan.items() if part is not None}}


def _situation(message: dict[str, Any]) -> SimpleNamespace:
    return SimpleNamespace(
        period=message["period"],
        time=message["time"],
        observation=np.array(message["observation"], float),
        belief_mean=np.array(message["belief"]["mean"], float),
        belief_covariance=np.array(message["belief"]["covariance"], float),
        periods_left=message["periods_left"],
        waypoints_passed=message.get("waypoints_passed"),
        deadline=math.inf if message.get("deadline") is None else message["deadline"],
    )


def serve(make: Callable[[dict[str, Any]], Any]) -> None:
    """Answers qsmpc on standard input and output until it has no more requests.

    ``make`` is called with the scenario (docs/controllers.md lists its keys) and returns a
    controller as for `run`: an object with ``act(situation)``, or a function. Such a program is,
    for example,

        import qsmpc

        class Straight:
            def __init__(self, scenario): ...
            def act(self, situation): return [-0.5 * situation.observation[2]]

        if __name__ == "__main__":
            qsmpc.serve(Straight)

    and is used with ``controller: {kind: external, command: [python3, straight.py]}``. What the
    controller prints goes to standard error, which is kept in ``controller.log``.
    """
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "w", encoding="utf-8")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())

    def say(answer: dict[str, Any]) -> None:
        answers.write(json.dumps(answer, default=_plain) + "\n")
        answers.flush()

    controller: Any = None
    plans = False
    for line in sys.stdin:
        message = json.loads(line)
        kind = message["type"]
        if kind == "scenario":
            plans = bool(message["plans"])
            controller = make(message)
            say({"protocol": PROTOCOL})
        elif kind == "reset":
            if hasattr(controller, "reset"):
                controller.reset(message["seed"])
        elif kind == "situation":
            act = getattr(controller, "act", controller)
            say(_answer(act(_situation(message)), plans))
        elif kind == "end":
            break
