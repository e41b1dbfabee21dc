#!/usr/bin/python3
"""Draws a field of a run at one or several times: the particles of fluid.h5 and the triangles of
solid.h5 in one colour scale.

    tools/plot_fields.py runs/hot_plate-... --field temperature --time 1 2.5 10 --arrows -o out.png
"""

import argparse

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.colors import CenteredNorm, Normalize
from matplotlib.patches import Polygon

from run_data import STYLE, fail, label, open_series, read_case, run_folder


def arguments():
    parser = argparse.ArgumentParser(
        description="Draws a field of a run: the fluid's particles and the solid's triangles."
    )
    parser.add_argument("run", help="the run's folder")
    parser.add_argument("-o", "--output", default="fields.png", help="picture (default: %(default)s)")
    parser.add_argument("--field", default="temperature", help="default: %(default)s")
    parser.add_argument(
        "--time",
        type=float,
        nargs="+",
        metavar="T",
        help="seconds; the nearest snapshot is drawn, a panel each (default: the last)",
    )
    parser.add_argument("--arrows", action="store_true", help="draw the fluid's velocity")
    parser.add_argument("--mesh", action="store_true", help="draw the solid's triangles")
    parser.add_argument(
        "--range", type=float, nargs=2, metavar=("LOW", "HIGH"), help="ends of the colour scale"
    )
    parser.add_argument("--title", help="heading (default: the case's title)")
    return parser.parse_args()


def colours(field, values, limits):
    """Colour map and scale: signed fields are centred on zero."""
    low, high = limits or (min(v.min() for v in values), max(v.max() for v in values))
    if field == "pressure" or field.endswith(("_x", "_y")):
        reach = max(abs(low), abs(high)) or 1.0
        return "RdBu_r", CenteredNorm(0, reach)
    name = "inferno" if field == "temperature" else "viridis"
    return name, Normalize(low, high if high > low else low + 1)


def particle_spacing(frame, case):
    spacing = case.get("fluid", {}).get("spacing")
    if spacing:
        return spacing
    width, height = numpy.ptp(frame.position, axis=0)
    return numpy.sqrt(max(width * height, 1e-300) / len(frame.position))


def outline(frame):
    """The edges that belong to one triangle only."""
    corners = frame.connectivity
    edges = numpy.sort(numpy.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]))
    once, count = numpy.unique(edges, axis=0, return_counts=True)
    return frame.position[once[count == 1]]


def draw_arrows(axis, frame, spacing):
    """Mean velocities over the squares of a grid, the longest as long as a square. Each panel has
    its own scale, stated in its corner."""
    velocity = numpy.column_stack([frame.field("velocity_x"), frame.field("velocity_y")])
    start = frame.position.min(axis=0)
    extent = numpy.ptp(frame.position, axis=0).max()
    side = max(extent / 24, spacing)
    key = numpy.floor((frame.position - start) / side).astype(int)
    _, cell, count = numpy.unique(key, axis=0, return_inverse=True, return_counts=True)

    def mean(values):
        sums = [numpy.bincount(cell, values[:, part], len(count)) for part in (0, 1)]
        return numpy.array(sums) / count

    u, v = mean(velocity)
    speed = numpy.hypot(u, v)
    fastest = speed.max()
    if fastest == 0:
        return
    x, y = mean(frame.position)
    drawn = speed > 0.04 * fastest  # shorter ones would be dots
    axis.quiver(
        x[drawn],
        y[drawn],
        u[drawn],
        v[drawn],
        angles="xy",
        scale_units="xy",
        scale=fastest / (1.3 * side),
        width=0.0032,
        headwidth=3.6,
        headlength=4.2,
        headaxislength=3.8,
        color="white",
        edgecolor="0.15",
        linewidth=0.25,
        zorder=1.5,
    )
    axis.set_title(f"longest arrow {fastest:.3g} m/s", loc="right", color="0.4", fontsize=7)


