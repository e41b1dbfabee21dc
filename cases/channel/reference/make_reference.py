#!/usr/bin/python3
"""Closed forms of the cases of this folder, by their Fourier series.

Channel of height 1 m, fluid at rest and cold; nu = 0.01, alpha = 0.02 m2/s, force G = 0.08 m/s2, k = 0.02 W/(m K), rho = 1:

    u = G y (1 - y) / (2 nu) - sum_odd n  4 G / (nu (n pi)^3)  exp(-nu (n pi)^2 t)  sin(n pi y)
    T = 1 - y - sum_n  2 / (n pi)  exp(-alpha (n pi)^2 t)  sin(n pi y)

and the floor's shear rho nu du/dy and flux -k dT/dy, term by term. Eddies in a wind (0.5, 0.25) m/s, k = 2 pi, nu = 0.01:

    u = 0.5 + exp(-2 k^2 nu t) sin k(x - 0.5 t) cos k(y - 0.25 t)

Terms are summed until they vanish in double precision at the first time told, 0.5 s. Writes profiles.csv, history.csv, eddies.csv.
"""

import pathlib

import numpy as np

nu, alpha, G, k_heat = 0.01, 0.02, 0.08, 0.02
n = np.arange(1, 400)
odd = n[::2]


def u(y, t):
    return G * y * (1 - y) / (2 * nu) - np.sum(
        4 * G / (nu * (odd * np.pi) ** 3) * np.exp(-nu * (odd * np.pi) ** 2 * t) * np.sin(odd * np.pi * y))


def shear(t):
    return G / 2 - np.sum(4 * G / (odd * np.pi) ** 2 * np.exp(-nu * (odd * np.pi) ** 2 * t))


def temperature(y, t):
    return 1 - y - np.sum(2 / (n * np.pi) * np.exp(-alpha * (n * np.pi) ** 2 * t) * np.sin(n * np.pi * y))


def flux(t):
    return k_heat * (1 + 2 * np.sum(np.exp(-alpha * (n * np.pi) ** 2 * t)))


def write(name, comment, header, rows):
    with open(pathlib.Path(__file__).parent / name, "w") as out:
        print(f"# {comment}", header, *(",".join(f"{value:.9g}" for value in row) for row in rows), sep="\n", file=out)


write("profiles.csv", "channel: velocity (m/s) and temperature (K) over the height; Fourier series, exact to the digits",
      "y,u_2s,u_10s,u_30s,T_2s,T_10s",
      [(y, u(y, 2), u(y, 10), u(y, 30), temperature(y, 2), temperature(y, 10)) for y in np.linspace(0, 1, 41)])
write("history.csv", "channel: velocity in the middle (m/s), shear (Pa) and flux (W/m2) at the floor; exact to the digits",
      "t,u_centre,shear_floor,flux_floor", [(t, u(0.5, t), shear(t), flux(t)) for t in np.arange(0.5, 30.01, 0.5)])
rate = 2 * (2 * np.pi) ** 2 * nu
write("eddies.csv", "eddies in a wind: kinetic energy (J/m) and velocity at (0, 0) (m/s); exact to the digits",
      "t,kinetic_energy,u_corner",
      [(t, 0.5 * (0.5**2 + 0.25**2) + 0.25 * np.exp(-2 * rate * t),
        0.5 + np.exp(-rate * t) * np.sin(-np.pi * t) * np.cos(-0.5 * np.pi * t)) for t in np.arange(0, 2.01, 0.05)])
