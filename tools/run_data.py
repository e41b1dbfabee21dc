"""Reads what a run leaves in its folder, for the plots. Every error is one sentence on standard
error and exit status 1."""

import csv
import sys
import tomllib
from pathlib import Path

import h5py
import numpy

# What the axes say of a quantity: name and unit. Quantities that share both share a panel.
LABELS = {
    "temperature": ("temperature", "K"),
    "mean_temperature": ("temperature", "K"),
    "max_temperature": ("temperature", "K"),
    "min_temperature": ("temperature", "K"),
    "velocity": ("velocity", "m/s"),
    "velocity_x": ("horizontal velocity", "m/s"),
    "velocity_y": ("vertical velocity", "m/s"),
    "speed": ("speed", "m/s"),
    "max_speed": ("largest speed", "m/s"),
    "sound_speed": ("numerical speed of sound", "m/s"),
    "nusselt": ("Nusselt number", ""),
    "mass": ("mass", "kg/m"),
    "area": ("area", "m²"),
    "pressure": ("pressure", "Pa"),
    "displacement_x": ("horizontal displacement", "m"),
    "displacement_y": ("vertical displacement", "m"),
    "stress_xx": ("stress xx", "Pa"),
    "stress_yy": ("stress yy", "Pa"),
    "stress_xy": ("stress xy", "Pa"),
    "stress_zz": ("stress zz", "Pa"),
    "von_mises": ("von Mises stress", "Pa"),
    "force_x": ("horizontal force", "N/m"),
    "force_y": ("vertical force", "N/m"),
    "heat": ("heat held", "J/m"),
    "heat_received": ("heat through the interface", "J/m"),
    "heat_from_walls": ("heat through the walls", "J/m"),
    "heat_flow": ("heat flow through the wall", "W/m"),
    "kinetic_energy": ("kinetic energy", "J/m"),
    "strain_energy": ("strain energy", "J/m"),
}

STYLE = {
    "figure.dpi": 150,
    "font.size": 9,
    "axes.titlesize": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "0.9",
    "grid.linewidth": 0.6,
    "lines.linewidth": 1.4,
    "legend.frameon": False,
    "legend.fontsize": 8,
}


def fail(sentence):
    sys.exit(f"{Path(sys.argv[0]).name}: {sentence}")


def label(quantity):
    name, unit = LABELS.get(quantity, (quantity.replace("_", " "), ""))
    return f"{name} [{unit}]" if unit else name


def run_folder(name):
    folder = Path(name)
    if not folder.is_dir():
        fail(f"{folder} is not a folder; give the folder of a run, for example runs/hot_plate-...")
    return folder


def read_case(folder):
    """The case as it was run; an empty one if the folder holds none."""
    path = folder / "case.toml"
    if not path.exists():
        return {}
    try:
        return tomllib.loads(path.read_text())
    except tomllib.TOMLDecodeError as error:
        fail(f"{path} is not TOML: {error}")


def read_table(path):
    """A CSV file as {column: array}, in the file's order. Lines that begin with # are comments; an
    empty cell is not a number."""
    try:
        with open(path, newline="") as file:
            rows = [row for row in csv.reader(file) if row and not row[0].startswith("#")]
    except OSError as error:
        fail(f"cannot read {path}: {error.strerror}")
    if len(rows) < 2:
        fail(f"{path} holds no values")
    names, body = rows[0], rows[1:]
    # A run that was killed may leave half a line at the end.
    if len(body[-1]) < len(names):
        body.pop()
    try:
        values = [[float(cell) if cell else numpy.nan for cell in row] for row in body]
        table = numpy.array(values).reshape(len(body), len(names))
    except ValueError:
        fail(f"{path} holds something that is not a number, or rows of different lengths")
    return {name: table[:, i] for i, name in enumerate(names)}


class Series:
    """The frames of fluid.h5 or solid.h5."""

    def __init__(self, path):
        self.path = path
        try:
            # A run that still goes on may be read too; it holds no lock.
            self.file = h5py.File(path, "r")
        except OSError as error:
            fail(f"cannot read {path}: {error}")
        self.names = sorted(name for name in self.file if name.startswith("frame_"))
        if not self.names:
            fail(f"{path} holds no frame yet")
        try:
            self.times = numpy.array([self.file[name].attrs["time"] for name in self.names])
        except (KeyError, OSError):
            frames = f"{path.stem}_frames"
            fail(f"the frames of {path} cannot be read; {frames}, which holds them, must lie beside it")

    def nearest(self, time):
        """The frame at the time nearest to `time`; the last one if `time` is None."""
        index = -1 if time is None else int(numpy.argmin(abs(self.times - time)))
        return Frame(self.file[self.names[index]], self.times[index])


class Frame:
    def __init__(self, group, time):
        self.group = group
        self.time = time
        self.position = group["position"][:, :2]
        self.connectivity = group["connectivity"][()]

    def fields(self):
        """What field() takes: the names in the file, and the parts of its vectors."""
        names = []
        for name in self.group:
            if name in ("position", "connectivity"):
                continue
            names.append(name)
            if self.group[name].ndim == 2 and self.group[name].shape[1] == 3:
                names[-1:] = [f"{name}_x", f"{name}_y"] + ["speed"] * (name == "velocity")
        return names

    def field(self, name):
        """Values of a scalar field, of vector_x or vector_y, or speed; None if the frame has none."""
        if name not in self.fields():
            return None
        if name == "speed":
            return numpy.linalg.norm(self.group["velocity"][()], axis=1)
        if name in self.group:
            return self.group[name][()]
        vector, part = name.rsplit("_", 1)
        return self.group[vector][:, "xy".index(part)]


def open_series(folder):
    """The series of a run's fluid and of its solid; None for one that the run has not."""
    found = [
        Series(folder / name) if (folder / name).exists() else None
        for name in ("fluid.h5", "solid.h5")
    ]
    if found == [None, None]:
        fail(f"{folder} holds neither fluid.h5 nor solid.h5, so it is not the folder of a run")
    return found
