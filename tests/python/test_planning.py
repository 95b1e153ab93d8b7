"""Plans, predictions, certificates, comparisons and campaigns from Python."""

import json

import numpy as np
import pytest

import qsmpc


def test_a_plan_is_certified_as_the_same_plan_of_anybody(small):
    plan = qsmpc.Planner(small).decide(mean=[0, 0, 0], covariance=[0.01, 0.01, 0.001])
    assert plan.inputs.shape == (5, 1) and plan.status
    again = qsmpc.Certifier(small).plan(
        plan.inputs, plan.gains, mean=[0, 0, 0], covariance=[0.01, 0.01, 0.001]
    )
    np.testing.assert_array_equal(plan.states, again.states)
    # Both are upper bounds; particles may differ.
    np.testing.assert_allclose(
        plan.certificates["value"], again.certificates["value"], rtol=1e-6, atol=1e-12
    )


def test_certificates_tell_a_safe_input_from_one_into_a_wall(small):
    certifier = qsmpc.Certifier(small)
    known = {"covariance": np.zeros((3, 3))}
    assert certifier.input([0.0], mean=[5, 5, 0], **known).certificates["value"][0] < 1e-6
    assert certifier.input([0.0], mean=[11.9, 5, 0], **known).certificates["value"][0] > 0.9


def test_wrong_plans_and_beliefs_are_refused(small):
    certifier = qsmpc.Certifier(small)
    with pytest.raises(ValueError, match="out of its bounds"):
        certifier.plan([[100.0]])
    with pytest.raises(ValueError, match="2 inputs"):
        certifier.plan([[0.0, 0.0]])
    with pytest.raises(ValueError):
        qsmpc.Planner(small).decide(covariance=-np.eye(3))
    with pytest.raises(ValueError):
        qsmpc.Planner(small).decide(mean=[0, 0])


def test_a_prediction_has_certificates_above_what_is_simulated(small, tmp_path):
    prediction = qsmpc.predict(small, monte_carlo=20_000)
    for stage in prediction.numbers["stages"]:
        assert stage["certificate"]["value"] >= stage["monte_carlo"]["lower"]
    assert prediction.particles(1)[0].shape == (20, 3)
    given = qsmpc.predict(small, np.full((3, 1), 0.1))
    assert given.inputs.tolist() == [[0.1]] * 3
    prediction.save(tmp_path)
    assert json.loads((tmp_path / "predict.json").read_text()) == prediction.numbers


def test_a_comparison_finds_the_model_itself_without_error(small, tmp_path):
    comparison = qsmpc.compare(small, ["analytic", "mujoco_planar"], episodes=2, paths=20)
    assert comparison.plants == ["analytic", "mujoco_planar"]
    assert abs(comparison.residuals("analytic")).max() < 1e-12
    assert abs(comparison.residuals("mujoco_planar")).max() > 1e-9
    comparison.save(tmp_path)
    assert (tmp_path / "report.html").stat().st_size > 1000
    with pytest.raises(KeyError):
        comparison.residuals("nothing")


def test_a_campaign_is_driven_and_its_store_is_arrays(small, tmp_path):
    (tmp_path / "small.yaml").write_text(small.to_yaml())
    campaign = tmp_path / "campaign.yaml"
    campaign.write_text(
        "name: two\nscenario: small.yaml\nseeds: {first: 0, count: 4}\ntraces: all\n"
        "variants: {five: {}, three: {controller.horizon: 3}}\n"
    )
    told = []
    store = qsmpc.campaign(
        campaign, tmp_path / "out", jobs=1, on_progress=lambda done, total: told.append((done, total))
    )
    assert told[-1] == (8, 8)
    episodes = store.episodes()
    assert {len(column) for column in episodes.values()} == {8}
    assert sorted(set(episodes["variant"].tolist())) == [0, 1]
    periods = store.periods(0)
    steps = episodes["steps"][episodes["variant"] == 0].sum()
    assert len(periods["certified"]) == steps
    name = store.variants[1]["name"]
    assert store.scenario(name).horizon == 3
    driven = store.episode(name, 2)
    alone = qsmpc.run(store.scenario(name), seed=2)
    np.testing.assert_array_equal(driven.states, alone.states)
    assert store.statistics()["done"] == 8
    store.verify()
    again = qsmpc.open_campaign(tmp_path / "out")
    assert again.status()["done"] == 8
    with pytest.raises(qsmpc.InputError):
        qsmpc.open_campaign(tmp_path)


def test_what_needs_more_memory_than_there_is_is_refused(small):
    huge = small.set({"controller.horizon": 1000, "controller.quantisation.compressed": 100_000,
                      "controller.quantisation.state": 100_000, "controller.quantisation.noise": 100_000})
    for ask in (qsmpc.run, qsmpc.predict, qsmpc.Planner):
        with pytest.raises(qsmpc.InputError, match="memory|GB|GiB"):
            ask(huge)


def test_wrong_numbers_are_refused(small):
    with pytest.raises(ValueError):
        small.cost([1.0], [1.0])
    with pytest.raises(ValueError):
        qsmpc.predict(small, monte_carlo=-1)


def test_a_plan_says_where_its_certificates_are_no_bounds(small):
    assert "<=" in repr(qsmpc.Planner(small).decide())
    noisy = small.set(
        {"disturbance.sensor": [0.01, 0.01, 0.001], "estimator.kind": "last_measurement"}
    )
    assert "no bound" in repr(qsmpc.Planner(noisy).decide())
