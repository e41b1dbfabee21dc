#!/usr/bin/python3
"""Writes a snapshot of a run's fluid as the CSV file that `fluid.initial_state` reads, so that another
run, finer for example, may start from it.

    tools/state_of_run.py runs/heated_cavity-... --time 12 -o cases/mine/start.csv
"""

import argparse

import numpy

from run_data import fail, open_series, run_folder


def main():
    parser = argparse.ArgumentParser(description="Writes a snapshot of a run's fluid as a CSV file.")
    parser.add_argument("run", help="the run's folder")
    parser.add_argument("-o", "--output", default="state.csv", help="file (default: %(default)s)")
    parser.add_argument("--time", type=float, help="seconds; the nearest snapshot (default: the last)")
    given = parser.parse_args()
    fluid = open_series(run_folder(given.run))[0]
    if fluid is None:
        fail(f"{given.run} holds no fluid")
    frame = fluid.nearest(given.time)
    names = ("temperature", "velocity_x", "velocity_y")
    table = numpy.column_stack([frame.position, *(frame.field(name) for name in names)])
    numpy.savetxt(
        given.output,
        table,
        fmt="%.9g",
        delimiter=",",
        comments="",
        header=f"# fluid of {given.run} at t = {frame.time:g} s\n"
        "x,y,temperature,velocity_x,velocity_y",
    )
    print(f"{len(table)} points at t = {frame.time:g} s in {given.output}")


if __name__ == "__main__":
    main()
