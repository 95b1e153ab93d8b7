"""Plans of one open-loop problem by CasADi's SQP on generated C, and by this program, side by side.

    python3 -m venv env
    env/bin/pip install casadi==3.6.7 numpy==2.2.6
    PYTHONPATH=build/test/python/package taskset -c 0 env/bin/python tests/bench/casadi_sqp.py

The problem is that of tests/bench/scenarios/dubins_blocks.yaml without its blocks and walls: the
expected quadratic cost of the Dubins car over 8 stages, from beliefs along a drive, each plan
starting from the previous one. CasADi minimises the mean over sampled paths (sqpmethod with qrqp,
exact Hessian, compiled with -O3 -march=native), `scenario` the same, `quantised` the mean over its
particles. The gap is how much more a plan truly costs than the best known one, by 200,000 paths
that all plans share; the best known one is CasADi's for 20,000 other paths.
"""
import argparse
import os
import subprocess
import tempfile
import time

import casadi
import numpy
import qsmpc

HORIZON = 8
SCENARIO = os.path.join(os.path.dirname(__file__), "scenarios", "dubins_blocks.yaml")
SETTINGS = {
    "controller.horizon": HORIZON,
    "controller.policy": "open_loop",
    "safe_set.obstacles": [],
    "safe_set.bounds": {"x": [-1000, 1000], "y": [-1000, 1000]},
    "vehicle.footprint": "point",
}


def square(values):
    """A matrix, of which a list is the diagonal."""
    values = numpy.array(values, dtype=float)
    return numpy.diag(values) if values.ndim == 1 else values


class Problem:
    def __init__(self, scenario):
        cost = scenario.to_dict()["controller"]["cost"]
        self.time_step = scenario.time_step
        self.speed = scenario["model.speed"]
        self.q, self.r, self.p = (square(cost[name]) for name in ("state", "input", "terminal"))
        self.r = self.r[0, 0]
        (self.lower,), (self.upper,) = scenario.input_bounds
        self.noise = scenario.disturbance_covariance
        self.target = scenario.target

    def step(self, state, turn, library):
        reach = self.time_step * self.speed
        return [
            state[0] + reach * library.cos(state[2]),
            state[1] + reach * library.sin(state[2]),
            state[2] + self.time_step * turn,
        ]

    def true_cost(self, turns, start, noise):
        state = [start[:, i].copy() for i in range(3)]
        total = 0.0
        for k, turn in enumerate(turns):
            away = numpy.stack(state) - self.target[:, None]
            total += 0.5 * numpy.einsum("in,ij,jn->n", away, self.q, away).mean()
            total += self.r * turn * turn
            state = self.step(state, turn, numpy)
            state = [state[i] + noise[k][:, i] for i in range(3)]
        away = numpy.stack(state) - self.target[:, None]
        return total + numpy.einsum("in,ij,jn->n", away, self.p, away).mean()


class CasadiSqp:
    """The sampled problem, mapped over paths, as compiled C."""

    def __init__(self, problem, paths, folder, compiled=True):
        self.problem, self.paths = problem, paths
        turns = casadi.SX.sym("u", HORIZON)
        start = casadi.SX.sym("x0", 3)
        noise = casadi.SX.sym("w", 3, HORIZON)
        state, cost = start, 0
        target = casadi.DM(problem.target)
        for k in range(HORIZON):
            away = state - target
            cost += 0.5 * casadi.bilin(problem.q, away, away) + problem.r * turns[k] ** 2
            state = casadi.vertcat(*problem.step([state[i] for i in range(3)], turns[k], casadi))
            state = state + noise[:, k]
        away = state - target
        cost += casadi.bilin(problem.p, away, away)
        path = casadi.Function("path", [turns, start, casadi.vec(noise)], [cost])
        u = casadi.MX.sym("u", HORIZON)
        values = casadi.MX.sym("p", 3 * (HORIZON + 1), paths)
        costs = path.map(paths)(casadi.repmat(u, 1, paths), values[:3, :], values[3:, :])
        nlp = {"x": u, "f": casadi.sum2(costs) / paths, "p": casadi.vec(values)}
        options = {
            "print_time": False,
            "print_header": False,
            "print_iteration": False,
            "print_status": False,
            "qpsol": "qrqp",
            "qpsol_options": {"print_iter": False, "print_header": False, "print_info": False},
            "tol_du": 1e-4,
            "max_iter": 20,
        }
        solver = casadi.nlpsol(f"sqp{paths}", "sqpmethod", nlp, options)
        if compiled:
            source = f"sqp{paths}.c"
            here = os.getcwd()
            os.chdir(folder)
            solver.generate_dependencies(source)
            library = os.path.join(folder, f"sqp{paths}.so")
            subprocess.run(
                ["cc", "-O3", "-march=native", "-fPIC", "-shared", source, "-o", library, "-lm"], check=True
            )
            os.chdir(here)
            solver = casadi.nlpsol(f"sqp{paths}", "sqpmethod", library, options)
        self.solver = solver

    def plan(self, guess, start, noise):
        values = numpy.concatenate([start.T, *[n.T for n in noise]], axis=0)
        # Column-major: one path after another.
        parameters = values.ravel(order="F")
        begin = time.perf_counter()
        result = self.solver(
            x0=guess, p=parameters, lbx=self.problem.lower, ubx=self.problem.upper
        )
        elapsed = 1e3 * (time.perf_counter() - begin)
        turns = numpy.clip(result["x"].full().ravel(), self.problem.lower, self.problem.upper)
        return turns, elapsed


