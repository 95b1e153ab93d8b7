"""A scenario of qsmpc as expressions of CasADi: dynamics, cost, and what is to be kept clear of.

Everything comes from the message that an outside controller is sent (docs/controllers.md); nothing is
written for one scenario.
"""

import functools
import json
import os
import sys

import casadi
import numpy

# m: rounding of distances where a box's nearest side changes. Distances are never overestimated.
ROUNDING = 0.05


def dubins(x, u, step, parameters):
    speed = parameters["speed"]
    return casadi.vertcat(
        x[0] + step * speed * casadi.cos(x[2]),
        x[1] + step * speed * casadi.sin(x[2]),
        x[2] + step * u[0],
    )


def dubins_rk4(x, u, step, parameters):
    """Simpson's rule along the arc, which the classical Runge-Kutta step is here."""
    reach = step * parameters["speed"] / 6.0
    headings = [x[2], x[2] + 0.5 * step * u[0], x[2] + step * u[0]]
    weights = [1.0, 4.0, 1.0]
    return casadi.vertcat(
        x[0] + reach * sum(w * casadi.cos(h) for w, h in zip(weights, headings)),
        x[1] + reach * sum(w * casadi.sin(h) for w, h in zip(weights, headings)),
        headings[2],
    )


def bicycle(x, u, step, parameters):
    """Linear tyres, implicit Euler in lateral speed and yaw rate."""
    mass, inertia = parameters["mass"], parameters["yaw_inertia"]
    front, rear = parameters["front_axle_distance"], parameters["rear_axle_distance"]
    stiff_front, stiff_rear = parameters["front_tyre_stiffness"], parameters["rear_tyre_stiffness"]
    speed, lateral, yaw_rate = x[3], x[4], x[5]
    cosine, sine = casadi.cos(x[2]), casadi.sin(x[2])
    coupling = step * (front * stiff_front - rear * stiff_rear)
    by_force = mass * speed - step * (stiff_front + stiff_rear)
    by_moment = inertia * speed - step * (front**2 * stiff_front + rear**2 * stiff_rear)
    sideways = (
        mass * speed * lateral
        + coupling * yaw_rate
        - step * stiff_front * u[1] * speed
        - step * mass * speed**2 * yaw_rate
    )
    turning = (
        inertia * speed * yaw_rate + coupling * lateral - step * front * stiff_front * u[1] * speed
    )
    return casadi.vertcat(
        x[0] + step * (speed * cosine - lateral * sine),
        x[1] + step * (lateral * cosine + speed * sine),
        x[2] + step * yaw_rate,
        speed + step * u[0],
        sideways / by_force,
        turning / by_moment,
    )


def double_integrator(x, u, step, parameters):
    return casadi.vertcat(x[0] + step * x[1] + 0.5 * step**2 * u[0], x[1] + step * u[0])


def point_mass(x, u, step, parameters):
    damping = parameters["damping"]
    decay = numpy.exp(-damping * step)
    gain = (1.0 - decay) / damping if damping > 0.0 else step
    reach = (step - gain) / damping if damping > 0.0 else 0.5 * step**2
    return casadi.vertcat(x[:2] + gain * x[2:] + reach * u, decay * x[2:] + gain * u)


# The step x⁺ of each system, as the planner's model has it.
SYSTEMS = {
    step.__name__: step for step in (dubins, dubins_rk4, bicycle, double_integrator, point_mass)
}


def _larger(a, b):
    """The larger of two distances, rounded, and never larger than it."""
    return 0.5 * (a + b + casadi.sqrt((a - b) ** 2 + ROUNDING**2) - ROUNDING)


def _smaller(a, b):
    """The smaller of two distances, rounded, and never larger than it."""
    return 0.5 * (a + b - casadi.sqrt((a - b) ** 2 + ROUNDING**2))


def _outside(value, lower, upper):
    """How far a number is out of an interval, below 0 within; None of an interval without ends."""
    if lower is None and upper is None:
        return None
    if lower is None:
        return value - upper
    if upper is None:
        return lower - value
    away = value - 0.5 * (lower + upper)
    return casadi.sqrt(away**2 + ROUNDING**2) - ROUNDING - 0.5 * (upper - lower)


