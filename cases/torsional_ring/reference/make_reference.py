#!/usr/bin/python3
"""Swing of the torsional ring's rim in time: the tangential motion as a function of the radius alone.

Tangential velocity v(r, t), displacement w of the ring (dw/dt = v), shear stress tau:
    rho dv/dt = 1/r^2 d/dr (r^2 tau),   ring: tau = G (dw/dr - w/r),   fluid: tau = mu (dv/dr - v/r),
    v = 0 at the hub and at the wall.
Linear finite elements in r, implicit midpoint rule; the grid and the step halve once more to tell the error.
Frequency and decay of the last swings are compared with the determinant of Bessel functions.
"""

import csv

import numpy as np
import scipy.linalg as linalg
import scipy.optimize as optimize
import scipy.special as special

HUB, RIM, WALL = 0.2, 0.3, 0.5  # m
RHO, G, MU = 1000.0, 1000.0, 10.0  # kg/m3, Pa, Pa s
SPEED = 0.005  # m/s, of the rim at the start


def swing(per_metre, step, end):
    """Times and displacement of the rim."""
    r = np.linspace(HUB, WALL, round((WALL - HUB) * per_metre) + 1)
    rim = round((RIM - HUB) * per_metre)
    n = len(r)
    mass, elastic, viscous = np.zeros((n, n)), np.zeros((n, n)), np.zeros((n, n))
    momentum = np.zeros(n)  # of the start, whose velocity jumps at the rim
    for e in range(n - 1):
        h = r[e + 1] - r[e]
        at = np.ix_([e, e + 1], [e, e + 1])
        for x in (-1 / np.sqrt(3), 1 / np.sqrt(3)):
            s = 0.5 * (1 + x)
            here = r[e] + s * h
            shape = np.array([1 - s, s])
            shear = np.array([-1, 1]) / h - shape / here
            if e < rim:
                momentum[[e, e + 1]] += RHO * SPEED * (here - HUB) / (RIM - HUB) * shape * here * h / 2
            mass[at] += RHO * np.outer(shape, shape) * here * h / 2
            (elastic if e < rim else viscous)[at] += (
                (G if e < rim else MU) * np.outer(shear, shear) * here * h / 2
            )
    free = slice(1, n - 1)
    mass, elastic, viscous = (m[free, free] for m in (mass, elastic, viscous))
    v = linalg.solve(mass, momentum[free])
    w = np.zeros(n - 2)
    factor = linalg.lu_factor(mass + 0.5 * step * viscous + 0.25 * step**2 * elastic)
    times, rims = [0.0], [0.0]
    for k in range(round(end / step)):
        middle = linalg.lu_solve(factor, mass @ v - 0.5 * step * (elastic @ w))
        w = w + step * middle
        v = 2 * middle - v
        times.append((k + 1) * step)
        rims.append(w[rim - 1])
    return np.array(times), np.array(rims)


def root():
    """s = -decay + i omega of the ring's slowest swing."""

    def determinant(parts):
        s = complex(*parts)
        k = np.sqrt(-RHO * s * s / G + 0j)  # ring: Bessel functions of k r
        q = np.sqrt(-RHO * s / MU + 0j)  # fluid: of q r
        j, y = special.jv, special.yv
        # w = j(k r) y(k hub) - ... is zero at the hub; v likewise at the wall
        w = lambda x: j(1, k * x) * y(1, k * HUB) - y(1, k * x) * j(1, k * HUB)
        v = lambda x: j(1, q * x) * y(1, q * WALL) - y(1, q * x) * j(1, q * WALL)
        shear = lambda f, x: (f(x * (1 + 1e-5)) - f(x * (1 - 1e-5))) / (2e-5 * x) - f(x) / x
        value = G * shear(w, RIM) * v(RIM) - MU * shear(v, RIM) * s * w(RIM)
        return [value.real, value.imag]

    return optimize.fsolve(determinant, [-2.4, 9.0])


def main():
    fine, coarse = swing(4000, 0.00025, 1.6), swing(2000, 0.0005, 1.6)
    step = 16  # rows of 0.004 s
    error = np.abs(fine[1][::2] - coarse[1]).max()
    print(f"largest change by halving: {error:.2e} m of {np.abs(fine[1]).max():.3e} m")

    late = fine[0] > 0.7
    wave = lambda t, a, d, w, p: a * np.exp(-d * t) * np.cos(w * t + p)
    fit, _ = optimize.curve_fit(
        wave, fine[0][late], fine[1][late] * 1e3, p0=[0.5, 2.4, 9.0, 0.0], maxfev=20000
    )
    print(f"fit after 0.7 s: omega {fit[2]:.5f}, decay {fit[1]:.5f}")
    decay, omega = root()
    print(f"determinant:     omega {omega:.5f}, decay {-decay:.5f}")

    with open("swing.csv", "w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["t[s]", "rim[m]"])
        for t, w in zip(fine[0][::step], fine[1][::step]):
            rows.writerow([f"{t:.3f}", f"{w:.6e}"])


main()
