#!/usr/bin/python3
"""Errors of runs of this case against its reference, as a table and a picture.

    cases/half_space/plot_study.py PICTURE.png RUN=LABEL...

prints, for each run, the largest error away from the front (more than 0.3 s from its passage at
1 s) and the rms error at all times, in per cent of the largest value; and draws displacement and
stress beside the reference. All runs must be of the coupling C = 1.
"""
import csv
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

START = 1.0015238916


def columns(path):
    with open(path) as file:
        rows = [row for row in csv.reader(file) if row and not row[0].startswith("#")]
    values = np.array([[float(x) for x in row] for row in rows[1:]])
    return dict(zip((name.split()[0] for name in rows[0]), values.T))


reference = columns(pathlib.Path(__file__).parent / "reference" / "plate_C1.csv")
names = {"temperature": "temperature", "displacement": "displacement_x", "stress": "stress_xx"}
figure, axes = plt.subplots(1, 2, figsize=(11, 4))
print("| | " + " | ".join(f"{n}, away | {n}, rms" for n in names) + " |")
print("|" + "---|" * 7)
for argument in sys.argv[2:]:
    run, label = argument.split("=", 1)
    probes = columns(pathlib.Path(run) / "probes.csv")
    time = probes.pop(next(iter(probes)))
    line = f"| {label} "
    for name, column in names.items():
        exact = np.interp(time, reference["t"], reference[column])
        scale = np.abs(exact - (START if name == "temperature" else 0)).max() / 100
        error = np.abs(probes[name] - exact) / scale
        away = error[np.abs(time - 1) > 0.3].max()
        line += f"| {away:.2f} | {np.sqrt((error**2).mean()):.2f} "
    print(line + "|")
    for axis, name in zip(axes, ("displacement", "stress")):
        axis.plot(time, probes[name], label=label, linewidth=1)
for axis, name, title in zip(
    axes, ("displacement_x", "stress_xx"), ("displacement, m", "stress along x, Pa")
):
    axis.plot(reference["t"], reference[name], "k--", label="reference", linewidth=1)
    axis.set_xlabel("time, s")
    axis.set_ylabel(title)
    axis.legend()
figure.tight_layout()
figure.savefig(sys.argv[1], dpi=100)
