"""Scenarios that are small enough to be driven many times."""

import pytest

import qsmpc

SMALL = {
    "controller.horizon": 5,
    "controller.quantisation": "{state: 20, noise: 20, compressed: 20}",
    "limit.steps": 12,
    "plant.kind": "analytic",
}


@pytest.fixture(scope="session")
def small():
    return qsmpc.load("dubins_obstacles", SMALL)
