"""Episodes as files of other viewers, read again with the packages that these come from."""

import base64
import json
import sys

import jsonschema
import numpy as np
import pytest
from mcap.reader import make_reader
from rerun.chunk import RrdReader

import qsmpc


@pytest.fixture(scope="module")
def episode(small):
    """A drive with a body, a budget of risk, and noise that it sees."""
    return qsmpc.run(
        small.set(
            {
                "vehicle.footprint": "[{radius: 0.2}, {radius: 0.2, offset: [0.25, 0]}]",
                "risk.mission": 0.5,
            }
        ),
        seed=3,
    )


def read_rrd(path):
    """Times (ns) and the rows of each column that changes, by entity and column."""
    reader = RrdReader(path)
    assert len(reader.recordings()) == 1 and len(reader.blueprints()) == 1
    found = {}
    for chunk in reader.stream(store=reader.recordings()[0]).to_chunks():
        batch = chunk.to_record_batch()
        times = None if chunk.is_static else batch.column("time").cast("int64").to_numpy()
        for name in batch.schema.names:
            if ":" in name or name == "weight":
                found[f"{chunk.entity_path} {name}"] = times, batch.column(name).to_pylist()
    return found


def read_mcap(path):
    """Messages of each topic with their times (ns), checked against their schemas."""
    found = {}
    with open(path, "rb") as file:
        for schema, channel, message in make_reader(file).iter_messages():
            content = json.loads(message.data)
            jsonschema.validate(content, json.loads(schema.data))
            assert (
                schema.name.startswith("foxglove.") or schema.name == f"qsmpc.{channel.topic[1:]}"
            )
            found.setdefault(channel.topic, []).append((message.log_time, content))
    return found


@pytest.fixture(scope="module")
def rrd(episode, tmp_path_factory):
    path = tmp_path_factory.mktemp("rerun") / "episode.rrd"
    qsmpc.export_rerun(episode, path)
    assert [file.name for file in path.parent.iterdir()] == ["episode.rrd"]
    return read_rrd(path)


@pytest.fixture(scope="module")
def mcap(episode, tmp_path_factory):
    path = tmp_path_factory.mktemp("mcap") / "episode.mcap"
    qsmpc.export_mcap(episode, path)
    assert [file.name for file in path.parent.iterdir()] == ["episode.mcap"]
    return read_mcap(path)


def series_of(episode):
    """What is plotted, by group and name."""
    certified = episode.certificates["value"]
    names = ("x", "y", "heading")
    rows = {"state": episode.states, "observation": episode.observations}
    rows["belief"] = episode.belief_means
    expected = {
        f"{group}/{name}": values
        for group, all in rows.items()
        for name, values in zip(names, all.T)
    }
    expected["input/yaw_rate"] = episode.inputs[:, 0]
    expected["clearance/clearance"] = episode.clearances
    expected["certificate/next_step"] = certified[:, 0]
    expected["certificate/horizon"] = np.minimum(certified.sum(axis=1), 1.0)
    expected["risk/spent"] = np.cumsum(certified[:, 0])
    expected["risk/limit"] = np.full(episode.steps, 0.5)
    return expected


def nanoseconds(episode, count):
    return np.rint(episode.times[:count] * 1e9).astype(int)


def test_rerun_has_every_number_of_the_trace_at_its_time(episode, rrd):
    for path, values in series_of(episode).items():
        times, rows = rrd[f"/{path} Scalars:scalars"]
        np.testing.assert_array_equal(times, nanoseconds(episode, len(values)), err_msg=path)
        np.testing.assert_array_equal(np.ravel(rows), values, err_msg=path)
    assert rrd["/risk/spent Scalars:scalars"][1][-1][0] == pytest.approx(
        episode.summary["mission"]["spent"]
    )


