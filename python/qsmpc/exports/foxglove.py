"""Messages in Foxglove's schemas as JSON, and the schemas used here."""

from __future__ import annotations

import base64
import math
from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray

from qsmpc.exports.contents import ERROR, INFO, WARNING, Colour, Floats

Message = dict[str, Any]
Schema = dict[str, Any]

NUMBER: Schema = {"type": "number"}
_INTEGER: Schema = {"type": "integer", "minimum": 0}
_STRING: Schema = {"type": "string"}
_BOOLEAN: Schema = {"type": "boolean"}

# Values of foxglove.NumericType.
_NUMERIC_TYPES = {"<u2": 3, "<f4": 7, "<f8": 8}
_LEVELS = {INFO: 2, WARNING: 3, ERROR: 4}
_LINE_STRIP = 0


def object_schema(properties: dict[str, Schema], title: str = "", **more: Any) -> Schema:
    """An object with these properties, all of them required unless ``required`` is given."""
    schema: Schema = {"title": title} if title else {}
    return {
        **schema,
        "type": "object",
        "properties": properties,
        "required": list(properties),
        **more,
    }


def _list(items: Schema) -> Schema:
    return {"type": "array", "items": items}


_NANOSECONDS: Schema = {"type": "integer", "minimum": 0, "maximum": 999_999_999}
TIME = object_schema({"sec": _INTEGER, "nsec": _NANOSECONDS}, "time")
_DURATION = object_schema({"sec": {"type": "integer"}, "nsec": _NANOSECONDS}, "duration")
_VECTOR = object_schema({axis: NUMBER for axis in "xyz"}, "foxglove.Vector3")
_POINT = object_schema({axis: NUMBER for axis in "xyz"}, "foxglove.Point3")
_QUATERNION = object_schema({axis: NUMBER for axis in "xyzw"}, "foxglove.Quaternion")
_POSE = object_schema({"position": _VECTOR, "orientation": _QUATERNION}, "foxglove.Pose")
_COLOUR = object_schema({channel: NUMBER for channel in "rgba"}, "foxglove.Color")


def _choice(title: str, names: list[str]) -> Schema:
    options = [{"title": name, "const": number} for number, name in enumerate(names)]
    return {"title": title, "oneOf": options}


_LINE = object_schema(
    {
        "type": _choice("foxglove.LineType", ["LINE_STRIP", "LINE_LOOP", "LINE_LIST"]),
        "pose": _POSE,
        "thickness": NUMBER,
        "scale_invariant": _BOOLEAN,
        "points": _list(_POINT),
        "color": _COLOUR,
        "colors": _list(_COLOUR),
        "indices": _list(_INTEGER),
    },
    "foxglove.LinePrimitive",
)
_CUBE = object_schema({"pose": _POSE, "size": _VECTOR, "color": _COLOUR}, "foxglove.CubePrimitive")
_ARROW = object_schema(
    {
        "pose": _POSE,
        **{
            f"{part}_{size}": NUMBER
            for part in ("shaft", "head")
            for size in ("length", "diameter")
        },
        "color": _COLOUR,
    },
    "foxglove.ArrowPrimitive",
)
_ENTITY = object_schema(
    {
        "timestamp": TIME,
        "frame_id": _STRING,
        "id": _STRING,
        "lifetime": _DURATION,
        "frame_locked": _BOOLEAN,
        "metadata": _list(
            object_schema({"key": _STRING, "value": _STRING}, "foxglove.KeyValuePair")
        ),
        "arrows": _list(_ARROW),
        "cubes": _list(_CUBE),
        "lines": _list(_LINE),
        # The primitives that are not used here.
        **{
            name: _list({"type": "object"})
            for name in ("spheres", "cylinders", "triangles", "texts", "models")
        },
    },
    "foxglove.SceneEntity",
)
_DELETION = object_schema(
    {
        "timestamp": TIME,
        "type": _choice("foxglove.SceneEntityDeletionType", ["MATCHING_ID", "ALL"]),
        "id": _STRING,
    },
    "foxglove.SceneEntityDeletion",
)
_FIELD = object_schema(
    {
        "name": _STRING,
        "offset": _INTEGER,
        "type": _choice(
            "foxglove.NumericType",
            "UNKNOWN UINT8 INT8 UINT16 INT16 UINT32 INT32 FLOAT32 FLOAT64".split(),
        ),
    },
    "foxglove.PackedElementField",
)

