"""Compares golden data with what was taken now, bit for bit or within a tolerance."""
import json
import math
import re

import numpy

import records

# Tolerance: two floating-point numbers may differ by at most RELATIVE times the largest magnitude
# in their array (for single numbers, the larger of the two) plus ABSOLUTE; whole numbers and texts
# must be equal. Another implementation of the C library's functions changes the inputs of a plan by
# up to 1 % of their range, because the last bits decide when a search stops.
RELATIVE = 0.05
ABSOLUTE = 1e-9
# May then differ entirely: the course of a search, and which of two close bounds was smaller.
DISCRETE = re.compile(r"(^|[/.])(fallback|fallbacks|iterations|iterations_median|kind|status)([.@]|$)"
                      r"|ocp\.iterations|\.iterations\.")
# Particles may be merged differently, so only their means are compared.
UNORDERED = re.compile(r"/particles/")
# Pictures and figures that agree within the tolerance.
PIXEL_SHARE = 0.02  # of the pixels may differ by more than PIXEL_LEVELS
PIXEL_LEVELS = 24
FIGURE_ABSOLUTE = 1.0  # units of the drawing
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
# Maximum number of differences shown per file.
SHOWN = 20


def shown(value):
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) <= 160 else text[:157] + "..."


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def same(a, b):
    """Whether two values have the same bits; 1 and 1.0 are the same number."""
    if is_number(a) and is_number(b) and abs(a) < 2**53:
        return float(a).hex() == float(b).hex()
    return json.dumps(a) == json.dumps(b)


def near(a, b, scale, absolute=ABSOLUTE):
    if not (is_number(a) and is_number(b)) or isinstance(a, int) and isinstance(b, int):
        return a == b  # texts, and counts
    if math.isnan(a) or math.isnan(b):
        return math.isnan(a) and math.isnan(b)
    return a == b or abs(a - b) <= RELATIVE * scale + absolute


def scale_of(values):
    return max((abs(v) for v in values if is_number(v) and math.isfinite(v)), default=0.0)


def flat(value):
    return [leaf for part in value for leaf in flat(part)] if isinstance(value, list) else [value]


def shape_of(value):
    return (len(value),) + shape_of(value[0]) if isinstance(value, list) and value else \
        (0,) if isinstance(value, list) else ()


def full_shape(entry):
    return entry["shape"] if isinstance(entry, dict) else list(shape_of(entry))


def where_differs(golden, now):
    """Of two large arrays of one shape: the rows of the blocks that differ."""
    bounds = records.block_bounds(golden["shape"][0])
    blocks = [(int(a), int(b)) for a, b, old, new
              in zip(bounds[:-1], bounds[1:], golden["blocks"], now["blocks"]) if old != new]
    if not blocks:
        return "stored values alone differ: the golden data were edited"
    return (f"in {len(blocks)} of {len(golden['blocks'])} blocks of rows, "
            f"first in rows {blocks[0][0]} to {blocks[0][1] - 1} of {golden['shape'][0]}")


def first_values(golden, now, positions, shape):
    """The first of the elements that differ, up to three of them."""
    pairs = [(p, a, b) for p, a, b in zip(positions, golden, now) if not same(a, b)]
    lines = []
    for position, a, b in pairs[:3]:
        place = ", ".join(str(i) for i in numpy.unravel_index(int(position), shape)) if shape else ""
        step = f" (by {b - a:.3g})" if is_number(a) and is_number(b) else ""
        lines.append(f"[{place}] golden {shown(a)}, now {shown(b)}{step}" if shape
                     else f"golden {shown(a)}, now {shown(b)}{step}")
    if len(pairs) > 3:
        lines.append(f"and {len(pairs) - 3} more")
    return "; ".join(lines)


def difference(golden, now):
    """What differs between two entries, in words; None if they agree bit for bit."""
    if full_shape(golden) != full_shape(now):
        return f"shape {full_shape(golden)} became {full_shape(now)}"
    if not isinstance(golden, dict):
        values = flat(golden)
        return first_values(values, flat(now), range(len(values)), shape_of(golden)) or None
    if golden["type"] != now["type"]:
        return f"type {golden['type']} became {now['type']}"
    positions = records.sample_positions(math.prod(golden["shape"]))
    values = first_values(golden["values"], now["values"], positions, golden["shape"])
    if golden["sha256"] == now["sha256"] and not values:
        return None
    return f"{where_differs(golden, now)}; {values or 'none of the stored values differs'}"