def test_mcap_has_every_number_of_the_trace_at_its_time(episode, mcap):
    for path, values in series_of(episode).items():
        group, name = path.split("/")
        messages = [(at, content) for at, content in mcap[f"/{group}"] if name in content]
        np.testing.assert_array_equal([at for at, _ in messages], nanoseconds(episode, len(values)))
        np.testing.assert_array_equal([content[name] for _, content in messages], values)
    for at, content in mcap["/state"]:
        assert content["timestamp"]["sec"] * 10**9 + content["timestamp"]["nsec"] == at


def test_rerun_draws_the_trace(episode, rrd):
    """Drawn points have 32 bits."""
    near = {"rtol": 1e-6, "atol": 1e-6}

    def points(path, name="Points3D:positions"):
        return np.array([row[0] for row in rrd[f"/world/{path} {name}"][1]])

    places = points("vehicle", "Transform3D:translation")
    np.testing.assert_allclose(places[:, :2], episode.states[:, :2], **near)
    turns = points("vehicle", "Transform3D:quaternion")
    np.testing.assert_allclose(
        2.0 * np.arctan2(turns[:, 2], turns[:, 3]), episode.states[:, 2], **near
    )
    np.testing.assert_allclose(points("observation")[:, :2], episode.observations[:, :2], **near)
    np.testing.assert_allclose(points("belief/mean")[:, :2], episode.belief_means[:, :2], **near)
    plans = points("plan", "LineStrips3D:strips")
    np.testing.assert_allclose(plans[:, :, :2], episode.plan_states[:, :, :2], **near)
    # 95 % of a two-dimensional normal distribution is within this Mahalanobis distance.
    ellipses = points("belief/ellipse", "LineStrips3D:strips")
    for k, ellipse in enumerate(ellipses):
        apart = ellipse[:, :2] - episode.belief_means[k, :2]
        inverse = np.linalg.inv(episode.belief_covariances[k, :2, :2])
        np.testing.assert_allclose(
            np.einsum("ij,jk,ik->i", apart, inverse, apart), 5.9915, rtol=1e-3
        )
    boxes = rrd["/world/map/obstacles Boxes3D:centers"][1][0]
    np.testing.assert_allclose(np.array(boxes)[:, :2], [[3, 3], [7, 6.5]])
    assert rrd["/world/vehicle/body LineStrips3D:strips"][0] is None  # constant in its frame


def test_particles_are_those_of_each_stage(episode, rrd, mcap):
    for stage in range(episode.stages + 1):
        _, rows = rrd[f"/world/particles/stage_{stage:02d} Points3D:positions"]
        _, weights = rrd[f"/world/particles/stage_{stage:02d} weight"]
        for step in range(episode.steps):
            locations, expected = episode.particles(step, stage)
            np.testing.assert_allclose(
                np.array(rows[step])[:, :2], locations[:, :2], rtol=1e-6, atol=1e-6
            )
            np.testing.assert_array_equal(weights[step], expected)
    types = {3: "<u2", 8: "<f8"}
    assert len(mcap["/particles"]) == episode.steps
    for step, (_, cloud) in enumerate(mcap["/particles"]):
        kind = np.dtype(
            {
                "names": [field["name"] for field in cloud["fields"]],
                "formats": [types[field["type"]] for field in cloud["fields"]],
                "offsets": [field["offset"] for field in cloud["fields"]],
                "itemsize": cloud["point_stride"],
            }
        )
        points = np.frombuffer(base64.b64decode(cloud["data"]), kind)
        for stage in range(episode.stages + 1):
            locations, weights = episode.particles(step, stage)
            of_stage = points[points["stage"] == stage]
            np.testing.assert_array_equal(of_stage["x"], locations[:, 0])
            np.testing.assert_array_equal(of_stage["y"], locations[:, 1])
            np.testing.assert_array_equal(of_stage["weight"], weights)