def draw_panel(axis, fluid, solid, options, case, colour):
    """Returns what the colour bar explains."""
    spacing = particle_spacing(fluid or solid, case)
    region = case.get("fluid", {}).get("region")
    colour_map, norm = colour
    shown = None
    if fluid is not None:
        values = fluid.field(options.field)
        # Discs wider than a lattice cell's diagonal leave no gaps between disordered particles.
        size = numpy.full(len(fluid.position), 1.75 * spacing)
        discs = EllipseCollection(
            size, size, numpy.zeros_like(size), units="xy", offsets=fluid.position,
            offset_transform=axis.transData, linewidth=0, zorder=1,
        )
        if values is None:
            discs.set_facecolor("0.92")
        else:
            discs.set(array=values, cmap=colour_map, norm=norm)
            shown = discs
        axis.add_collection(discs)
        if region:
            walls = Polygon(region, facecolor="none", edgecolor="0.1", linewidth=0.8, zorder=3)
            axis.add_patch(walls)
            discs.set_clip_path(walls)
    if solid is not None:
        values = solid.field(options.field)
        x, y = solid.position.T
        if values is None:
            axis.tripcolor(
                x, y, solid.connectivity, facecolors=numpy.zeros(len(solid.connectivity)),
                cmap="Greys", vmin=-1, vmax=3, zorder=2,
            )
        else:
            shown = axis.tripcolor(
                x, y, solid.connectivity, values, cmap=colour_map, norm=norm, shading="gouraud",
                zorder=2,
            )
        if options.mesh:
            axis.triplot(x, y, solid.connectivity, color="black", linewidth=0.15, alpha=0.6, zorder=3)
        axis.add_collection(LineCollection(outline(solid), colors="0.1", linewidths=0.8, zorder=3))
    if fluid is not None and options.arrows:
        draw_arrows(axis, fluid, spacing)

    points = numpy.concatenate([frame.position for frame in (fluid, solid) if frame is not None])
    if region:
        points, margin = numpy.concatenate([points, region]), 0
    else:
        margin = spacing / 2
    axis.set_xlim(points[:, 0].min() - margin, points[:, 0].max() + margin)
    axis.set_ylim(points[:, 1].min() - margin, points[:, 1].max() + margin)
    axis.set_aspect("equal")
    axis.grid(False)
    axis.spines[:].set_visible(not region)
    axis.set_title(f"t = {(fluid or solid).time:.4g} s", loc="left")
    axis.set_xlabel("x [m]")
    return shown


def draw(frames, options, case):
    fields = [frame.field(options.field) for pair in frames for frame in pair if frame is not None]
    fields = [values for values in fields if values is not None]
    if not fields:
        known = dict.fromkeys(
            name for frame in frames[0] if frame is not None for name in frame.fields()
        )
        fail(f"the run has no field {options.field}; it has {', '.join(known)}")
    colour = colours(options.field, fields, options.range)
    columns = min(len(frames), 3)
    rows = -(-len(frames) // columns)
    first = [frame.position for frame in frames[0] if frame is not None]
    width, height = numpy.ptp(numpy.concatenate(first), axis=0)
    tall = min(max(height / max(width, 1e-300), 0.2), 2.0)
    size = 5.2 if len(frames) == 1 else 3.6
    figure, axes = plt.subplots(
        rows, columns, figsize=(size * columns + 0.9, size * tall * rows + 0.7), squeeze=False,
        sharey=True, layout="constrained",
    )
    for axis, (fluid, solid) in zip(axes.flat, frames):
        shown = draw_panel(axis, fluid, solid, options, case, colour)
    for axis in axes.flat[len(frames) :]:
        axis.set_visible(False)
    for row in axes:
        row[0].set_ylabel("y [m]")
    figure.colorbar(shown, ax=axes, label=label(options.field), shrink=0.9, aspect=30, pad=0.015)
    title = options.title if options.title is not None else case.get("title", "")
    if title:
        figure.suptitle(title, fontsize=10)
    try:
        figure.savefig(options.output)
    except (OSError, ValueError) as error:
        fail(f"cannot write {options.output}: {error}")


def main():
    options = arguments()
    if options.range and options.range[0] >= options.range[1]:
        fail("--range wants the lower end first")
    folder = run_folder(options.run)
    fluid, solid = open_series(folder)
    if options.arrows and fluid is None:
        fail("--arrows draws the fluid's velocity, but the run has no fluid.h5")
    frames = [
        tuple(series and series.nearest(time) for series in (fluid, solid))
        for time in options.time or [None]
    ]
    plt.rcParams.update(STYLE)
    draw(frames, options, read_case(folder))


main()
