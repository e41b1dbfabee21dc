#!/usr/bin/python3
"""Frequency and decay of the swing of a run, beside the same fit to the reference: fit.py RUN."""

import csv
import pathlib
import sys

import numpy as np
from scipy.optimize import curve_fit

AFTER = 0.7  # s, the first period


def column(path, name):
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    at = rows[0].index(name)
    return np.array([[float(row[0]), float(row[at])] for row in rows[1:]]).T


def fit(time, swing):
    late = time > AFTER
    wave = lambda t, a, d, w, p: a * np.exp(-d * t) * np.cos(w * t + p)
    found, _ = curve_fit(wave, time[late], swing[late] / np.abs(swing).max(), p0=[2, 2.4, 9, 0], maxfev=20000)
    return found[2], found[1]


if len(sys.argv) != 2 or not (pathlib.Path(sys.argv[1]) / "probes.csv").is_file():
    sys.exit("give the folder of a run of this case, which holds probes.csv: fit.py RUN")
run = fit(*column(pathlib.Path(sys.argv[1]) / "probes.csv", "swing"))
reference = fit(*column(pathlib.Path(__file__).parent / "reference" / "swing.csv", "rim[m]"))
for name, unit, value, exact in zip(("frequency", "decay"), ("rad/s", "1/s"), run, reference):
    print(f"{name:9}  {value:.4f} {unit}, reference {exact:.4f}: {100 * (value / exact - 1):+.2f} %")
