"""Display of episodes in notebooks."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from qsmpc.episodes import Episode

_SIZE = 320.0  # pixels


def _map(episode: Episode) -> str:
    """The drive in the plane as SVG; empty for a system without one."""
    scenario = episode.scenario
    x, y = scenario.model().position
    if x < 0 or y < 0:
        return ""
    path = episode.states[:, [x, y]]
    path = path[np.isfinite(path).all(axis=1)]
    low, high = (np.array([bound[x], bound[y]]) for bound in scenario.bounds)
    if path.size == 0:
        return ""
    low = np.where(np.isfinite(low), low, path.min(axis=0) - 1.0)
    high = np.where(np.isfinite(high), high, path.max(axis=0) + 1.0)
    scale = _SIZE / max(high - low)
    width, height = scale * (high - low)

    def place(point: np.ndarray) -> np.ndarray:
        return np.array([scale * (point[0] - low[0]), height - scale * (point[1] - low[1])])

    shapes = []
    for lower, upper in scenario.obstacles:
        a = place(np.clip([lower[x], upper[y]], low, high))
        b = place(np.clip([upper[x], lower[y]], low, high))
        shapes.append(
            f'<rect x="{a[0]:.1f}" y="{a[1]:.1f}" width="{b[0] - a[0]:.1f}" '
            f'height="{b[1] - a[1]:.1f}" fill="#888"/>'
        )
    for shape in scenario.shapes:
        corners = " ".join("{:.1f},{:.1f}".format(*place(corner)) for corner in shape.outline)
        shapes.append(f'<polygon points="{corners}" fill="#888"/>')
    target = place(scenario.target[[x, y]])
    shapes.append(
        f'<circle cx="{target[0]:.1f}" cy="{target[1]:.1f}" '
        f'r="{scale * scenario.target_radius:.1f}" fill="none" stroke="#2a7" stroke-width="2"/>'
    )
    points = " ".join("{:.1f},{:.1f}".format(*place(point)) for point in path)
    shapes.append(f'<polyline points="{points}" fill="none" stroke="#06c" stroke-width="2"/>')
    return (
        f'<svg width="{width:.0f}" height="{height:.0f}" role="img" aria-label="map of the drive" '
        f'style="border:1px solid #888">{"".join(shapes)}</svg>'
    )


def episode_html(episode: Episode) -> str:
    """A map of the drive beside its key numbers."""
    summary = episode.summary
    certificate = summary["certificate"]["next_step"]["max"]
    bound = f"≤ {certificate:.3g}" if not episode.scenario.no_bound else "no bound"
    rows = [
        ("outcome", episode.outcome),
        ("duration", f"{episode.duration:.1f} s, {episode.steps} periods"),
        ("least clearance", f"{summary['min_clearance']:.3f}"),
        ("closed-loop cost", f"{summary['cost']['closed_loop']:.4g}"),
        ("P(unsafe at next step)", bound),
    ]
    if episode.fault:
        rows.insert(1, ("fault", episode.fault))
    cells = "".join(
        f'<tr><th style="text-align:left">{escape(name)}</th>'
        f'<td style="text-align:left">{escape(value)}</td></tr>'
        for name, value in rows
    )
    title = escape(f"{episode.scenario.name}, seed {episode.seed}")
    return (
        f'<div style="display:flex;gap:1em;align-items:flex-start">{_map(episode)}'
        f"<table><caption>{title}</caption>{cells}</table></div>"
    )