def within_tolerance(key, golden, now):
    """Whether two entries that differ agree within the tolerance."""
    if isinstance(golden, dict) and isinstance(now, dict):
        if any(golden[part] != now[part] for part in ("type", "shape")):
            return False
        if DISCRETE.search(key):
            return True
        # The means are dominated by a few huge elements, which may not be among the stored ones.
        spread = golden.get("mean_magnitude") or 0.0
        if golden.get("nan") != now.get("nan") or any(
                not near(golden.get(p), now.get(p), spread) for p in ("mean", "mean_magnitude")):
            return False
        scale = scale_of(golden["values"])
        return bool(UNORDERED.search(key)) or all(
            near(a, b, scale) for a, b in zip(golden["values"], now["values"]))
    if full_shape(golden) != full_shape(now):
        return False
    a, b = flat(golden), flat(now)
    scale = scale_of(a + b)
    return bool(DISCRETE.search(key)) or all(near(x, y, scale) for x, y in zip(a, b))


class Result:
    """What a comparison of one file found."""

    def __init__(self):
        self.differences = []  # in words
        self.tolerated = 0  # entries with different bits, within the tolerance
        self.new = []  # keys missing in the golden data


def compare_records(golden_path, now_path, exact):
    golden, now = records.read_records(golden_path), records.read_records(now_path)
    result = Result()
    result.new = sorted(set(now) - set(golden))
    for key, entry in golden.items():
        if key not in now:
            result.differences.append(f"{key}: missing")
            continue
        words = difference(entry, now[key])
        if words is None:
            continue
        if not exact and within_tolerance(key, entry, now[key]):
            result.tolerated += 1
        else:
            result.differences.append(f"{key}: {words}")
    return result


def compare_figures(golden_path, now_path, exact):
    """Figures are text, and compared by line."""
    golden, now = golden_path.read_text().splitlines(), now_path.read_text().splitlines()
    result = Result()
    if len(golden) != len(now):
        result.differences.append(f"{len(golden)} lines became {len(now)}")
    for number, (a, b) in enumerate(zip(golden, now), 1):
        if a == b:
            continue
        numbers_a, numbers_b = ([float(n) for n in NUMBER.findall(line)] for line in (a, b))
        if not exact and NUMBER.sub("#", a) == NUMBER.sub("#", b) and all(
                near(x, y, scale_of([x, y]), FIGURE_ABSOLUTE) for x, y in zip(numbers_a, numbers_b)):
            result.tolerated += 1
            continue
        column = next((i for i, (x, y) in enumerate(zip(a, b)) if x != y), min(len(a), len(b)))
        begin = max(0, column - 20)
        result.differences.append(f"line {number}, column {column + 1}: golden "
                                  f"{shown(a[begin:begin + 60])}, now {shown(b[begin:begin + 60])}")
    return result


def compare_pictures(golden_path, now_path, exact):
    golden, now = records.read_picture(golden_path), records.read_picture(now_path)
    result = Result()
    if golden.shape != now.shape:
        sizes = [f"{image.shape[1]}x{image.shape[0]}" for image in (golden, now)]
        result.differences.append(f"size {sizes[0]} became {sizes[1]}")
        return result
    step = abs(golden.astype(int) - now.astype(int)).max(axis=2)
    rows, columns = numpy.nonzero(step)
    if rows.size == 0:
        return result
    if not exact and (step > PIXEL_LEVELS).mean() <= PIXEL_SHARE:
        result.tolerated += 1
        return result
    y, x = rows[0], columns[0]
    result.differences.append(
        f"{rows.size} of {step.size} pixels differ, by up to {step.max()} of 255, within x "
        f"{columns.min()} to {columns.max()}, y {rows.min()} to {rows.max()}; first at x {x}, y {y}: "
        f"golden {golden[y, x].tolist()}, now {now[y, x].tolist()}")
    return result


def compare_file(golden_path, now_path, exact):
    """Compares two files of one name."""
    if not now_path.exists():
        result = Result()
        result.differences.append("missing")
        return result
    compare = {".txt": compare_records, ".svg": compare_figures, ".png": compare_pictures}
    return compare[golden_path.suffix](golden_path, now_path, exact)
