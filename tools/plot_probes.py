#!/usr/bin/python3
"""Draws the histories that a run recorded in probes.csv, with reference data over them.

    tools/plot_probes.py runs/hot_plate-... -o out.png

Which column of which reference file belongs to which probe is read from the checks of the run's
case.toml, or given as PROBE=FILE:COLUMN.
"""

import argparse
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from run_data import STYLE, fail, label, read_case, read_table, run_folder


def arguments():
    parser = argparse.ArgumentParser(
        description="Draws the histories of a run's probes, with reference data over them."
    )
    parser.add_argument("run", help="the run's folder")
    parser.add_argument("-o", "--output", default="probes.png", help="picture (default: %(default)s)")
    parser.add_argument("--probe", nargs="+", help="draw these probes only")
    parser.add_argument(
        "--reference",
        nargs="+",
        default=[],
        metavar="CSV",
        help="FILE, whose columns the case's checks name, or PROBE=FILE:COLUMN "
        "(default: every file that the checks name)",
    )
    parser.add_argument("--title", help="heading (default: the case's title)")
    return parser.parse_args()


def references(requests, case):
    """{probe: (times, values)} of the reference data asked for."""
    found = {}
    for request in requests:
        if "=" in request:
            probe, _, place = request.partition("=")
            path, _, column = place.rpartition(":")
            if not path:
                fail(f"{request} names no column; write PROBE=FILE:COLUMN")
            wanted = [(probe, column, "", 1.0)]
        else:
            path = request
            wanted = [
                (check["quantity"], check["column"], check.get("along", ""), check.get("scale", 1.0))
                for check in case.get("check", [])
                if check.get("column") and Path(check.get("reference", "")).name == Path(path).name
            ]
            if not wanted:
                fail(f"no check of the run's case.toml names {path}; write PROBE=FILE:COLUMN")
        table = read_table(path)
        for probe, column, along, scale in wanted:
            for name in filter(None, (column, along)):
                if name not in table:
                    fail(f"{path} has no column {name}; it has {', '.join(table)}")
            times = table[along] if along else next(iter(table.values()))
            found[probe] = (times, scale * table[column])
    return found


def named_histories(case, names):
    """The reference files of the drawn probes that the case's checks name and that are still there."""
    return {
        check["reference"]: None
        for check in case.get("check", [])
        if check.get("column") and check["quantity"] in names and Path(check["reference"]).is_file()
    }


def panels(names, case):
    """The probes by what their axis says: {axis label: [probe]}."""
    quantity = {probe["name"]: probe["quantity"] for probe in case.get("probe", [])}
    found = {}
    for name in names:
        found.setdefault(label(quantity.get(name, name)), []).append(name)
    return found


def draw(table, shown, reference, title, output):
    times = table["time"]
    columns = min(len(shown), 2)
    rows = -(-len(shown) // columns)
    figure, axes = plt.subplots(
        rows, columns, figsize=(4.2 * columns, 2.7 * rows), squeeze=False, layout="constrained"
    )
    for axis, (name, probes) in zip(axes.flat, shown.items()):
        for probe in probes:
            (line,) = axis.plot(times, table[probe], label=probe.replace("_", " "))
            if probe in reference:
                inside = reference[probe][0] <= times[-1] * (1 + 1e-9)
                axis.plot(
                    *(values[inside] for values in reference[probe]),
                    color="black",
                    linewidth=0.9,
                    linestyle=(0, (4, 3)),
                    zorder=line.get_zorder() + 1,
                )
        if any(probe in reference for probe in probes):
            axis.plot([], [], color="black", linewidth=0.9, linestyle=(0, (4, 3)), label="reference")
        axis.set_ylabel(name)
        axis.set_xlim(times[0], times[-1] if times[-1] > times[0] else times[0] + 1)
        axis.legend()
    for axis in axes.flat[len(shown) :]:
        axis.set_visible(False)
    for column in range(columns):
        axes.flat[[i for i in range(len(shown)) if i % columns == column][-1]].set_xlabel("time [s]")
    if title:
        figure.suptitle(title, fontsize=10)
    try:
        figure.savefig(output)
    except (OSError, ValueError) as error:
        fail(f"cannot write {output}: {error}")


def main():
    options = arguments()
    folder = run_folder(options.run)
    case = read_case(folder)
    table = read_table(folder / "probes.csv")
    names = options.probe or [name for name in table if name != "time"]
    for name in names:
        if name not in table:
            known = ", ".join(probe for probe in table if probe != "time")
            fail(f"the run has no probe {name}; it has {known}")
    if not names:
        fail(f"{folder / 'probes.csv'} holds no probe; give the case a [[probe]]")
    reference = references(options.reference or named_histories(case, names), case)
    plt.rcParams.update(STYLE)
    title = options.title if options.title is not None else case.get("title", "")
    draw(table, panels(names, case), reference, title, options.output)


main()
