#!/usr/bin/python3
"""Writes plate_C*.csv: what a probe at (1, 5) of the plate should record, in SI units.

Half-space plus, where the coupling is not zero, what the plate's free edges add (0 for C = 0),
made dimensional with the material of the case (paper, eqs 58 to 61).
"""
import math
import pathlib

import numpy as np

folder = pathlib.Path(__file__).parent
young, poisson, expansion, rise = 0.743, 0.3, 0.538, 1e-4  # rho = c = k = 1
lame = young * poisson / ((1 + poisson) * (1 - 2 * poisson))
shear = young / (2 * (1 + poisson))
modulus = lame + 2 * shear
beta = expansion * (3 * lame + 2 * shear)
speed = math.sqrt(modulus)
length = 1 / speed

for name, coupling in (("C0", 0.0), ("C036", 0.36), ("C1", 1.0)):
    start = coupling * modulus / beta**2  # T0, eq 62
    t, theta, u, sigma = np.loadtxt(folder / f"half_space_{name}.csv", delimiter=",", skiprows=2).T
    if coupling > 0:
        edges = np.loadtxt(folder / f"plate_minus_half_space_{name}.csv", delimiter=",", skiprows=2)
        time = np.append(0, edges[:, 0])
        theta, u, sigma = (
            value + np.interp(t, time, np.append(0, edges[:, 1 + i]))
            for i, value in enumerate((theta, u, sigma))
        )
    table = np.column_stack(
        (
            t * length / speed,
            start + rise * theta,
            u * length * beta * rise / modulus,
            sigma * beta * rise,
        )
    )
    with open(folder / f"plate_{name}.csv", "w") as file:
        file.write(f"# Plate at (1, 5), C = {coupling}, T0 = {start:.9f} K; by make_reference.py\n")
        file.write("t,temperature,displacement_x,stress_xx\n")
        np.savetxt(file, table, delimiter=",", fmt="%.10e")
