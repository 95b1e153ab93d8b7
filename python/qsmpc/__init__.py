"""Stochastic model predictive control by quantisation, with a safety certificate, on MuJoCo plants.

    import qsmpc

    scenario = qsmpc.load("dubins_obstacles", {"controller.horizon": 10})
    episode = qsmpc.run(scenario, seed=1)
    print(episode.outcome, episode.clearances.min())

A custom controller is an object with ``act(situation)``, or a function:

    episode = qsmpc.run(scenario, controller=lambda now: [-0.5 * now.observation[2]])

Arrays have samples as rows: ``episode.states`` is (steps + 1) × n. Errors in a file or a value
raise `InputError` with a one-line message.
"""

from qsmpc._native.core import InputError, IoError, ObstaclePlace, Situation, __version__
from qsmpc.campaigns import Store, campaign, campaigns, open_campaign
from qsmpc.comparisons import Comparison, compare
from qsmpc.episodes import Episode, read, run
from qsmpc.exports import export_mcap, export_rerun
from qsmpc.planning import Certifier, Plan, Planner
from qsmpc.predictions import Prediction, predict
from qsmpc.scenarios import Model, Scenario, Shape, controllers, load, parse, scenarios, systems
from qsmpc.serving import serve

__all__ = [
    "Certifier",
    "Comparison",
    "Episode",
    "InputError",
    "IoError",
    "Model",
    "ObstaclePlace",
    "Plan",
    "Planner",
    "Prediction",
    "Scenario",
    "Shape",
    "Situation",
    "Store",
    "__version__",
    "campaign",
    "campaigns",
    "compare",
    "controllers",
    "export_mcap",
    "export_rerun",
    "load",
    "open_campaign",
    "parse",
    "predict",
    "read",
    "run",
    "scenarios",
    "serve",
    "systems",
]
