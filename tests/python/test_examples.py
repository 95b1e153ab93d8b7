"""The examples in Python, as their pages say."""

import pathlib
import sys

import numpy as np

import qsmpc

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples"


def test_a_trained_policy_arrives_and_an_untrained_one_does_not():
    sys.path.insert(0, str(EXAMPLES / "policy_training"))
    import train

    scenario = qsmpc.load("double_integrator")
    weights, history = train.train(scenario, rounds=15)
    assert history[-1] > history[0]
    trained = qsmpc.run(scenario, seed=1, controller=train.LinearPolicy(scenario, weights))
    untrained = qsmpc.run(
        scenario, seed=1, controller=train.LinearPolicy(scenario, np.zeros_like(weights))
    )
    assert trained.outcome == "reached"
    assert untrained.outcome != "reached"
    assert np.isfinite(trained.certificates["value"]).all()
