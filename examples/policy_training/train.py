"""Trains a linear policy on an environment of qsmpc by the cross-entropy method, and drives it.

    python3 train.py [--scenario NAME] [--rounds N] [--out FOLDER]
"""

import argparse

import gymnasium
import numpy as np

import qsmpc
import qsmpc.envs  # registers the environments

POPULATION = 32
BEST = 6
SPREAD = 1.0  # of the first round's weights
DRIVES = 6  # per evaluation of a candidate


class LinearPolicy:
    """action = tanh(W (observation − target) / scale)"""

    def __init__(self, scenario, weights):
        self.scenario = scenario
        self.weights = weights
        self.low, self.high = scenario.input_bounds
        self.scale = np.maximum(np.abs(scenario.initial_mean - scenario.target), 1.0)

    def action(self, observations):
        """For one observation (n), or a row each."""
        away = (observations - self.scenario.target) / self.scale
        return np.tanh(np.einsum("...ij,...j->...i", self.weights, away))

    def act(self, situation):
        """As a controller of qsmpc."""
        share = 0.5 * (self.action(situation.observation) + 1.0)
        return np.clip(self.low + share * (self.high - self.low), self.low, self.high)


def returns(envs, scenario, weights, seed):
    """The sum of rewards of each row of `weights` in a drive; all have the same noise."""
    observations, _ = envs.reset(seed=[seed] * len(weights))
    policy = LinearPolicy(scenario, weights)
    total = np.zeros(len(weights))
    running = np.ones(len(weights), bool)
    while running.any():
        observations, rewards, terminated, truncated, _ = envs.step(policy.action(observations))
        total += np.where(running, rewards, 0.0)
        running &= ~(terminated | truncated)
    return total


def train(scenario, rounds, seed=0):
    """The policy's weights, m × n, and the mean return of the best in each round."""
    envs = gymnasium.make_vec(
        f"qsmpc/{scenario.name}-v0", num_envs=POPULATION, scenario=scenario, certify=False
    )
    generator = np.random.default_rng(seed)
    shape = (scenario.input_bounds[0].size, scenario.initial_mean.size)
    mean, deviation = np.zeros(shape), np.full(shape, SPREAD)
    history = []
    for _ in range(rounds):
        weights = mean + deviation * generator.standard_normal((POPULATION, *shape))
        result = np.mean([returns(envs, scenario, weights, 1000 + n) for n in range(DRIVES)], axis=0)
        best = weights[np.argsort(result)[-BEST:]]
        mean, deviation = best.mean(axis=0), best.std(axis=0) + 0.02
        history.append(float(np.sort(result)[-BEST:].mean()))
    envs.close()
    return mean, history


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scenario", default="double_integrator")
    parser.add_argument("--rounds", type=int, default=20)
    parser.add_argument("--out", default="")
    arguments = parser.parse_args()
    scenario = qsmpc.load(arguments.scenario)
    weights, history = train(scenario, arguments.rounds)
    print("mean return of the best, round by round:", *(f"{value:.2f}" for value in history))
    episode = qsmpc.run(scenario, seed=1, controller=LinearPolicy(scenario, weights))
    print(f"{episode.outcome} after {episode.duration:.1f} s,", end=" ")
    print(f"certified next step at most {episode.certificates['value'].max():.3g}")
    if arguments.out:
        episode.save(arguments.out)


if __name__ == "__main__":
    main()
