"""Scenario MPC with CasADi and IPOPT, as an external controller of qsmpc.

Every period, one sequence of inputs is sought that is cheapest on average over sampled starts and noise,
and that keeps every sample clear of bounds and obstacles. A linear-quadratic regulator along the plan of
the period before counteracts the noise in each sample, as it will in the drive.

Options, each with a default: scenarios, how many samples; weight, of a metre that a sample is unsafe by
(an exact penalty); feedback_effort, of inputs in the regulator, relative to the cost's.
"""

import math
from statistics import NormalDist

import casadi
import numpy
from problem import serve

SCENARIOS = 40
WEIGHT = 2e4


class ScenarioMpc:
    def __init__(self, problem):
        self.problem = problem
        options = problem.options
        self.samples = 2 * math.ceil(options.get("scenarios", SCENARIOS) / 2)  # in pairs
        self.spread = self.spread_of(problem.risk_per_stage())
        self.noise_root = self.root(problem.noise)
        self.solver = self.build(options.get("weight", WEIGHT))
        self.reset(problem.message["seed"])

    def spread_of(self, risk):
        """By how much samples are drawn wider than the noise is: so that the outermost of them is
        where a normal distribution leaves the ``risk`` of a stage beyond."""
        if risk is None:
            return 1.0
        outermost = NormalDist().inv_cdf(self.samples / (self.samples + 1.0))
        return max(1.0, NormalDist().inv_cdf(1.0 - risk) / outermost)

    @staticmethod
    def root(covariance):
        values, vectors = numpy.linalg.eigh(covariance)
        return vectors * numpy.sqrt(numpy.maximum(values, 0.0))

    def reset(self, seed):
        """The same standard normal numbers for all periods of a drive: plans change with the
        situation, not with the draw, and multipliers of one period start the next one's solver."""
        problem = self.problem
        shape = (self.samples // 2, problem.horizon + 1, problem.state_dim)
        half = numpy.random.default_rng(seed).standard_normal(shape)
        self.normal = self.spread * numpy.concatenate([half, -half])  # zero mean
        self.inputs = numpy.zeros((problem.horizon, problem.input_dim))
        self.multipliers = None

    def build(self, weight):
        """IPOPT for the inputs and one slack for each stage; parameters: target, gains, mean, and
        start and noise of each sample, a column each."""
        problem = self.problem
        n, m, stages = problem.state_dim, problem.input_dim, problem.horizon
        target, mean = casadi.MX.sym("target", n), casadi.MX.sym("mean", n)
        gains = casadi.MX.sym("gains", m, n * stages)
        draws = casadi.MX.sym("draws", n * (stages + 1), self.samples)
        inputs, slack = casadi.MX.sym("u", m, stages), casadi.MX.sym("slack", stages)
        sample = self.sample_function()
        copies = [
            casadi.repmat(part, 1, self.samples)
            for part in (casadi.vec(inputs), casadi.vec(gains), target, mean)
        ]
        costs, clearances = sample.map(self.samples)(*copies, draws)
        count = problem.clearance.numel_out(0)
        slacks = casadi.repmat(casadi.vec(casadi.repmat(slack.T, count, 1)), 1, self.samples)
        nlp = {
            "x": casadi.vertcat(casadi.vec(inputs), slack),
            "f": casadi.sum2(costs) / self.samples + weight * casadi.sum1(slack),
            "g": casadi.vec(clearances + slacks),
            "p": casadi.vertcat(target, mean, casadi.vec(gains), casadi.vec(draws)),
        }
        # In the first period there are as many solves as guesses, within the deadline.
        share = 0.8 / (1 + 2 * m)
        ipopt = {
            "print_level": 0,
            "sb": "yes",
            "max_iter": 100,
            "tol": 1e-4,
            "acceptable_tol": 1e-3,
            "acceptable_iter": 4,
            "mu_strategy": "adaptive",
            "max_wall_time": share * problem.message["deadline"],
            "warm_start_init_point": "yes",
            "warm_start_bound_push": 1e-6,
            "warm_start_mult_bound_push": 1e-6,
        }
        return casadi.nlpsol("mpc", "ipopt", nlp, {"print_time": False, "ipopt": ipopt})

    def sample_function(self):
        """Cost and clearances of one sample under inputs that its own distance from the noise-free
        path is fed back to."""
        problem = self.problem
        n, m, stages = problem.state_dim, problem.input_dim, problem.horizon
        inputs, gains = casadi.SX.sym("u", m * stages), casadi.SX.sym("gains", m * n * stages)
        target, mean = casadi.SX.sym("target", n), casadi.SX.sym("mean", n)
        draws = casadi.SX.sym("draws", n * (stages + 1))
        path, state = mean, mean + draws[:n]
        cost, clearances = 0, []
        for k in range(stages):
            nominal = inputs[m * k : m * (k + 1)]
            gain = casadi.reshape(gains[m * n * k : m * n * (k + 1)], m, n)
            control = nominal + gain @ (state - path)
            cost += problem.stage_cost(state, control, target)
            path = problem.step(path, nominal)
            state = problem.step(state, control) + draws[n * (k + 1) : n * (k + 2)]
            clearances.append(problem.clearance(state))
        cost += problem.terminal_cost(state, target)
        return casadi.Function(
            "sample", [inputs, gains, target, mean, draws], [cost, casadi.vertcat(*clearances)]
        )

    def guesses(self):
        """The plan before, shifted; in the first period others, too: ways round on either side."""
        problem = self.problem
        guesses = [numpy.vstack([self.inputs[1:], self.inputs[-1:]])]
        if self.multipliers is None:
            for bound in (problem.lower, problem.upper):
                for i in range(problem.input_dim):
                    guess = numpy.zeros_like(self.inputs)
                    guess[:, i] = 0.5 * bound[i]
                    guesses.append(guess)
        return [numpy.clip(guess, problem.lower, problem.upper) for guess in guesses]

    def solve(self, guess, parameters):
        problem = self.problem
        stages = problem.horizon
        arguments = {
            "x0": numpy.concatenate([guess.ravel(), numpy.zeros(stages)]),
            "p": parameters,
            "lbx": numpy.concatenate([numpy.tile(problem.lower, stages), numpy.zeros(stages)]),
            "ubx": numpy.concatenate(
                [numpy.tile(problem.upper, stages), numpy.full(stages, numpy.inf)]
            ),
            "lbg": 0.0,
            "ubg": numpy.inf,
        }
        if self.multipliers is not None:
            arguments["lam_x0"], arguments["lam_g0"] = self.multipliers
        return self.solver(**arguments), self.solver.stats()

    def plan(self, situation):
        problem = self.problem
        mean = numpy.array(situation["belief"]["mean"])
        guesses = self.guesses()
        gains = problem.gains(problem.roll_out(mean, guesses[0]), guesses[0])
        draws = self.normal @ self.noise_root.T
        draws[:, 0] = self.normal[:, 0] @ self.root(situation["belief"]["covariance"]).T
        parameters = numpy.concatenate(
            [
                problem.target_near(mean),
                mean,
                # CasADi's matrices are column-major.
                numpy.concatenate([gain.ravel("F") for gain in gains]),
                draws.reshape(self.samples, -1).ravel(),
            ]
        )
        found = [self.solve(guess, parameters) for guess in guesses]
        result, stats = min(found, key=lambda one: float(one[0]["f"]))
        count = problem.horizon * problem.input_dim
        inputs = result["x"].full().ravel()[:count].reshape(problem.horizon, problem.input_dim)
        if not numpy.isfinite(inputs).all():
            inputs, self.multipliers = guesses[0], None
        else:
            self.multipliers = result["lam_x"], result["lam_g"]
        # The solver's solution may exceed the bounds slightly.
        self.inputs = numpy.clip(inputs, problem.lower, problem.upper)
        return {
            "inputs": self.inputs.tolist(),
            "gains": [gain.tolist() for gain in gains],
            "status": problem.status(stats),
            "evaluations": sum(stats["iter_count"] for _, stats in found),
        }


if __name__ == "__main__":
    serve(ScenarioMpc)
