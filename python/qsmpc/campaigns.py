"""Many episodes: ``qsmpc campaign``, and stores of campaigns as arrays."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import NDArray

from qsmpc._native import core
from qsmpc.episodes import Episode, read
from qsmpc.scenarios import Path, Scenario, parse

Columns = dict[str, NDArray[Any]]


class Store:
    """What a campaign has driven so far. Each call sees the store's current state."""

    __slots__ = ("core",)

    def __init__(self, store: core.Store) -> None:
        self.core = store

    @property
    def folder(self) -> str:
        return self.core.folder

    @property
    def variants(self) -> list[dict[str, str]]:
        """``name``, ``scenario``, ``settings``, ``plant`` and ``scenario_text`` of each variant."""
        return self.core.variants

    def variant(self, variant: Union[int, str]) -> int:
        """The number of a variant, given its name or number. Raises `KeyError`."""
        names = [each["name"] for each in self.variants]
        if isinstance(variant, str):
            if variant not in names:
                raise KeyError(variant)
            return names.index(variant)
        if not 0 <= variant < len(names):
            raise KeyError(variant)
        return variant

    def scenario(self, variant: Union[int, str]) -> Scenario:
        """The resolved scenario of a variant."""
        return parse(self.variants[self.variant(variant)]["scenario_text"])

    def episodes(self) -> Columns:
        """A row for each episode, as columns: ``variant`` (its number), ``seed``, ``outcome``,
        ``steps``, ``time_to_target``, ``unsafe``, ``min_clearance``, ``cost``, ``next_step_max``,
        ``next_step_sum``, …

        ``pandas.DataFrame(store.episodes())`` makes a table of them.
        """
        return self.core.episodes()

    def periods(self, variant: Union[int, str]) -> Columns:
        """A row for each period of a variant: ``seed``, ``period``, ``certified``, ``unsafe``,
        ``ocp_ms``. Raises `KeyError`."""
        return self.core.periods(self.variant(variant))

    def episode(self, variant: Union[int, str], seed: int) -> Episode:
        """The trace of an episode. Raises `InputError` if the campaign did not keep it."""
        number = self.variant(variant)
        return read(os.path.join(self.folder, "episodes", str(number), str(seed)))

    def statistics(self) -> dict[str, Any]:
        """The content of ``campaign.json``, for the current state."""
        return json.loads(self.core.statistics_json())

    def status(self) -> dict[str, Any]:
        """How far it has come, and who is working on it."""
        return json.loads(self.core.status_json())

    def verify(self) -> None:
        """Compares every episode with its checksum. Raises `IoError`."""
        self.core.verify()

    def __repr__(self) -> str:
        status = self.status()
        return f"<qsmpc.Store {self.folder}: {status['done']} of {status['episodes']} episodes>"


def campaign(
    path_or_name: Path,
    out: Path,
    *,
    jobs: int = 0,
    update: bool = False,
    retry_faults: bool = False,
    on_progress: Optional[Callable[[int, int], None]] = None,
) -> Store:
    """Drives the episodes of a campaign that the folder ``out`` lacks, and writes the files of
    ``qsmpc campaign``.

    ``jobs``: simultaneous episodes; 0 for one per core. ``on_progress`` is called with the number
    of finished episodes and their total. Ctrl-C keeps finished episodes; the same call then
    continues. Raises `InputError` and `IoError`.
    """
    return Store(
        core.run_campaign(
            os.fspath(path_or_name), os.fspath(out), jobs, update, retry_faults, on_progress
        )
    )


def open_campaign(folder: Path) -> Store:
    """The store of a campaign, even while it is running. Raises `InputError` if there is none."""
    return Store(core.Store(os.fspath(folder)))


def campaigns() -> dict[str, str]:
    """The shipped campaigns, each with a one-line description."""
    return dict(core.campaigns())
