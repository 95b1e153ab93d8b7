"""What is recorded of the program's results: every file becomes a flat mapping of keys to entries.

An entry is a number, a text, null, a list of at most 64 numbers or texts (nested as the array is),
or, for a larger array, a mapping of its type, its shape, the SHA-256 of its bytes, the CRC-32 of up
to 16 blocks of its rows, up to 64 of its elements, and for floating-point numbers how many are NaN,
and the mean and mean magnitude of those that are finite. JSON holds every double exactly.
"""
import csv
import hashlib
import json
import math
import re
import subprocess
import zlib

import h5py
import numpy
import yaml

SAMPLES = 64  # stored elements per array
BLOCKS = 16  # blocks of rows with their own checksums

# Components of excluded keys: the clock, the program's version, and prose.
LEFT_OUT = {"comment", "deadline_misses", "description", "finished_at", "ocp_ms", "times_real_time",
            "timing", "version", "wall_ms"}


def sample_positions(size):
    """The flat indices of the elements that are kept: the first, the last, and evenly between."""
    return numpy.unique(numpy.linspace(0, size - 1, min(size, SAMPLES)).round().astype(int))


def block_bounds(rows):
    """Where blocks of rows begin, and the end of the last one."""
    return numpy.unique(numpy.linspace(0, rows, min(rows, BLOCKS) + 1).round().astype(int))


def text_of(value):
    return value.decode().rstrip("\0") if isinstance(value, bytes) else value


def canonical_bytes(array):
    """The same bytes on every processor, however texts are stored."""
    if array.dtype.kind in "OSU":
        return json.dumps(array.tolist()).encode()
    return numpy.ascontiguousarray(array.astype(array.dtype.newbyteorder("<"))).tobytes()


def record_array(array):
    """An array's entry."""
    if array.dtype.kind in "OS":
        texts = [text_of(value) for value in array.ravel().tolist()]
        array = numpy.array(texts, dtype=object).reshape(array.shape)
    if array.size <= SAMPLES:
        return array.tolist()
    kind = {"O": "text", "U": "text"}.get(array.dtype.kind, array.dtype.name)
    bounds = block_bounds(array.shape[0])
    entry = {
        "type": kind,
        "shape": list(array.shape),
        "sha256": hashlib.sha256(canonical_bytes(array)).hexdigest(),
        "blocks": [f"{zlib.crc32(canonical_bytes(array[a:b])):08x}"
                   for a, b in zip(bounds[:-1], bounds[1:])],
        "values": array.ravel()[sample_positions(array.size)].tolist(),
    }
    if array.dtype.kind == "f":
        finite = array[numpy.isfinite(array)]
        entry["nan"] = int(numpy.isnan(array).sum())
        entry["mean"] = float(finite.mean()) if finite.size else None
        entry["mean_magnitude"] = float(abs(finite).mean()) if finite.size else None
    return entry


def is_left_out(key):
    return not LEFT_OUT.isdisjoint(re.split(r"[/.@]", key))


def add(records, key, entry):
    if not is_left_out(key):
        records[key] = entry


def rectangular(value):
    """A list as an array, if it holds numbers alone or texts alone in rows of one length."""
    def leaves(item):
        return [leaf for part in item for leaf in leaves(part)] if isinstance(item, list) else [item]
    kinds = {str if isinstance(leaf, str) else type(leaf) in (int, float) for leaf in leaves(value)}
    if kinds not in ({True}, {str}):
        return None
    try:
        array = numpy.array(value, dtype=object if kinds == {str} else None)
    except ValueError:
        return None
    return array if array.dtype.kind in "if" or kinds == {str} else None


def add_tree(records, key, value):
    """Adds nested mappings and lists, as JSON and YAML have them."""
    if isinstance(value, dict):
        for name, part in value.items():
            add_tree(records, f"{key}.{name}" if key[-1] not in "/@" else key + name, part)
    elif isinstance(value, list):
        array = rectangular(value) if value else None
        if not value:
            add(records, key, [])
        elif array is not None:
            add(records, key, record_array(array))
        else:
            for index, part in enumerate(value):
                add_tree(records, f"{key}.{index}", part)
    else:
        add(records, key, value)


def plain_number(text):
    """A YAML scalar as the number that it writes, else as it stands."""
    try:
        return int(text)
    except ValueError:
        pass
    try:
        number = float(text.replace(".inf", "inf"))
    except ValueError:
        return text
    return int(number) if number.is_integer() and abs(number) < 2**53 else number


def add_scenario(records, key, text):
    """Adds a scenario's keys; how its numbers and lists are written makes no difference."""
    def numbers(value):
        if isinstance(value, dict):
            return {name: numbers(part) for name, part in value.items()}
        if isinstance(value, list):
            return [numbers(part) for part in value]
        return plain_number(value)
    add_tree(records, key, numbers(yaml.load(text, Loader=yaml.BaseLoader)))


def add_attributes(records, key, item):
    for name, value in item.attrs.items():
        if name == "scenario":
            add_scenario(records, f"{key}@scenario/", text_of(value))
        elif isinstance(value, (numpy.ndarray, numpy.generic)):
            add(records, f"{key}@{name}", record_array(numpy.asarray(value)))
        else:
            add(records, f"{key}@{name}", text_of(value))


def add_hdf5(records, path):
    """Adds all datasets and attributes of an HDF5 file but those left out."""
    with h5py.File(path) as file:
        add_attributes(records, f"{path.name}/", file)

        def visit(name, item):
            key = f"{path.name}/{name}"
            add_attributes(records, key, item)
            if isinstance(item, h5py.Dataset):
                add(records, key, record_array(numpy.asarray(item[()])))
        file.visititems(visit)


def add_json(records, path):
    add_tree(records, f"{path.name}/", json.loads(path.read_text()))


def add_csv(records, path):
    """Adds a table's columns."""
    with path.open(newline="") as file:
        rows = list(csv.reader(file))
    for column, name in enumerate(rows[0]):
        cells = [plain_number(row[column]) for row in rows[1:]]
        # A missing number becomes NaN, so that the others stay numbers.
        if not any(isinstance(cell, str) and cell for cell in cells) and any(cells):
            cells = [math.nan if cell == "" else cell for cell in cells]
        elif any(isinstance(cell, str) for cell in cells):
            cells = [row[column] for row in rows[1:]]
        add_tree(records, f"{path.name}/{name}", cells)


def still_timings(path):
    """Sets all timings of a trace to 5 ms, so that pictures of it are the same every time."""
    with h5py.File(path, "r+") as file:
        for dataset in file["timing"].values():
            dataset[...] = 5.0


def read_picture(path):
    """A picture's pixels: height x width x 3, 0 to 255."""
    raw = subprocess.run(
        ["ffmpeg", "-loglevel", "error", "-i", path, "-f", "rawvideo", "-pix_fmt", "rgb24", "-"],
        check=True, stdout=subprocess.PIPE).stdout
    # Width and height are at the start of every PNG file.
    head = path.read_bytes()[16:24]
    width, height = int.from_bytes(head[:4], "big"), int.from_bytes(head[4:], "big")
    return numpy.frombuffer(raw, dtype=numpy.uint8).reshape(height, width, 3)


def write_records(path, records):
    path.write_text("".join(f"{key} = {json.dumps(entry, ensure_ascii=False)}\n"
                            for key, entry in sorted(records.items())))


def read_records(path):
    pairs = (line.split(" = ", 1) for line in path.read_text().splitlines())
    return {key: json.loads(entry) for key, entry in pairs}
