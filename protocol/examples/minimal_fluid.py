#!/usr/bin/python3
"""The smallest fluid that takes part in a run: it loads the interface with a constant traction and a
constant heat flux, whatever the solid does.

It shows all a fluid has to do. Give it to a run in the place of a real one, or start here to write one.
"""

import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
import duet  # noqa: E402

HEAT_FLUX = 100.0  # W/m2, into the solid
TRACTION = np.array([0.3, -0.2])  # Pa, on the solid


class MinimalFluid(duet.FluidSolver):
    name = "minimal_fluid.py 1.0"

    def configure(self, configure, chains, start, ready):
        # The interface comes first: its chains of nodes, and where they are at the start.
        self.scene = configure.scene
        self.temperature = duet.evaluate(self.scene.fluid.initial_temperature)
        self.ledger = duet.v1.Ledger()
        # Segment j runs from node first[j] to node second[j].
        self.first, self.second = [], []
        for chain in chains:
            nodes = list(chain.nodes)
            self.first += nodes if chain.closed else nodes[:-1]
            self.second += nodes[1:] + nodes[:1] if chain.closed else nodes[1:]
        ready.stable_step = 0  # 0: any window will do
        ready.model.append("prescribed traction and heat flux on the interface")
        self.sample(ready.sample, 0)

    def advance(self, window, start, end, report):
        # One window, while the interface moves from `start` to `end`. The answer: a force on each node
        # and a heat flow into each segment, means over the window.
        sides = end.position[self.second] - end.position[self.first]
        length = np.hypot(sides[:, 0], sides[:, 1])
        force = np.zeros_like(end.position)
        # Half of a segment's force goes to each of its ends.
        np.add.at(force, self.first, TRACTION * length[:, None] / 2)
        np.add.at(force, self.second, TRACTION * length[:, None] / 2)
        load = duet.InterfaceLoad(force, HEAT_FLUX * length)
        self.book(window, start, load)
        report.steps = 1
        report.ledger.CopyFrom(self.ledger)
        if window.sample:
            self.sample(report.sample, window.time + window.length)
        return load

    def save(self):
        # The whole state: here only what has been booked (the library keeps the interface).
        return self.ledger.SerializeToString()

    def restore(self, state):
        self.ledger = duet.v1.Ledger.FromString(state)

    def book(self, window, motion, load):
        """What is sent, booked with the sign of what the fluid receives; the totals go with the load
        so that the other side can compare. The heat that leaves is drawn from a source, and the heat
        held stays what it was."""
        ledger, impulse = self.ledger, window.length * load.force
        load.heat = window.length * load.heat_flow.sum()
        load.impulse = tuple(impulse.sum(axis=0))
        ledger.heat_from_interface -= load.heat
        ledger.heat_from_sources = -ledger.heat_from_interface
        ledger.exchanged_heat += window.length * abs(load.heat_flow).sum()
        ledger.impulse_x -= load.impulse[0]
        ledger.impulse_y -= load.impulse[1]
        ledger.exchanged_impulse += abs(impulse).sum()
        ledger.work -= (impulse * motion.velocity).sum()

    def sample(self, samples, time):
        """The probes that the scene asks of the fluid."""
        for probe in self.scene.probe:
            if probe.of != duet.v1.Probe.FLUID:
                continue
            if probe.quantity not in ("temperature", "mean_temperature"):
                raise duet.Error(duet.v1.Failed.SCENE,
                                 f"Probe '{probe.name}' asks for '{probe.quantity}'; this fluid "
                                 "knows temperature and mean_temperature.")
            samples.add(probe=probe.name, time=time, value=[self.temperature])


if __name__ == "__main__":
    sys.exit(duet.participate(MinimalFluid()))