def draw(random, problem, mean, covariance, paths):
    start = random.multivariate_normal(mean, covariance, paths)
    return start, [random.multivariate_normal(numpy.zeros(3), problem.noise, paths) for _ in range(HORIZON)]


def beliefs(scenario, problem, periods):
    """Along the noise-free drive of the quantised planner."""
    planner = qsmpc.Planner(scenario, certify=False)
    mean = numpy.array(scenario.initial_mean)
    for _ in range(periods):
        yield mean.copy()
        plan = planner.decide(mean=mean, covariance=problem.noise)
        mean = numpy.array(problem.step(list(mean), float(plan.inputs[0, 0]), numpy))


def sweep_own(name, scenario, means, problem):
    planner = qsmpc.Planner(scenario, certify=False)
    plans, times = [], []
    for k, mean in enumerate(means):
        begin = time.perf_counter()
        plan = planner.decide(mean=mean, covariance=problem.noise, period=k)
        times.append(1e3 * (time.perf_counter() - begin))
        plans.append(numpy.array(plan.inputs)[:, 0])
    return name, plans, times


def sweep_casadi(paths, means, problem, folder, compiled=True, seed=1):
    sqp = CasadiSqp(problem, paths, folder, compiled)
    random = numpy.random.default_rng(seed)
    plans, times = [], []
    guess = numpy.zeros(HORIZON)
    for mean in means:
        turns, elapsed = sqp.plan(guess, *draw(random, problem, mean, problem.noise, paths))
        plans.append(turns)
        times.append(elapsed)
        guess = numpy.append(turns[1:], turns[-1])
    return f"CasADi SQP in C, {paths} paths", plans, times


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--periods", type=int, default=25)
    arguments = parser.parse_args()
    scenario = qsmpc.load(SCENARIO, SETTINGS)
    problem = Problem(scenario)
    means = list(beliefs(scenario, problem, arguments.periods))
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        _, best, _ = sweep_casadi(20_000, means, problem, folder, compiled=False, seed=7)
        for paths in (100, 1000):
            rows.append(sweep_casadi(paths, means, problem, folder))
            own = scenario.set({"controller.kind": "scenario", "controller.chance.paths": paths})
            rows.append(sweep_own(f"scenario, {paths} paths", own, means, problem))
    for points in (10, 30, 100, 500):
        own = scenario.set(
            {
                f"controller.quantisation.{name}": points for name in ("state", "noise", "compressed")
            }
        )
        rows.append(sweep_own(f"quantised, {points} points", own, means, problem))
    gaps = {name: [] for name, _, _ in rows}
    random = numpy.random.default_rng(99)
    for k, mean in enumerate(means):
        paths = draw(random, problem, mean, problem.noise, 200_000)
        least = problem.true_cost(best[k], *paths)
        for name, plans, _ in rows:
            gaps[name].append(problem.true_cost(plans[k], *paths) - least)
    print(f"{'':<28} {'ms, median':>11} {'gap, mean':>11} {'gap, max':>11}")
    for name, _, times in rows:
        # The first plan has no warm start.
        print(
            f"{name:<28} {numpy.median(times[1:]):>11.3f} {numpy.mean(gaps[name][1:]):>11.4f} "
            f"{max(gaps[name][1:]):>11.4f}"
        )


main()
