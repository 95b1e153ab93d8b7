"""Robust multi-stage MPC with do-mpc, as an external controller of qsmpc.

A tree of scenarios: after the first period the noise has taken one of a few values, which it keeps,
and each branch has inputs of its own from then on. Bounds and obstacles are nonlinear constraints on
every node, each with a slack that is penalised.

Options, each with a default: deviations, how many standard deviations out the values of the noise
are; weight, of a metre that a node is unsafe by (an exact penalty); feedback_effort, of inputs in the
regulator that answers to what is observed, relative to the cost's.
"""

import math
import pathlib
import sys

import casadi
import numpy

# Both examples share the scenario in CasADi expressions.
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "casadi_scenario_mpc"))

import do_mpc  # noqa: E402
from problem import serve  # noqa: E402

WEIGHT = 2e4


class MultiStageMpc:
    def __init__(self, problem):
        self.problem = problem
        n = problem.state_dim
        # Held over the horizon, they add up to three deviations of the accumulated noise at its
        # end.
        deviations = problem.options.get("deviations", 3.0 / math.sqrt(problem.horizon))
        values, vectors = numpy.linalg.eigh(problem.noise)
        root = deviations * vectors * numpy.sqrt(numpy.maximum(values, 0.0))
        axes = [axis for axis in root.T if axis.any()]
        # The first branch has no noise: the answered plan is the plan of this branch.
        self.noises = [numpy.zeros(n), *axes, *(-axis for axis in axes)]
        self.mpc = self.build(problem.options.get("weight", WEIGHT))
        self.later = self.later_places()
        self.inputs = None

    def reset(self, seed):
        """Nothing is drawn."""
        self.inputs = None

    def build(self, weight):
        problem = self.problem
        n, m = problem.state_dim, problem.input_dim
        model = do_mpc.model.Model("discrete", "SX")
        state, control = (
            model.set_variable("_x", "x", (n, 1)),
            model.set_variable("_u", "u", (m, 1)),
        )
        noise = model.set_variable("_p", "w", (n, 1))
        model.set_variable("_tvp", "target", (n, 1))
        model.set_rhs("x", problem.step(state, control) + noise)
        model.setup()
        # After setup the model has new symbols.
        state, control, noise = model.x["x"], model.u["u"], model.p["w"]
        target = model.tvp["target"]
        following = problem.step(state, control) + noise
        mpc = do_mpc.controller.MPC(model)
        mpc.settings.n_horizon = problem.horizon
        mpc.settings.n_robust = 1
        mpc.settings.t_step = problem.message["time_step"]
        mpc.settings.store_full_solution = False
        mpc.settings.nlpsol_opts = self.solver_options()
        mpc.set_objective(
            lterm=problem.stage_cost(state, control, target),
            mterm=problem.terminal_cost(state, target),
        )
        mpc.set_rterm(u=numpy.zeros(m))  # no further cost than the scenario's
        mpc.bounds["lower", "_u", "u"], mpc.bounds["upper", "_u", "u"] = (
            problem.lower,
            problem.upper,
        )
        if problem.clearance.numel_out(0):
            # At the step's end point: do-mpc applies constraints at the nodes from which steps
            # start.
            unsafe_by = -problem.clearance(following)
            mpc.set_nl_cons(
                "unsafe_by", unsafe_by, ub=0.0, soft_constraint=True, penalty_term_cons=weight
            )
        noises = mpc.get_p_template(len(self.noises))
        for branch, value in enumerate(self.noises):
            noises["_p", branch] = value
        mpc.set_p_fun(lambda now: noises)
        self.targets = mpc.get_tvp_template()
        mpc.set_tvp_fun(lambda now: self.targets)
        mpc.setup()
        mpc.set_initial_guess()  # any guess, as do-mpc requires one; `guess` sets the actual one
        return mpc

    def solver_options(self):
        # In the first period there are as many solves as guesses, within the deadline.
        share = 0.8 / (1 + 2 * self.problem.input_dim)
        return {
            "print_time": False,
            "ipopt.print_level": 0,
            "ipopt.sb": "yes",
            "ipopt.max_iter": 200,
            "ipopt.tol": 1e-4,
            "ipopt.acceptable_tol": 1e-3,
            "ipopt.acceptable_iter": 4,
            "ipopt.mu_strategy": "adaptive",
            "ipopt.max_wall_time": share * self.problem.message["deadline"],
            "ipopt.warm_start_init_point": "yes",
            "ipopt.warm_start_bound_push": 1e-6,
            "ipopt.warm_start_mult_bound_push": 1e-6,
        }

    def branches(self):
        return range(len(self.noises))

    def later_places(self):
        """Where in the solver's variables each of them stands a stage later, in its branch."""
        places = self.mpc.opt_x
        later = numpy.arange(places.size)
        for name, last in (
            ("_x", self.problem.horizon),
            ("_u", self.problem.horizon - 1),
            ("_eps", self.problem.horizon - 1),
        ):
            for k in range(last):
                for branch in self.branches():
                    at = [name, k, branch, -1] if name == "_x" else [name, k, branch]
                    after = [name, k + 1, *at[2:]]
                    later[places.f[tuple(at)]] = places.f[tuple(after)]
        return later

    def guess(self, mean, inputs):
        """Starts the solver from inputs that all branches share."""
        variables = self.mpc.opt_x_num
        for branch, noise in zip(self.branches(), self.noises):
            state = numpy.array(mean)
            variables["_x", 0, branch, -1] = state
            for k, control in enumerate(inputs):
                variables["_u", k, branch] = control
                state = self.problem.step(state, control).full().ravel() + noise
                variables["_x", k + 1, branch, -1] = state
        self.mpc.flags["initial_run"] = False  # no multipliers to start from

    def solve(self, mean):
        """The value found; what was found is kept in `mpc`."""
        self.mpc.make_step(numpy.array(mean).reshape(-1, 1))
        return self.mpc.solver_stats["iterations"]["obj"][-1]

    def found(self):
        mpc = self.mpc
        return casadi.DM(mpc.opt_x_num.master), mpc.lam_x_num, mpc.lam_g_num, mpc.solver_stats

    def keep(self, found):
        mpc = self.mpc
        mpc.opt_x_num.master, mpc.lam_x_num, mpc.lam_g_num, mpc.solver_stats = found

    def solve_anew(self, mean):
        """From no input, and from each input held on either side: ways round on either side."""
        problem = self.problem
        guesses = [numpy.zeros((problem.horizon, problem.input_dim))]
        for bound in (problem.lower, problem.upper):
            for i in range(problem.input_dim):
                guesses.append(guesses[0].copy())
                guesses[-1][:, i] = 0.5 * bound[i]
        tried = []
        for inputs in guesses:
            self.guess(mean, numpy.clip(inputs, problem.lower, problem.upper))
            tried.append((self.solve(mean), self.found()))
        self.keep(min(tried, key=lambda one: one[0])[1])
        return sum(found[3]["iter_count"] for _, found in tried)

    def plan(self, situation):
        problem = self.problem
        mean = situation["belief"]["mean"]
        self.targets["_tvp", :] = problem.target_near(mean)
        if self.inputs is None:
            evaluations = self.solve_anew(mean)
        else:
            # The previous tree, shifted by one stage, with its multipliers.
            variables = self.mpc.opt_x_num
            variables.master = variables.master[self.later]
            self.solve(mean)
            evaluations = self.mpc.solver_stats["iter_count"]
        stages = range(problem.horizon)
        inputs = numpy.array([self.mpc.opt_x_num["_u", k, 0].full().ravel() for k in stages])
        if not numpy.isfinite(inputs).all():
            raise RuntimeError(f"IPOPT: {self.mpc.solver_stats['return_status']}, with no inputs")
        # The solver's solution may exceed the bounds slightly.
        self.inputs = numpy.clip(inputs, problem.lower, problem.upper)
        gains = problem.gains(problem.roll_out(mean, self.inputs), self.inputs)
        return {
            "inputs": self.inputs.tolist(),
            "gains": [gain.tolist() for gain in gains],
            "status": problem.status(self.mpc.solver_stats),
            "evaluations": evaluations,
        }


if __name__ == "__main__":
    serve(MultiStageMpc)
