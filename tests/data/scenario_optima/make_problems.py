"""Writes problems.json: 20 sampled problems with the optima that CasADi's IPOPT finds.

    pip install casadi==3.6.7 numpy==1.26.4
    python3 make_problems.py

Every path must keep the body, a disc, clear of a block and inside the walls at every stage. IPOPT
starts from several constant inputs, and the best of what it comes to is kept.
"""
import json

import casadi
import numpy

TIME_STEP = 0.1
SPEED = 1.5
STARTS = (-1.0, 0.0, 1.0)


def dubins(state, turn):
    return casadi.vertcat(
        state[0] + TIME_STEP * SPEED * casadi.cos(state[2]),
        state[1] + TIME_STEP * SPEED * casadi.sin(state[2]),
        state[2] + TIME_STEP * turn,
    )


def distance(x, y, block):
    """Of a point to a block from outside of it."""
    dx = casadi.fmax(0.0, casadi.fmax(block[0] - x, x - block[2]))
    dy = casadi.fmax(0.0, casadi.fmax(block[1] - y, y - block[3]))
    return dx, dy


def optimum(problem):
    start = numpy.array(problem["start"])
    noise = numpy.array(problem["noise"])
    horizon, paths = len(noise), start.shape[1]
    target = numpy.array(problem["target"])
    q = numpy.diag(problem["cost_state"])
    p = numpy.diag(problem["cost_terminal"])
    r = problem["cost_input"]
    radius = problem["radius"]
    opti = casadi.Opti()
    turns = opti.variable(horizon)
    opti.subject_to(opti.bounded(-problem["most_turn"], turns, problem["most_turn"]))
    cost = 0
    for i in range(paths):
        state = casadi.DM(start[:, i])
        for k in range(horizon):
            away = state - target
            cost += 0.5 * casadi.bilin(q, away, away) + r * turns[k] ** 2
            state = dubins(state, turns[k]) + casadi.DM(noise[k][:, i])
            dx, dy = distance(state[0], state[1], problem["block"])
            opti.subject_to(dx * dx + dy * dy >= radius * radius)
            opti.subject_to(state[1] + radius <= problem["wall"])
        away = state - target
        cost += casadi.bilin(p, away, away)
    cost /= paths
    opti.minimize(cost)
    opti.solver("ipopt", {"print_time": False}, {"print_level": 0, "tol": 1e-10, "max_iter": 3000})
    best = None
    for share in STARTS:
        opti.set_initial(turns, share * problem["most_turn"])
        try:
            value = float(opti.solve().value(cost))
        except RuntimeError:
            continue
        if best is None or value < best[0]:
            best = (value, [float(turn) for turn in opti.value(turns)])
    return best


def make(index):
    random = numpy.random.default_rng(1000 + index)
    horizon = int(random.integers(5, 9))
    paths = 15
    side = 1.0 if index % 2 else -1.0
    lower_x = random.uniform(0.55, 0.75)
    width = random.uniform(0.1, 0.4)
    # The block extends from far on one side to slightly beyond the middle of the path.
    beyond = random.uniform(0.0, 0.05)
    ys = sorted((-side * beyond, side * random.uniform(1.5, 2.0)))
    heading = 0.5 * side * random.uniform(-0.5, 0.3)
    rounded = lambda values: numpy.round(values, 5).tolist()
    return {
        "start": rounded(
            numpy.array([[0.0], [0.0], [heading]]) + 0.01 * random.standard_normal((3, paths))
        ),
        "mean": [0.0, 0.0, round(heading, 5)],
        "noise": rounded(0.01 * random.standard_normal((horizon, 3, paths))),
        "target": rounded([random.uniform(2.0, 3.0), side * random.uniform(0.0, 0.4), 0.0]),
        "cost_state": [4.0, 4.0, 0.0],
        "cost_terminal": [4.0, 4.0, 0.1],
        "cost_input": 0.05,
        "most_turn": 3.0,
        "radius": 0.1,
        "block": rounded([lower_x, ys[0], lower_x + width, ys[1]]),
        "wall": 2.5,
        "time_step": TIME_STEP,
        "speed": SPEED,
    }


def main():
    problems = []
    index = 0
    while len(problems) < 20:
        problem = make(index)
        index += 1
        best = optimum(problem)
        if best is None:  # not every path can avoid the block
            continue
        problem["cost"], problem["turns"] = best
        problems.append(problem)
    with open("problems.json", "w", encoding="ascii") as file:
        file.write("[\n" + ",\n".join(json.dumps(problem) for problem in problems) + "\n]\n")


main()
