"""Plots with Matplotlib, if it is installed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from qsmpc.episodes import Episode

_PARTICLE_STAGES = 4  # of the last plan, evenly spaced


def plot_episode(episode: Episode, axes: Any = None) -> Any:
    """The drive in the plane with obstacles, target and, if there are any, the particles of the
    last plan; for a system without a plane, its states over time."""
    import matplotlib.pyplot as pyplot
    from matplotlib.patches import Circle, Polygon, Rectangle

    if axes is None:
        axes = pyplot.subplots(layout="constrained")[1]
    scenario = episode.scenario
    model = scenario.model()
    x, y = model.position
    states = episode.states
    if x < 0 or y < 0:
        axes.plot(episode.times, states, label=[f"{name} ({unit})" for name, unit in model.states])
        axes.set_xlabel("time (s)")
        axes.legend()
        return axes
    limits = [(states[:, i].min(), states[:, i].max()) for i in (x, y)]
    for lower, upper in scenario.obstacles:
        corner = (lower[x], lower[y])
        axes.add_patch(Rectangle(corner, upper[x] - lower[x], upper[y] - lower[y], color="0.6"))
    for shape in scenario.shapes:
        axes.add_patch(Polygon(shape.outline, color="0.6"))
    bounds = scenario.bounds
    for axis, i, (least, most) in zip("xy", (x, y), limits):
        low, high = bounds[0][i], bounds[1][i]
        getattr(axes, f"set_{axis}lim")(
            low if np.isfinite(low) else least - 1.0, high if np.isfinite(high) else most + 1.0
        )
    target = scenario.target
    axes.add_patch(Circle((target[x], target[y]), scenario.target_radius, fill=False, color="C2"))
    axes.plot(states[:, x], states[:, y], color="C0")
    if episode.has_particles and episode.steps > 0:
        for stage in np.linspace(1, episode.stages, _PARTICLE_STAGES, dtype=int):
            points, weights = episode.particles(episode.steps - 1, int(stage))
            axes.scatter(points[:, x], points[:, y], s=400.0 * weights, color="C1", alpha=0.4)
    axes.set_aspect("equal")
    for axis, i in zip("xy", (x, y)):
        getattr(axes, f"set_{axis}label")("{} ({})".format(*model.states[i]))
    axes.set_title(f"{scenario.name}, seed {episode.seed}: {episode.outcome}")
    return axes
