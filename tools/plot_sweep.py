#!/usr/bin/python3
"""Draws error against CPU seconds, both logarithmic, from the sweep.csv that `duet sweep` wrote.

    tools/plot_sweep.py runs/sweep-heated_cavity/sweep.csv --check nusselt_hot v_max -o out.png

One panel a check. The first varied key runs along each line; what else varied makes lines of its own.
"""

import argparse
import csv

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.ticker import LogLocator, NullFormatter

from run_data import STYLE, fail

ERROR = "error of "


def arguments():
    parser = argparse.ArgumentParser(
        description="Draws error against CPU seconds from tables of `duet sweep`."
    )
    parser.add_argument("table", nargs="+", help="sweep.csv of one sweep or several of one case")
    parser.add_argument("-o", "--output", default="sweep.png", help="picture (default: %(default)s)")
    parser.add_argument("--check", nargs="+", help="draw these checks only, by the start of their names")
    parser.add_argument("--title", help="heading")
    return parser.parse_args()


def read(path):
    """Rows that finished, the varied keys and the checks."""
    try:
        with open(path, newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
    except OSError as error:
        fail(f"cannot read {path}: {error.strerror}")
    if not rows or "revision" not in rows[0]:
        fail(f"{path} is no table of duet sweep")
    names = list(rows[0])
    checks = [name for name in names if name.startswith(ERROR)]
    finished = [row for row in rows if row["ended"] == "finished"]
    if not checks or not finished:
        fail(f"{path} holds no run that finished and was held against a check")
    keys = names[: names.index(checks[0])]
    for row in finished:
        others = [f"{key.split('.')[-1]} = {row[key]}" for key in keys[1:]]
        row["line"] = ", ".join(others) or "".join(keys[:1])
    return finished, keys, checks


def chosen(checks, wanted):
    if not wanted:
        return checks
    found = []
    for start in wanted:
        fitting = [check for check in checks if check[len(ERROR):].startswith(start)]
        if not fitting:
            fail(f"there is no check {start}; there is {', '.join(c[len(ERROR):] for c in checks)}")
        found += fitting
    return found


def cpu_seconds(row):
    return sum(float(row[name]) for name in row if name.startswith("cpu_seconds_"))


def short(value):
    """A number of many digits with four of them."""
    try:
        return f"{float(value):.4g}"
    except ValueError:
        return value


def lines(rows, keys, check):
    """{label: [(cpu, error, value of the first key)]}, each in the order of its cost."""
    out = {}
    for row in rows:
        if float(row[check] or 0) > 0:
            out.setdefault(row["line"], []).append((cpu_seconds(row), float(row[check]), short(row[keys[0]])))
    return {label: sorted(points) for label, points in out.items()}


def main():
    options = arguments()
    rows, keys, checks = [], [], []
    for path in options.table:
        more, keys, checks = read(path)
        rows += more
    if not keys:
        fail("nothing was varied; give duet sweep a list: --set fluid.spacing=[0.2, 0.1]")
    checks = chosen(checks, options.check)
    with plt.rc_context(STYLE):
        columns = min(len(checks), 4)
        rows_of_panels = -(-len(checks) // columns)
        figure, panels = plt.subplots(
            rows_of_panels, columns, figsize=(2.9 * columns, 2.7 * rows_of_panels + 0.5),
            squeeze=False, layout="constrained",
        )
        for panel, check in zip(panels.flat, checks):
            for label, points in lines(rows, keys, check).items():
                cost, error, value = zip(*points)
                panel.loglog(cost, error, "o-", label=label)
                for x, y, text in zip(cost, error, value):
                    panel.annotate(text, (x, y), textcoords="offset points", xytext=(4, 4), fontsize=7)
            panel.set_title(check[len(ERROR):], fontsize=9)
            panel.set_xlabel("CPU seconds")
            for axis, limits in ((panel.xaxis, panel.get_xlim()), (panel.yaxis, panel.get_ylim())):
                axis.set_major_locator(LogLocator(subs=(1, 2, 5) if limits[1] < 100 * limits[0] else (1,)))
                axis.set_major_formatter("{x:g}")
                axis.set_minor_formatter(NullFormatter())
        for panel in list(panels.flat)[len(checks):]:
            panel.axis("off")
        panels[0][0].set_ylabel("error")
        panels[0][0].legend(fontsize=8)
        if options.title:
            figure.suptitle(options.title)
        try:
            figure.savefig(options.output, dpi=110)
        except OSError as error:
            fail(f"cannot write {options.output}: {error.strerror}")


main()
