"""What the author of a solver implements, and the plain data it is given and gives.

Arrays are numpy float64: positions, velocities and forces [N][2], temperatures [N], heat flows [M],
for N interface nodes and M segments in the order of the chains. SI units, per metre of depth.
"""

import dataclasses

import numpy as np

from .messages import v1


class Error(Exception):
    """Ends the run: one sentence (what is wrong, and the remedy) reaches the orchestrator.

    `code` is one of v1.Failed.VERSION, SCENE, PEER, DIVERGED, INTERNAL.
    """

    def __init__(self, code, sentence):
        super().__init__(sentence)
        self.code = code


@dataclasses.dataclass
class Window:
    """One coupling window."""

    index: int = 0
    time: float = 0.0  # s, at its start
    length: float = 0.0  # s
    sample: bool = False  # fill report.sample at its end
    snapshot: bool = False  # write the fields at its end


@dataclasses.dataclass
class Chain:
    """Interface nodes; segment j runs from nodes[j] to nodes[j+1], the last one back to nodes[0] if
    closed. The fluid lies to the right of the direction of travel."""

    nodes: list
    closed: bool = False
    insulated: bool = False  # no heat passes: the heat flow there is zero

    def segments(self):
        return len(self.nodes) if self.closed else len(self.nodes) - 1


@dataclasses.dataclass
class InterfaceMotion:
    """State of the interface at one time."""

    position: np.ndarray  # [N][2] m
    velocity: np.ndarray  # [N][2] m/s
    temperature: np.ndarray  # [N] K
    time: float = 0.0  # s, set by the library

    @classmethod
    def empty(cls):
        """Of a scene without a solid."""
        return cls(np.zeros((0, 2)), np.zeros((0, 2)), np.zeros(0))


@dataclasses.dataclass
class InterfaceLoad:
    """Mean loads over one window."""

    force: np.ndarray  # [N][2] N/m, on the solid
    heat_flow: np.ndarray  # [M] W/m, into the solid: flux times the segment's length
    impulse: tuple = (0.0, 0.0)  # N s/m, sum of force times length, as the fluid booked it
    heat: float = 0.0  # J/m, sum of heat_flow times length, as the fluid booked it
    time: float = 0.0  # s, start of the window, set by the library
    length: float = 0.0  # s, set by the library
    impedance: float = 0.0  # Pa s/m, by which the fluid answers a velocity of the wall at once; 0: not told


class Solver:
    """Common to both sides. Any function may raise Error."""

    name = "a solver in Python"  # name and version, for the log

    def save(self):
        """The whole state at the end of the last window, as bytes."""
        raise Error(v1.Failed.INTERNAL, f"{self.name} cannot save its state.")

    def restore(self, state):
        """Back to what save() gave; going on gives the same bits as never having stopped."""
        raise Error(v1.Failed.INTERNAL, f"{self.name} cannot restore a state.")

    def finish(self):
        """The run is over: flush and close the files."""


class SolidSolver(Solver):
    def configure(self, configure, ready):
        """Build the model of configure.scene and fill `ready` (stable_step, unknowns, model, ledger
        and samples at the start). Return the list of chains and the InterfaceMotion at the start;
        [] and InterfaceMotion.empty() if the scene has no fluid."""
        raise NotImplementedError

    def advance(self, window, load, report):
        """Advance over one window under constant loads and fill `report` (steps, stable_step, ledger,
        samples if asked). Return the InterfaceMotion at its end."""
        raise NotImplementedError


class FluidSolver(Solver):
    def configure(self, configure, chains, start, ready):
        """Build the model of configure.scene round the interface and fill `ready`."""
        raise NotImplementedError

    def advance(self, window, start, end, report):
        """Advance over one window while the interface moves from `start` to `end`, and fill `report`.
        Return the InterfaceLoad. `end` is the solid's state if the solid advanced first, else a
        prediction: acceleration and rate of the temperature go on as in the window before."""
        raise NotImplementedError
