"""Scenario MPC with CasADi for the car of constant speed, as an external controller of qsmpc.

Every period, one sequence of turn rates is sought that is best on average over sampled noise, with a
soft constraint for every sample, stage and obstacle. Options: scenarios, how many samples; margin, m,
that the path keeps from boxes; weight of entering them.
"""

import json
import sys

import casadi
import numpy


def answer(message):
    print(json.dumps(message), flush=True)


class ScenarioMpc:
    def __init__(self, scenario):
        self.horizon = scenario["horizon"]
        self.samples = scenario["options"]["scenarios"]
        self.noise = numpy.array(scenario["disturbance"]["covariance"])
        self.lower = scenario["system"]["inputs"][0]["lower"]
        self.upper = scenario["system"]["inputs"][0]["upper"]
        self.solver = self.build(scenario)
        self.reset(0)

    def reset(self, seed):
        self.random = numpy.random.default_rng(seed)
        self.guess = numpy.zeros(self.horizon)
        self.first = True

    def build(self, scenario):
        step = scenario["time_step"]
        speed = scenario["system"]["parameters"]["speed"]
        target = casadi.DM(scenario["target"]["state"])
        cost = {name: casadi.DM(rows) for name, rows in scenario["cost"].items()}
        inputs = casadi.SX.sym("u", self.horizon)
        start = casadi.SX.sym("x0", 3, self.samples)
        noise = casadi.SX.sym("w", 3 * self.horizon, self.samples)
        total = self.samples * cost["input"][0, 0] * casadi.sumsqr(inputs)
        for sample in range(self.samples):
            state = start[:, sample]
            for k in range(self.horizon):
                away = state - target
                total += 0.5 * away.T @ cost["state"] @ away
                move = casadi.vertcat(
                    step * speed * casadi.cos(state[2]),
                    step * speed * casadi.sin(state[2]),
                    step * inputs[k],
                )
                state = state + move + noise[3 * k : 3 * k + 3, sample]
                total += self.penalty(state, scenario)
            away = state - target
            total += away.T @ cost["terminal"] @ away
        problem = {
            "x": inputs,
            "f": total / self.samples,
            "p": casadi.vertcat(casadi.vec(start), casadi.vec(noise)),
        }
        quiet = {"print_time": False, "ipopt": {"print_level": 0, "sb": "yes", "max_iter": 60}}
        return casadi.nlpsol("mpc", "ipopt", problem, quiet)

    def penalty(self, state, scenario):
        """Of being within `margin` of a box, or of what is outside of the bounds."""
        margin = scenario["options"]["margin"]
        total = 0
        for box in scenario["safe_set"]["obstacles"]:
            depths = [
                casadi.fmin(state[i] - box["lower"][i], box["upper"][i] - state[i]) + margin
                for i in range(2)
            ]
            total += casadi.fmax(casadi.fmin(*depths), 0) ** 2
        for i in range(2):
            for beyond in (
                scenario["safe_set"]["lower"][i] - state[i],
                state[i] - scenario["safe_set"]["upper"][i],
            ):
                total += casadi.fmax(beyond + margin, 0) ** 2
        return scenario["options"]["weight"] * total

    def plan(self, belief):
        mean = numpy.array(belief["mean"])
        covariance = numpy.array(belief["covariance"])
        start = self.random.multivariate_normal(mean, covariance, self.samples)
        noise = self.random.multivariate_normal(
            numpy.zeros(3), self.noise, (self.samples, self.horizon)
        )
        # casadi.vec goes down the columns, a sample each.
        values = numpy.concatenate([start.ravel(), noise.ravel()])
        # At first the ways round the boxes are tried from several turns.
        guesses = [self.guess]
        if self.first:
            guesses += [numpy.full(self.horizon, turn) for turn in (-1.0, 1.0)]
        self.first = False
        found = []
        for guess in guesses:
            result = self.solver(x0=guess, p=values, lbx=self.lower, ubx=self.upper)
            stats = self.solver.stats()
            found.append((float(result["f"]), result["x"].full().ravel(), stats))
        _, best, stats = min(found, key=lambda entry: entry[0])
        # The solver ends a little beyond the bounds.
        best = numpy.clip(best, self.lower, self.upper)
        self.guess = numpy.append(best[1:], best[-1])
        return {
            "inputs": [[turn_rate] for turn_rate in best],
            "status": "converged" if stats["success"] else "iteration_limit",
            "evaluations": stats["iter_count"],
        }


def main():
    scenario = json.loads(sys.stdin.readline())
    mpc = ScenarioMpc(scenario)
    answer({"protocol": 1})
    for line in sys.stdin:
        message = json.loads(line)
        if message["type"] == "end":
            break
        if message["type"] == "reset":
            mpc.reset(message["seed"])
        else:
            answer({"plan": mpc.plan(message["belief"])})


main()
