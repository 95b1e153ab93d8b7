"""Episodes as MCAP (https://mcap.dev), with JSON messages that Foxglove can show."""

from __future__ import annotations

import io
import json
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from mcap.well_known import MessageEncoding, SchemaEncoding
from mcap.writer import Writer

from qsmpc._native import core
from qsmpc.exports import contents as shown
from qsmpc.exports import foxglove
from qsmpc.exports.contents import Contents, DriveMap, Floats, Series

_WORLD, _VEHICLE = "world", "vehicle"
# As a fraction of the map's size.
_LINE, _BOLD, _ARROW, _HEIGHT = 0.003, 0.006, 0.03, 0.02
_POINT = np.dtype([("x", "<f8"), ("y", "<f8"), ("z", "<f8"), ("weight", "<f8"), ("stage", "<u2")])


class Sent(NamedTuple):
    """A message on a topic at a time."""

    nanoseconds: int
    topic: str
    schema: str
    message: foxglove.Message


class _File:
    """Collects messages and writes them in chronological order."""

    def __init__(self, title: str) -> None:
        self.bytes = io.BytesIO()
        self.writer = Writer(self.bytes)
        self.writer.start(library=title)
        self.schemas: dict[str, int] = {}
        self.channels: dict[str, int] = {}

    def schema(self, name: str, schema: foxglove.Schema) -> None:
        self.schemas[name] = self.writer.register_schema(
            name, SchemaEncoding.JSONSchema, json.dumps(schema).encode()
        )

    def add(self, sent: Sent) -> None:
        if sent.topic not in self.channels:
            self.channels[sent.topic] = self.writer.register_channel(
                sent.topic, MessageEncoding.JSON, self.schemas[sent.schema]
            )
        data = json.dumps(sent.message, allow_nan=False, separators=(",", ":")).encode()
        time = sent.nanoseconds
        self.writer.add_message(self.channels[sent.topic], time, data, publish_time=time)

    def finished(self) -> bytes:
        self.writer.finish()
        return self.bytes.getvalue()


def _once(area: DriveMap, path: Floats) -> Iterator[Sent]:
    """Static content, at time 0."""
    size = area.size
    cubes = [
        foxglove.cube(
            box.lower, box.upper, _HEIGHT * size, shown.PARTIAL if box.is_partial else shown.SOLID
        )
        for box in area.obstacles()
    ]
    walls = [foxglove.line(wall, shown.SOLID, _BOLD * size) for wall in area.walls()]
    shapes = [foxglove.line(shape, shown.SOLID, _BOLD * size) for shape in area.shapes()]
    target = [foxglove.line(area.target(), shown.GREEN, _BOLD * size)]
    body = [foxglove.line(part, shown.SKY, _BOLD * size) for part in area.body()]
    arrows = [foxglove.arrow(_ARROW * size, shown.SKY)] if area.heading >= 0 else []
    ways = [foxglove.line(path, shown.SKY, _LINE * size)]
    scenes = {
        "/map/obstacles": foxglove.scene(0, _WORLD, "obstacles", cubes=cubes, lines=shapes),
        "/map/walls": foxglove.scene(0, _WORLD, "walls", lines=walls),
        "/map/target": foxglove.scene(0, _WORLD, "target", lines=target),
        "/path": foxglove.scene(0, _WORLD, "path", lines=ways),
        "/vehicle": foxglove.scene(
            0, _VEHICLE, "vehicle", lines=body, arrows=arrows, follows_frame=True
        ),
    }
    for topic, scene in scenes.items():
        yield Sent(0, topic, "foxglove.SceneUpdate", scene)


def _poses(contents: Contents, area: DriveMap) -> Iterator[Sent]:
    episode = contents.episode
    rows = {
        "/pose": episode.states,
        "/observation/pose": episode.observations,
        "/belief/pose": episode.belief_means,
    }
    for topic, states in rows.items():
        places, headings = area.points(states), area.headings(states)
        for at, place, heading in zip(contents.state_nanoseconds, places, headings):
            if not np.isfinite([*place, heading]).all():
                continue
            pose = foxglove.pose_in_frame(at, _WORLD, place, heading)
            yield Sent(int(at), topic, "foxglove.PoseInFrame", pose)
            if topic == "/pose":
                transform = foxglove.transform(at, _WORLD, _VEHICLE, place, heading)
                yield Sent(int(at), "/tf", "foxglove.FrameTransform", transform)