#: The schemas by name.
SCHEMAS: dict[str, Schema] = {
    schema["title"]: schema
    for schema in (
        object_schema(
            {"timestamp": TIME, "frame_id": _STRING, "pose": _POSE}, "foxglove.PoseInFrame"
        ),
        object_schema(
            {
                "timestamp": TIME,
                "parent_frame_id": _STRING,
                "child_frame_id": _STRING,
                "translation": _VECTOR,
                "rotation": _QUATERNION,
            },
            "foxglove.FrameTransform",
        ),
        object_schema(
            {"deletions": _list(_DELETION), "entities": _list(_ENTITY)}, "foxglove.SceneUpdate"
        ),
        object_schema(
            {
                "timestamp": TIME,
                "frame_id": _STRING,
                "pose": _POSE,
                "point_stride": _INTEGER,
                "fields": _list(_FIELD),
                "data": {"type": "string", "contentEncoding": "base64"},
            },
            "foxglove.PointCloud",
        ),
        object_schema(
            {
                "timestamp": TIME,
                "level": _choice(
                    "foxglove.LogLevel", "UNKNOWN DEBUG INFO WARNING ERROR FATAL".split()
                ),
                "message": _STRING,
                "name": _STRING,
                "file": _STRING,
                "line": _INTEGER,
            },
            "foxglove.Log",
        ),
    )
}


def time(nanoseconds: int) -> Message:
    seconds, rest = divmod(int(nanoseconds), 1_000_000_000)
    return {"sec": seconds, "nsec": rest}


def _xyz(x: float, y: float, z: float = 0.0) -> Message:
    return {"x": float(x), "y": float(y), "z": float(z)}


def _turn(heading: float) -> Message:
    return {**_xyz(0.0, 0.0, math.sin(heading / 2.0)), "w": math.cos(heading / 2.0)}


def pose(place: Floats, heading: float = 0.0, height: float = 0.0) -> Message:
    return {"position": _xyz(place[0], place[1], height), "orientation": _turn(heading)}


def pose_in_frame(nanoseconds: int, frame: str, place: Floats, heading: float) -> Message:
    return {"timestamp": time(nanoseconds), "frame_id": frame, "pose": pose(place, heading)}


def transform(nanoseconds: int, parent: str, child: str, place: Floats, heading: float) -> Message:
    return {
        "timestamp": time(nanoseconds),
        "parent_frame_id": parent,
        "child_frame_id": child,
        "translation": _xyz(*place),
        "rotation": _turn(heading),
    }


def _colour(colour: Colour) -> Message:
    return dict(zip("rgba", colour))


def line(points: Floats, colour: Colour, thickness: float) -> Message:
    """A line through points (… × 2)."""
    return {
        "type": _LINE_STRIP,
        "pose": pose(np.zeros(2)),
        "thickness": thickness,
        "scale_invariant": False,
        "points": [_xyz(*point) for point in points],
        "color": _colour(colour),
        "colors": [],
        "indices": [],
    }


def cube(lower: Floats, upper: Floats, height: float, colour: Colour) -> Message:
    """A rectangle of the map, from the ground to ``height``."""
    return {
        "pose": pose(0.5 * (lower + upper), height=0.5 * height),
        "size": _xyz(upper[0] - lower[0], upper[1] - lower[1], height),
        "color": _colour(colour),
    }


def arrow(length: float, colour: Colour) -> Message:
    """An arrow from the origin of its frame along the x axis."""
    return {
        "pose": pose(np.zeros(2)),
        "shaft_length": 0.7 * length,
        "shaft_diameter": 0.1 * length,
        "head_length": 0.3 * length,
        "head_diameter": 0.25 * length,
        "color": _colour(colour),
    }


def scene(
    nanoseconds: int,
    frame: str,
    name: str,
    *,
    lines: Optional[list[Message]] = None,
    cubes: Optional[list[Message]] = None,
    arrows: Optional[list[Message]] = None,
    follows_frame: bool = False,
) -> Message:
    """One entity, which replaces that of the same name on the same topic."""
    empty: list[Message] = []
    entity = {
        "timestamp": time(nanoseconds),
        "frame_id": frame,
        "id": name,
        "lifetime": {"sec": 0, "nsec": 0},  # 0: until replaced
        "frame_locked": follows_frame,
        "metadata": empty,
        "arrows": arrows or [],
        "cubes": cubes or [],
        "lines": lines or [],
        **{kind: empty for kind in ("spheres", "cylinders", "triangles", "texts", "models")},
    }
    return {"deletions": [], "entities": [entity]}


def point_cloud(nanoseconds: int, frame: str, points: NDArray[np.void]) -> Message:
    """``points``: a structured array, packed, little-endian, with at least x and y."""
    fields: Any = points.dtype.fields
    return {
        "timestamp": time(nanoseconds),
        "frame_id": frame,
        "pose": pose(np.zeros(2)),
        "point_stride": points.dtype.itemsize,
        "fields": [
            {"name": name, "offset": offset, "type": _NUMERIC_TYPES[kind.str]}
            for name, (kind, offset, *_) in fields.items()
        ],
        "data": base64.b64encode(points.tobytes()).decode("ascii"),
    }


def log(nanoseconds: int, level: str, text: str, name: str) -> Message:
    return {
        "timestamp": time(nanoseconds),
        "level": _LEVELS[level],
        "message": text,
        "name": name,
        "file": "",
        "line": 0,
    }
