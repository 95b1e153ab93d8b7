"""Episodes as recordings of Rerun (https://rerun.io)."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

from qsmpc._native import core
from qsmpc.exports import contents as shown
from qsmpc.exports.contents import Contents, DriveMap, Floats, Series

TIMELINE = "time"
_LEVELS = {shown.INFO: "INFO", shown.WARNING: "WARN", shown.ERROR: "ERROR"}
# As a fraction of the map's size.
_LINE, _BOLD, _MARK, _VEHICLE, _HEIGHT = 0.0015, 0.003, 0.006, 0.03, 0.02


@contextmanager
def _strict() -> Iterator[None]:
    """Makes Rerun raise what it would otherwise only warn of and leave out of the file."""
    before = rr.strict_mode()
    rr.set_strict_mode(True)
    try:
        yield
    finally:
        rr.set_strict_mode(before)


def _times(nanoseconds: Any) -> rr.TimeColumn:
    return rr.TimeColumn(TIMELINE, duration=np.asarray(nanoseconds).astype("timedelta64[ns]"))


def _in_space(points: Floats, height: float = 0.0) -> Floats:
    """Points of the map (… × 2) as … × 3."""
    return np.concatenate([points, np.full((*points.shape[:-1], 1), height)], axis=-1)


class _Recording:
    def __init__(self, contents: Contents) -> None:
        self.contents = contents
        # The same drive gets the same id, so that viewers show it only once.
        digest = hashlib.sha256(contents.scenario.to_yaml().encode())
        digest.update(contents.episode.states.tobytes() + contents.episode.inputs.tobytes())
        self.stream = rr.RecordingStream("qsmpc", recording_id=digest.hexdigest()[:32])
        if not rr.is_enabled(self.stream):
            raise RuntimeError("export_rerun: Rerun is disabled by the environment variable RERUN")
        # In memory: with a file on a full disk, Rerun would wait forever.
        self.memory = self.stream.memory_recording()

    def content(self) -> bytes:
        """The recording as the bytes of a file."""
        contents = self.contents
        self.stream.send_recording_name(contents.title)
        lines = [f"| {name} | {words} |" for name, words in contents.about().items()]
        table = "\n".join([f"# {contents.title}", "", "| | |", "| --- | --- |", *lines])
        self.static("about", rr.TextDocument(table, media_type="text/markdown"))
        for series in contents.series():
            self.add_series(series)
        self.add_events()
        if contents.map is not None:
            self.add_map(contents.map)
            self.add_vehicle(contents.map)
            self.add_belief(contents.map)
            self.add_plans(contents.map)
            self.add_particles(contents.map)
        self.stream.send_blueprint(_blueprint(contents))
        return self.memory.drain_as_bytes()

    def static(self, path: str, *parts: Any) -> None:
        self.stream.log(path, *parts, static=True, strict=True)

    def over_time(self, path: str, nanoseconds: Any, *columns: Any) -> None:
        """``columns``: of archetypes, with as many rows as there are times."""
        if len(nanoseconds) == 0:
            return
        flat = [column for group in columns for column in group]
        self.stream.send_columns(path, [_times(nanoseconds)], flat, strict=True)

    def add_series(self, series: Series) -> None:
        path = f"{series.group}/{series.name}"
        label = f"{series.name} ({series.unit})" if series.unit else series.name
        self.static(path, rr.SeriesLines(names=label))
        self.over_time(path, series.nanoseconds, rr.Scalars.columns(scalars=series.values))

    def add_events(self) -> None:
        events = self.contents.events()
        columns = rr.TextLog.columns(
            text=[event.text for event in events], level=[_LEVELS[event.level] for event in events]
        )
        self.over_time("log", [event.nanoseconds for event in events], columns)

    def add_map(self, area: DriveMap) -> None:
        size = area.size
        self.static("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP)
        boxes = area.obstacles()
        if boxes:
            lower, upper = (
                _in_space(np.array([getattr(box, end) for box in boxes]))
                for end in ("lower", "upper")
            )
            upper[:, 2] = _HEIGHT * size
            colours = [shown.PARTIAL if box.is_partial else shown.SOLID for box in boxes]
            self.static(
                "world/map/obstacles",
                rr.Boxes3D(
                    mins=lower, sizes=upper - lower, colors=np.array(colours), fill_mode="solid"
                ),
            )
        lines = {
            "shapes": (area.shapes(), shown.SOLID),
            "walls": (area.walls(), shown.SOLID),
            "target": ([area.target()], shown.GREEN),
        }
        for name, (strips, colour) in lines.items():
            if strips:
                self.static(f"world/map/{name}", self.lines(strips, colour, _BOLD))

    def lines(self, strips: list[Floats], colour: Any, width: float) -> rr.LineStrips3D:
        assert self.contents.map is not None
        return rr.LineStrips3D(
            [_in_space(strip) for strip in strips],
            colors=[colour] * len(strips),
            radii=width * self.contents.map.size,
        )

    def strips_over_time(self, path: str, strips: Floats, colour: Any, width: float) -> None:
        """A line for each period (steps × points × 2); none where it is NaN."""
        assert self.contents.map is not None
        known = np.isfinite(strips).all(axis=(1, 2)) if strips.size else np.zeros(len(strips), bool)
        self.static(
            path,
            rr.LineStrips3D.from_fields(colors=[colour], radii=[width * self.contents.map.size]),
        )
        if known.any():
            columns = rr.LineStrips3D.columns(strips=[_in_space(strip) for strip in strips[known]])
            times = self.contents.step_nanoseconds[: len(strips)]
            self.over_time(path, times, columns.partition(known.astype(int)))

    def points_over_time(self, path: str, points: Floats, colour: Any) -> None:
        """A point for each period (steps × 2); none where it is NaN."""
        assert self.contents.map is not None
        known = np.isfinite(points).all(axis=1)
        self.static(
            path,
            rr.Points3D.from_fields(colors=[colour], radii=[_MARK * self.contents.map.size]),
        )
        columns = rr.Points3D.columns(positions=_in_space(points[known]))
        self.over_time(path, self.contents.step_nanoseconds[: len(points)][known], columns)

    def add_vehicle(self, area: DriveMap) -> None:
        states = self.contents.episode.states
        places, headings = area.points(states), area.headings(states)
        known = np.isfinite(places).all(axis=1) & np.isfinite(headings)
        places, headings = places[known], headings[known]
        times = self.contents.state_nanoseconds[known]
        turns = np.zeros((len(headings), 4))
        turns[:, 2], turns[:, 3] = np.sin(headings / 2.0), np.cos(headings / 2.0)
        self.over_time(
            "world/vehicle",
            times,
            rr.Transform3D.columns(translation=_in_space(places), quaternion=turns),
        )
        mark = _VEHICLE * area.size
        self.static(
            "world/vehicle/position",
            rr.Points3D([[0, 0, 0]], colors=[shown.SKY], radii=_MARK * area.size),
        )
        if area.heading >= 0:
            self.static(
                "world/vehicle/heading", rr.Arrows3D(vectors=[[mark, 0, 0]], colors=[shown.SKY])
            )
        if area.body():
            self.static("world/vehicle/body", self.lines(area.body(), shown.SKY, _BOLD))
        # A segment of the path for each period: the view shows those up to its time.
        pieces = np.stack([places[:-1], places[1:]], axis=1)
        if len(pieces):
            self.static(
                "world/path",
                rr.LineStrips3D.from_fields(colors=[shown.SKY], radii=[_LINE * area.size]),
            )
            self.over_time(
                "world/path", times[1:], rr.LineStrips3D.columns(strips=list(_in_space(pieces)))
            )
        self.points_over_time(
            "world/observation", area.points(self.contents.episode.observations), shown.VERMILION
        )

    def add_belief(self, area: DriveMap) -> None:
        means = area.points(self.contents.episode.belief_means)
        self.points_over_time("world/belief/mean", means, shown.GREEN)
        self.strips_over_time("world/belief/ellipse", area.belief_ellipses(), shown.GREEN, _LINE)

    def add_plans(self, area: DriveMap) -> None:
        if self.contents.episode.stages > 0:
            self.strips_over_time("world/plan", area.plans(), shown.ORANGE, _LINE)

    def add_particles(self, area: DriveMap) -> None:
        """Adds the points of each stage with their weights, which determine their size."""
        episode = self.contents.episode
        if not episode.has_particles:
            return
        for stage in range(episode.stages + 1):
            clouds = [area.particles(step, stage) for step in range(episode.steps)]
            counts = [len(weights) for _, weights in clouds]
            if sum(counts) == 0:
                continue
            points = _in_space(np.concatenate([cloud[0] for cloud in clouds]))
            weights = np.concatenate([cloud[1] for cloud in clouds])
            radii = _MARK * area.size * np.sqrt(weights)
            path = f"world/particles/stage_{stage:02d}"
            colour = core.stage_colour(stage, episode.stages + 1)
            self.static(path, rr.Points3D.from_fields(colors=[colour]))
            self.over_time(
                path,
                self.contents.step_nanoseconds,
                rr.Points3D.columns(positions=points, radii=radii).partition(counts),
                rr.AnyValues.columns(weight=weights).partition(counts),
            )


def _blueprint(contents: Contents) -> rrb.Blueprint:
    """The initial layout of the recording in a viewer."""
    groups = list(dict.fromkeys(series.group for series in contents.series()))
    plots = [
        rrb.TimeSeriesView(origin=group, name=group)
        for group in groups
        if group in ("input", "clearance", "certificate", "risk")
    ]
    states = rrb.TimeSeriesView(origin="state", name="state")
    words = rrb.Tabs(
        rrb.TextLogView(origin="log", name="log"),
        rrb.TextDocumentView(origin="about", name="about"),
        states,
    )
    side = rrb.Vertical(*plots, words)
    time = rrb.TimePanel(timeline=TIMELINE, state="collapsed")
    if contents.map is None:
        return rrb.Blueprint(side, time, collapse_panels=True)
    until_now = rrb.VisibleTimeRange(
        TIMELINE,
        start=rrb.TimeRangeBoundary.infinite(),
        end=rrb.TimeRangeBoundary.cursor_relative(),
    )
    space = rrb.Spatial3DView(
        origin="world", name="map", overrides={"world/path": rrb.VisibleTimeRanges(until_now)}
    )
    return rrb.Blueprint(
        rrb.Horizontal(space, side, column_shares=[3, 2]), time, collapse_panels=True
    )


def recording(contents: Contents) -> bytes:
    """The content of an ``.rrd`` file."""
    with _strict():
        return _Recording(contents).content()
