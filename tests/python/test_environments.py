"""The environments for the real Gymnasium."""

import warnings

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import qsmpc
import qsmpc.envs

IDS = qsmpc.envs.environment_ids()


@pytest.mark.parametrize("name", IDS)
def test_gymnasium_finds_nothing_wrong(name):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env = gymnasium.make(name, disable_env_checker=True, size=(160, 90)).unwrapped
        check_env(env)
        env.close()


def test_every_shipped_scenario_is_registered():
    assert len(IDS) == len(qsmpc.scenarios())


@pytest.fixture
def planar():
    return qsmpc.load("dubins_obstacles", {"plant.mjcf": "dubins_planar.xml"})


def test_a_seed_gives_the_drive_of_the_program(planar):
    env = qsmpc.envs.Environment(planar)
    seen, _ = env.reset(seed=4)
    seens, certified = [seen], []
    for _ in range(20):
        seen, _, terminated, truncated, info = env.step([0.25])
        seens.append(seen)
        certified.append(info["certified"])
        if terminated or truncated:
            break
    low, high = planar.input_bounds
    input = low + 0.625 * (high - low)
    episode = qsmpc.run(planar, seed=4, controller=lambda now: input)
    np.testing.assert_array_equal(np.array(seens), episode.states[: len(seens)])
    np.testing.assert_array_equal(certified, episode.certificates["value"][: len(certified), 0])


def test_an_end_in_the_unsafe_set_costs_what_is_left(planar):
    env = qsmpc.envs.Environment(planar)
    env.reset(seed=0)
    rewards = []
    terminated = truncated = False
    while not (terminated or truncated):
        _, reward, terminated, truncated, info = env.step([0.0])
        rewards.append(reward)
    assert info["outcome"] in ("collision", "left_bounds") and info["unsafe"]
    assert info["clearance"] <= 0.0
    assert rewards[-1] < 10 * min(rewards[:-1]) < 0.0
    assert env.episode().outcome == info["outcome"]


def test_actions_reach_the_bounds_and_not_beyond(planar):
    env = qsmpc.envs.Environment(planar)
    for action, bound in ((-1.0, 0), (1.0, 1), (5.0, 1)):
        env.reset(seed=1)
        env.step([action])
        np.testing.assert_array_equal(env.episode().inputs[0], planar.input_bounds[bound])


def test_pictures_show_the_drive(planar):
    env = qsmpc.envs.Environment(planar, render_mode="rgb_array", size=(320, 180))
    env.reset(seed=1)
    before = env.render()
    for _ in range(10):
        env.step([0.5])
    after = env.render()
    assert before.shape == after.shape == (180, 320, 3) and before.dtype == np.uint8
    assert np.abs(before.astype(int) - after.astype(int)).max() > 50


@pytest.mark.parametrize("threads", [1, 2])
def test_a_vector_environment_is_its_environments_one_by_one(planar, threads):
    short = planar.set({"limit.steps": 6})
    envs = gymnasium.make_vec(
        "qsmpc/dubins_obstacles-v0", num_envs=3, scenario=short, threads=threads
    )
    singles = [qsmpc.envs.Environment(short) for _ in range(3)]
    seens, infos = envs.reset(seed=7)
    for n, single in enumerate(singles):
        seen, info = single.reset(seed=7 + n)
        np.testing.assert_array_equal(seens[n], seen)
        assert infos["clearance"][n] == info["clearance"]
    generator = np.random.default_rng(0)
    for step in range(6):
        actions = generator.uniform(-1, 1, (3, 1))
        seens, rewards, terminated, truncated, infos = envs.step(actions)
        for n, single in enumerate(singles):
            seen, reward, ended, cut, info = single.step(actions[n])
            np.testing.assert_array_equal(seens[n], seen)
            assert rewards[n] == reward
            assert (terminated[n], truncated[n]) == (ended, cut)
            assert infos["certified"][n] == info["certified"]
    assert truncated.all()
    # The next step starts a new episode, without a reward.
    seens, rewards, terminated, truncated, infos = envs.step(actions)
    assert not rewards.any() and not truncated.any() and not terminated.any()
    assert np.abs(seens).max() < 1.0
    assert envs.observation_space.contains(seens)
    envs.close()


def test_without_certificates_none_are_told(planar):
    env = qsmpc.envs.Environment(planar, certify=False)
    env.reset(seed=1)
    assert np.isnan(env.step([0.0])[4]["certified"])
    with pytest.raises(ValueError):
        env.episode().save("nowhere")


def test_certificates_that_are_no_bounds_are_not_told():
    noisy = qsmpc.load("dubins_obstacles", {"disturbance.sensor": [0.01, 0.01, 0.001]})
    env = qsmpc.envs.Environment(noisy)
    env.reset(seed=1)
    assert np.isnan(env.step([0.0])[4]["certified"])


def test_a_step_before_a_reset_is_refused(planar):
    with pytest.raises(ValueError, match="reset"):
        qsmpc.envs.Environment(planar).step([0.0])
    with pytest.raises(ValueError, match="reset"):
        qsmpc.envs.VectorEnvironment(2, planar).step(np.zeros((2, 1)))
    with pytest.raises(ValueError, match="reset"):
        qsmpc.envs.Environment(planar, render_mode="rgb_array").render()