class Problem:
    """The optimal control problem of a scenario's message."""

    def __init__(self, message):
        system = message["system"]
        if system["name"] not in SYSTEMS:
            raise ValueError(f"system {system['name']}, expected one of {', '.join(SYSTEMS)}")
        self.message = message
        self.options = message["options"]
        self.horizon = message["horizon"]
        self.state_dim = len(system["states"])
        self.input_dim = len(system["inputs"])
        self.lower = numpy.array([one["lower"] for one in system["inputs"]])
        self.upper = numpy.array([one["upper"] for one in system["inputs"]])
        self.noise = numpy.array(message["disturbance"]["covariance"])
        self.cost = {name: numpy.array(rows) for name, rows in message["cost"].items()}
        self.position = [system["position_x"], system["position_y"]]
        self.heading = system["heading"]
        x = casadi.SX.sym("x", self.state_dim)
        u = casadi.SX.sym("u", self.input_dim)
        following = SYSTEMS[system["name"]](x, u, message["time_step"], system["parameters"])
        self.step = casadi.Function("step", [x, u], [following])
        slopes = [casadi.jacobian(following, x), casadi.jacobian(following, u)]
        self.slopes = casadi.Function("slopes", [x, u], slopes)
        distances = self._clearances(x)
        self.clearances = casadi.Function("clearances", [x], [casadi.vertcat(*distances)])
        least = functools.reduce(_smaller, distances) if distances else casadi.SX(0, 1)
        self.clearance = casadi.Function("clearance", [x], [least])

    def stage_cost(self, state, control, target):
        away = state - target
        return 0.5 * away.T @ self.cost["state"] @ away + control.T @ self.cost["input"] @ control

    def terminal_cost(self, state, target):
        away = state - target
        return away.T @ self.cost["terminal"] @ away

    def target_near(self, state):
        """The target, its angles moved by whole turns to be the nearest to a state's."""
        target = numpy.array(self.message["target"]["state"], float)
        for i in self.message["target"]["angles"]:
            target[i] += 2.0 * numpy.pi * round((state[i] - target[i]) / (2.0 * numpy.pi))
        return target

    def risk_per_stage(self):
        """The probability that a stage may be unsafe with; None without a limit."""
        risk = self.message["risk"]
        limits = [] if risk["stage"] is None else [risk["stage"]]
        if risk["plan"] is not None:
            limits.append(risk["plan"] / self.horizon)
        if risk["mission"] is not None:
            limits.append(risk["mission"] / self.message["step_limit"])
        return min(limits) if limits else None

    def roll_out(self, state, inputs):
        """The noise-free path from a state under inputs (stages × m): (stages + 1) × n."""
        path = [numpy.asarray(state, float)]
        for control in inputs:
            path.append(self.step(path[-1], control).full().ravel())
        return numpy.array(path)

    def gains(self, path, inputs):
        """Gains by which a linear-quadratic regulator follows a path: m × n for each stage."""
        effort = self.options.get("feedback_effort", 1.0)
        # In the cost, only the states' weights carry a factor ½.
        cost_to_go = 2.0 * self.cost["terminal"]
        weight = 2.0 * effort * self.cost["input"]
        gains = []
        for state, control in zip(path[-2::-1], inputs[::-1]):
            by_state, by_input = (slope.full() for slope in self.slopes(state, control))
            to_go = by_input.T @ cost_to_go
            gain = -numpy.linalg.solve(weight + to_go @ by_input, to_go @ by_state)
            closed = by_state + by_input @ gain
            cost_to_go = (
                self.cost["state"] + gain.T @ weight @ gain + closed.T @ cost_to_go @ closed
            )
            gains.append(gain)
        return gains[::-1]

    @staticmethod
    def status(stats):
        """How IPOPT ended, in the words of a plan."""
        if stats["success"]:
            return "converged"
        names = {
            "Maximum_Iterations_Exceeded": "iteration_limit",
            "Maximum_WallTime_Exceeded": "deadline",
            "Infeasible_Problem_Detected": "infeasible",
        }
        return names.get(stats["return_status"], "numerical_trouble")

    def _discs(self, state):
        """Centre and radius of each disc of the body; of a point, its position."""
        x, y = (state[i] for i in self.position)
        discs = self.message["footprint"] or [{"radius": 0.0, "offset": [0.0, 0.0]}]
        heading = 0.0 if self.heading is None else state[self.heading]
        cosine, sine = casadi.cos(heading), casadi.sin(heading)
        for disc in discs:
            forward, left = disc["offset"]
            centre = [x + forward * cosine - left * sine, y + forward * sine + left * cosine]
            yield centre, disc["radius"]

    def _clearances(self, state):
        """Distances from bounds and obstacles (≥ 0: safe), of the whole body."""
        safe = self.message["safe_set"]
        has_place = None not in self.position
        bodies = list(self._discs(state)) if has_place else []
        distances = []
        for i in range(self.state_dim):
            is_place = has_place and i in self.position
            axis = self.position.index(i) if is_place else None
            values = [(c[axis], r) for c, r in bodies] if is_place else [(state[i], 0.0)]
            for value, radius in values:
                if safe["lower"][i] is not None:
                    distances.append(value - radius - safe["lower"][i])
                if safe["upper"][i] is not None:
                    distances.append(safe["upper"][i] - value - radius)
        for box in safe["obstacles"]:
            if "lower" not in box:
                raise ValueError(f"obstacles must be boxes, not a shape ({next(iter(box))})")
            for centre, radius in bodies or [([], 0.0)]:
                at = [state[i] for i in range(self.state_dim)]
                for axis, value in enumerate(centre):
                    at[self.position[axis]] = value
                distance = None
                for value, lower, upper in zip(at, box["lower"], box["upper"]):
                    beside = _outside(value, lower, upper)
                    if beside is not None:
                        distance = beside if distance is None else _larger(distance, beside)
                if distance is not None:
                    distances.append(distance - radius)
        return distances


def serve(make):
    """Answers qsmpc's messages with the controller that ``make`` returns for a `Problem`, until the
    end. A controller has ``reset(seed)`` and ``plan(situation)``, which returns a plan's dict."""

    answers = os.fdopen(os.dup(sys.stdout.fileno()), "w", encoding="utf-8")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # output of solvers must not reach stdout

    def answer(message):
        print(json.dumps(message), file=answers, flush=True)

    try:
        controller = make(Problem(json.loads(sys.stdin.readline())))
    except ValueError as error:
        answer({"error": str(error)})
        return
    answer({"protocol": 1})
    for line in sys.stdin:
        message = json.loads(line)
        if message["type"] == "end":
            break
        if message["type"] == "reset":
            controller.reset(message["seed"])
        else:
            answer({"plan": controller.plan(message)})
