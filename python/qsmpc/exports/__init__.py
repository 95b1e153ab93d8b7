"""Episodes as files for third-party viewers, on one timeline: time since the drive's start."""

from __future__ import annotations

import importlib
import os
from types import ModuleType
from typing import TYPE_CHECKING, Union

from qsmpc._native import core
from qsmpc.scenarios import Path

if TYPE_CHECKING:
    from qsmpc.episodes import Episode


def _module(name: str, package: str, extra: str) -> ModuleType:
    """A module of this package. Raises `ModuleNotFoundError` if its ``package`` is missing."""
    try:
        return importlib.import_module(f"qsmpc.exports.{name}")
    except ModuleNotFoundError as error:
        if error.name is None or error.name.startswith("qsmpc"):
            raise
        raise ModuleNotFoundError(
            f"export_{extra} needs the package {package}: pip install 'qsmpc[{extra}]'",
            name=error.name,
        ) from None


def _checked(path: Path, ending: str) -> str:
    """Checks the extension, by which viewers recognise formats."""
    text = os.fspath(path)
    if not text.endswith(ending):
        raise ValueError(f"{text}: expected a path that ends in {ending}")
    return text


def export_rerun(trace: Union[Episode, Path], path: Path) -> None:
    """Writes an episode, or the one in a trace or folder, as a recording of Rerun (``.rrd``).

    The file is written completely or not at all. Needs the package rerun-sdk
    (``qsmpc[rerun]``). Raises `ValueError` on another extension, `InputError` on what is not a
    trace, and `IoError`.
    """
    target = _checked(path, ".rrd")
    rerun_file = _module("rerun_file", "rerun-sdk", "rerun")
    from qsmpc.exports.contents import Contents

    core.write_file(target, rerun_file.recording(Contents(trace)))


def export_mcap(trace: Union[Episode, Path], path: Path) -> None:
    """Writes an episode, or the one in a trace or folder, as MCAP with Foxglove's schemas in JSON.

    The file is written completely or not at all. Needs the package mcap (``qsmpc[mcap]``). Raises
    `ValueError` on another extension, `InputError` on what is not a trace, and `IoError`.
    """
    target = _checked(path, ".mcap")
    mcap_file = _module("mcap_file", "mcap", "mcap")
    from qsmpc.exports.contents import Contents

    core.write_file(target, mcap_file.recording(Contents(trace)))
