#!/usr/bin/python3
"""The smallest solid that takes part in a run: the outline of the scene's first body, at the body's
initial temperature, moving with its initial velocity whatever the fluid does to it.

It shows all a solid has to do. Give it to a run in the place of a real one, or start here to write one.
"""

import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
import duet  # noqa: E402


class MinimalSolid(duet.SolidSolver):
    name = "minimal_solid.py 1.0"

    def configure(self, configure, ready):
        # The scene holds every default: nothing is ever absent that has one.
        self.scene = configure.scene
        self.ledger = duet.v1.Ledger()
        body = self.scene.solid.body[0]
        self.temperature = duet.evaluate(body.initial_temperature)
        chains, start = [], duet.InterfaceMotion.empty()
        if self.scene.HasField("fluid"):
            position = self.outline(body)
            nodes = len(position)
            velocity = np.tile([body.initial_velocity.x.number, body.initial_velocity.y.number], (nodes, 1))
            temperature = np.full(nodes, self.temperature)
            chains = [duet.Chain(range(nodes), closed=True)]
            start = duet.InterfaceMotion(position, velocity, temperature)
        ready.stable_step = 0  # 0: any window will do
        ready.unknowns = len(start.temperature)
        ready.model.append(f"prescribed motion and temperature of body {body.name}")
        self.sample(ready.sample, 0)
        self.start = start
        return chains, start

    def advance(self, window, load, report):
        # One window under constant loads. Positions are where the nodes are at its end.
        self.book(window, load)
        self.time = window.time + window.length
        report.steps = 1
        report.ledger.CopyFrom(self.ledger)
        if window.sample:
            self.sample(report.sample, window.time + window.length)
        position = self.start.position + self.time * self.start.velocity
        return duet.InterfaceMotion(position, self.start.velocity, self.start.temperature)

    def save(self):
        # The whole state, as bytes in any form: how far the body moved, and what has been booked.
        return duet.v1.Report(time=self.time, ledger=self.ledger).SerializeToString()

    def restore(self, state):
        report = duet.v1.Report.FromString(state)
        self.time, self.ledger = report.time, report.ledger

    @staticmethod
    def outline(body):
        """Nodes counter-clockwise from the lower left corner, so that the fluid lies to the right."""
        corner = np.array([body.rectangle.corner.x, body.rectangle.corner.y])
        size = np.array([body.rectangle.width, body.rectangle.height])
        corners = corner + size * np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]])
        sides = []
        for a, b in zip(corners[:-1], corners[1:]):
            segments = max(1, round(np.linalg.norm(b - a) / body.element_size))
            sides.append(a + (b - a) * np.arange(segments)[:, None] / segments)
        return np.concatenate(sides)

    def book(self, window, load):
        """What came through the interface. The temperature is prescribed, so what arrives as heat
        leaves as a (negative) source, and the heat held stays what it was."""
        ledger, impulse = self.ledger, window.length * load.force
        ledger.heat_from_interface += window.length * load.heat_flow.sum()
        ledger.heat_from_sources = -ledger.heat_from_interface
        ledger.exchanged_heat += window.length * abs(load.heat_flow).sum()
        ledger.impulse_x += impulse[:, 0].sum()
        ledger.impulse_y += impulse[:, 1].sum()
        ledger.exchanged_impulse += abs(impulse).sum()
        ledger.work += (impulse * self.start.velocity).sum()

    def sample(self, samples, time):
        """The probes that the scene asks of the solid."""
        for probe in self.scene.probe:
            if probe.of != duet.v1.Probe.SOLID:
                continue
            known = {"temperature": self.temperature, "mean_temperature": self.temperature,
                     "heat_received": self.ledger.heat_from_interface}
            if probe.quantity not in known:
                raise duet.Error(duet.v1.Failed.SCENE,
                                 f"Probe '{probe.name}' asks for '{probe.quantity}'; this solid "
                                 f"knows {', '.join(known)}.")
            samples.add(probe=probe.name, time=time, value=[known[probe.quantity]])


if __name__ == "__main__":
    sys.exit(duet.participate(MinimalSolid()))