def _lines(contents: Contents, area: DriveMap) -> Iterator[Sent]:
    """Ellipse and plan of each period; an empty scene if there are none."""
    kinds = {"/belief/ellipse": (area.belief_ellipses(), shown.GREEN)}
    if contents.episode.stages > 0:
        kinds["/plan"] = (area.plans(), shown.ORANGE)
    for topic, (strips, colour) in kinds.items():
        for at, strip in zip(contents.step_nanoseconds, strips):
            is_known = np.isfinite(strip).all()
            lines = [foxglove.line(strip, colour, _LINE * area.size)] if is_known else []
            scene = foxglove.scene(at, _WORLD, topic[1:], lines=lines)
            yield Sent(int(at), topic, "foxglove.SceneUpdate", scene)


def _particles(contents: Contents, area: DriveMap) -> Iterator[Sent]:
    episode = contents.episode
    if not episode.has_particles:
        return
    for step, at in enumerate(contents.step_nanoseconds):
        clouds = [area.particles(step, stage) for stage in range(episode.stages + 1)]
        points = np.zeros(sum(len(weights) for _, weights in clouds), _POINT)
        places = np.concatenate([places for places, _ in clouds])
        points["x"], points["y"] = places[:, 0], places[:, 1]
        points["weight"] = np.concatenate([weights for _, weights in clouds])
        points["stage"] = np.repeat(np.arange(len(clouds)), [len(cloud[1]) for cloud in clouds])
        cloud = foxglove.point_cloud(at, _WORLD, points)
        yield Sent(int(at), "/particles", "foxglove.PointCloud", cloud)


def _events(contents: Contents) -> Iterator[Sent]:
    for event in contents.events():
        at = event.nanoseconds
        message = foxglove.log(at, event.level, event.text, contents.scenario.name)
        yield Sent(at, "/log", "foxglove.Log", message)


def _groups(contents: Contents) -> dict[str, list[Series]]:
    groups: dict[str, list[Series]] = {}
    for series in contents.series():
        groups.setdefault(series.group, []).append(series)
    return groups


def _numbers(name: str, group: list[Series]) -> Iterator[Sent]:
    """One message per time, with a key for each number known at that time."""
    messages: dict[int, foxglove.Message] = {}
    for series in group:
        for at, value in zip(series.nanoseconds, series.values):
            message = messages.setdefault(int(at), {"timestamp": foxglove.time(at)})
            message[series.name] = float(value)
    for at, message in messages.items():
        yield Sent(at, f"/{name}", f"qsmpc.{name}", message)


def _number_schema(name: str, group: list[Series]) -> foxglove.Schema:
    properties: dict[str, Any] = {"timestamp": foxglove.TIME}
    for series in group:
        properties[series.name] = {**foxglove.NUMBER, "description": series.unit or "no unit"}
    # Unknown numbers are left out: JSON has no non-finite numbers.
    return foxglove.object_schema(properties, f"qsmpc.{name}", required=["timestamp"])


def _drawn(contents: Contents, area: DriveMap) -> Iterator[Sent]:
    path = area.points(contents.episode.states)
    yield from _once(area, path[np.isfinite(path).all(axis=1)])
    yield from _poses(contents, area)
    yield from _lines(contents, area)
    yield from _particles(contents, area)


def recording(contents: Contents) -> bytes:
    """The content of an ``.mcap`` file."""
    groups = _groups(contents)
    file = _File(f"qsmpc {core.__version__}")
    for name, schema in foxglove.SCHEMAS.items():
        file.schema(name, schema)
    sent: list[Sent] = []
    for name, group in groups.items():
        file.schema(f"qsmpc.{name}", _number_schema(name, group))
        sent.extend(_numbers(name, group))
    if contents.map is not None:
        sent.extend(_drawn(contents, contents.map))
    sent.extend(_events(contents))
    file.writer.add_metadata("qsmpc", contents.about())
    file.writer.add_attachment(
        0, 0, "scenario.yaml", "application/yaml", contents.scenario.to_yaml().encode()
    )
    for message in sorted(sent, key=lambda one: one.nanoseconds):
        file.add(message)
    return file.finished()