def test_mcap_draws_the_trace(episode, mcap):
    def entity(topic, row=0):
        (one,) = mcap[topic][row][1]["entities"]
        return one

    for (_, transform), (_, pose), state in zip(mcap["/tf"], mcap["/pose"], episode.states):
        place = transform["translation"]
        assert (place["x"], place["y"]) == tuple(state[:2])
        assert pose["pose"] == {"position": place, "orientation": transform["rotation"]}
        turn = transform["rotation"]
        assert 2.0 * np.arctan2(turn["z"], turn["w"]) == pytest.approx(state[2])
    assert len(mcap["/pose"]) == episode.steps + 1
    for step in (0, episode.steps - 1):
        points = [[point["x"], point["y"]] for point in entity("/plan", step)["lines"][0]["points"]]
        np.testing.assert_array_equal(points, episode.plan_states[step, :, :2])
    corners = [
        [cube["pose"]["position"][axis] - 0.5 * cube["size"][axis] for axis in "xy"]
        for cube in entity("/map/obstacles")["cubes"]
    ]
    np.testing.assert_allclose(corners, [[2, 2], [6, 5]])
    assert len(entity("/map/walls")["lines"]) == 4
    # The body is drawn at its frame, around all of its discs.
    body = entity("/vehicle")
    assert body["frame_locked"] and body["frame_id"] == mcap["/tf"][0][1]["child_frame_id"]
    outline = np.array([[p["x"], p["y"]] for line in body["lines"] for p in line["points"]])
    discs = episode.scenario.footprint
    assert len(discs) > 1
    gaps = np.hypot(*(outline[:, None] - discs[:, 1:]).T) - discs[:, :1]
    np.testing.assert_allclose(gaps.min(axis=0), 0.0, atol=1e-12)


def test_shapes_are_drawn_within_the_map(small, tmp_path):
    shapes = [
        {"polygon": [[2, 2], [4, 2], [4, 4]]},
        {"half_plane": {"normal": [-1, 0], "offset": 0.75}},
        {"disc": {"centre": [50, 50], "radius": 1}},
    ]
    episode = qsmpc.run(small.set({"safe_set.obstacles": shapes}), seed=3)
    polygon = [[2, 2], [4, 2], [4, 4], [2, 2]]
    (lower_x, lower_y, _), (_, upper_y, _) = episode.scenario.bounds
    strip = {(lower_x, lower_y), (-0.75, lower_y), (-0.75, upper_y), (lower_x, upper_y)}
    qsmpc.export_rerun(episode, tmp_path / "episode.rrd")
    strips = read_rrd(tmp_path / "episode.rrd")["/world/map/shapes LineStrips3D:strips"][1][0]
    qsmpc.export_mcap(episode, tmp_path / "episode.mcap")
    (entity,) = read_mcap(tmp_path / "episode.mcap")["/map/obstacles"][0][1]["entities"]
    lines = [[[point["x"], point["y"]] for point in line["points"]] for line in entity["lines"]]
    for drawn in (np.array(strip)[:, :2].tolist() for strip in strips), lines:
        drawn = list(drawn)
        assert len(drawn) == 2, "the disc is far away"
        assert drawn[0] == polygon
        assert {tuple(corner) for corner in drawn[1]} == strip


def test_outcome_and_status_are_said(episode, rrd, mcap):
    times, rows = rrd["/log TextLog:text"]
    assert rows[-1] == [f"outcome: {episode.outcome}"]
    assert times[-1] == nanoseconds(episode, None)[-1]
    assert any(row[0].startswith("solver: ") for row in rows)
    assert [row[0] for row in rows] == [content["message"] for _, content in mcap["/log"]]
    (about,) = rrd["/about TextDocument:text"][1][0]
    assert episode.outcome in about and "upper bounds" in about


def test_mcap_holds_the_scenario(episode, tmp_path):
    qsmpc.export_mcap(episode, tmp_path / "a.mcap")
    with open(tmp_path / "a.mcap", "rb") as file:
        reader = make_reader(file)
        (attachment,) = reader.iter_attachments()
        assert qsmpc.parse(attachment.data.decode()) == episode.scenario
        (metadata,) = reader.iter_metadata()
        assert metadata.metadata["outcome"] == episode.outcome


