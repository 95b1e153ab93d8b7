"""Environments for Gymnasium: ``qsmpc/NAME-v0`` for every shipped scenario.

    import gymnasium
    import qsmpc.envs

    env = gymnasium.make("qsmpc/dubins_obstacles-v0")
    envs = gymnasium.make_vec("qsmpc/dubins_obstacles-v0", num_envs=64, threads=2)

Needs the package gymnasium (``pip install qsmpc[gymnasium]``).
"""

from gymnasium.envs.registration import register, registry

from qsmpc.envs.environment import Environment
from qsmpc.envs.vector import VectorEnvironment
from qsmpc.scenarios import scenarios

__all__ = ["Environment", "VectorEnvironment", "environment_ids"]


def environment_ids() -> list[str]:
    """The names under which the shipped scenarios are registered."""
    return [f"qsmpc/{name}-v0" for name in scenarios()]


for _name in scenarios():
    _id = f"qsmpc/{_name}-v0"
    if _id not in registry:
        register(
            id=_id,
            entry_point="qsmpc.envs.environment:Environment",
            vector_entry_point="qsmpc.envs.vector:VectorEnvironment",
            kwargs={"scenario": _name},
        )