@pytest.mark.parametrize("name", ["double_integrator", "cart_pole_balance", "point_mass"])
def test_other_systems_are_written(name, tmp_path):
    scenario = qsmpc.load(name, {"limit.steps": 3, "plant.kind": "analytic"})
    folder = tmp_path / "drive"
    episode = qsmpc.run(scenario, seed=1, out=folder)
    qsmpc.export_rerun(folder, tmp_path / "a.rrd")  # from the file
    qsmpc.export_mcap(folder, tmp_path / "a.mcap")
    rrd, mcap = read_rrd(tmp_path / "a.rrd"), read_mcap(tmp_path / "a.mcap")
    assert "risk" not in {entry.split("/")[1] for entry in rrd} and "/risk" not in mcap
    (state, _), *_ = scenario.model().states
    np.testing.assert_array_equal(
        np.ravel(rrd[f"/state/{state} Scalars:scalars"][1]), episode.states[:, 0]
    )
    assert len(mcap["/tf"]) == episode.steps + 1


def test_a_drive_without_plans_and_one_that_broke_are_written(small, tmp_path):
    def act(now):
        if now.period == 2:
            raise RuntimeError("no idea")
        return [0.1]

    episode = qsmpc.run(small, controller=act)
    qsmpc.export_rerun(episode, tmp_path / "a.rrd")
    qsmpc.export_mcap(episode, tmp_path / "a.mcap")
    rrd, mcap = read_rrd(tmp_path / "a.rrd"), read_mcap(tmp_path / "a.mcap")
    assert "/plan" not in mcap and "/particles" not in mcap
    assert not any(entry.startswith(("/world/plan", "/world/particles")) for entry in rrd)
    assert "horizon" not in mcap["/certificate"][0][1]
    assert "no idea" in mcap["/log"][-1][1]["message"]
    assert mcap["/log"][-1][1]["level"] == 4


def test_certificates_that_are_no_bounds_are_said_to_be_none(small, tmp_path):
    noise = {"disturbance.sensor": "[1e-4, 1e-4, 1e-4]", "estimator.kind": "last_measurement"}
    noisy = small.set({**noise, "limit.steps": 2})
    episode = qsmpc.run(noisy)
    assert episode.scenario.no_bound
    qsmpc.export_rerun(episode, tmp_path / "a.rrd")
    assert f"no bounds: {episode.scenario.no_bound}" in str(read_rrd(tmp_path / "a.rrd"))


@pytest.mark.parametrize(
    ("export", "module", "words"),
    [
        (qsmpc.export_rerun, "rerun", "pip install 'qsmpc[rerun]'"),
        (qsmpc.export_mcap, "mcap", "pip install 'qsmpc[mcap]'"),
    ],
)
def test_a_missing_package_is_named(episode, export, module, words, monkeypatch, tmp_path):
    for name in [name for name in sys.modules if name.split(".")[0] == module]:
        monkeypatch.setitem(sys.modules, name, None)
    monkeypatch.delitem(sys.modules, f"qsmpc.exports.{module}_file", raising=False)
    ending = {"rerun": "rrd", "mcap": "mcap"}[module]
    with pytest.raises(ModuleNotFoundError) as raised:
        export(episode, tmp_path / f"a.{ending}")
    assert words in str(raised.value) and "\n" not in str(raised.value)
    assert not any(tmp_path.iterdir())


def test_wrong_endings_and_folders_that_are_not_there_are_refused(episode, tmp_path):
    with pytest.raises(ValueError, match=".rrd"):
        qsmpc.export_rerun(episode, tmp_path / "a.mcap")
    with pytest.raises(ValueError, match=".mcap"):
        qsmpc.export_mcap(episode, tmp_path / "a.bag")
    with pytest.raises(qsmpc.IoError, match="gone"):
        qsmpc.export_rerun(episode, tmp_path / "gone" / "a.rrd")
    with pytest.raises(qsmpc.IoError, match="gone"):
        qsmpc.export_mcap(episode, tmp_path / "gone" / "a.mcap")
