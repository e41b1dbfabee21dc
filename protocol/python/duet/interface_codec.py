"""What travels over the data plane, with every check (the twin of interface_codec.cpp)."""

import math

import numpy as np

from .messages import v1
from .solver import Chain, Error, InterfaceLoad, InterfaceMotion

SOLID, FLUID = v1.ROLE_SOLID, v1.ROLE_FLUID
NAMES = {SOLID: "solid", FLUID: "fluid"}


class Codec:
    """Knows the run, and the size of the interface once the start has passed."""

    def __init__(self, run_id):
        self.run_id = run_id
        self.nodes = 0
        self.segments = 0

    def of_no_run(self):
        """For checkpoints: interface data of the same size that bear no run."""
        codec = Codec(0)
        codec.nodes, codec.segments = self.nodes, self.segments
        return codec

    def encode_start(self, chains, start):
        subject = _Subject(SOLID, "at the start", own=True)
        self.nodes = len(start.temperature)
        self.segments = _check_chains(subject, chains, self.nodes)
        message = self._motion(subject, start, window=0, time=0.0)
        message.motion.start = True
        for chain in chains:
            message.motion.chain.add(node=[int(n) for n in chain.nodes], closed=chain.closed,
                                     insulated=chain.insulated)
        return message

    def decode_start(self, message):
        subject = _Subject(SOLID, "at the start")
        motion = self._expect(subject, message, "motion", window=0)
        self.nodes = len(motion.temperature) // 8
        start = self._take_motion(subject, motion, time=0.0, start=True)
        chains = [Chain(list(chain.node), chain.closed, chain.insulated) for chain in motion.chain]
        self.segments = _check_chains(subject, chains, self.nodes)
        return chains, start

    def encode_motion(self, window, motion):
        subject = _Subject(SOLID, f"of window {window.index}", own=True)
        return self._motion(subject, motion, window.index, window.time + window.length)

    def decode_motion(self, window, message):
        subject = _Subject(SOLID, f"of window {window.index}")
        motion = self._expect(subject, message, "motion", window.index)
        return self._take_motion(subject, motion, window.time + window.length, start=False)

    def encode_load(self, window, load):
        subject = _Subject(FLUID, f"of window {window.index}", own=True)
        message = v1.ToPeer()
        out = message.load
        out.run_id, out.window = self.run_id, window.index
        out.time, out.length = window.time, window.length
        out.force = _put(subject, "force", load.force, (self.nodes, 2))
        out.heat_flow = _put(subject, "heat_flow", load.heat_flow, (self.segments,))
        out.impulse_x, out.impulse_y = (float(value) for value in load.impulse)
        out.heat = float(load.heat)
        out.impedance = float(load.impedance)
        _check_totals(subject, out)
        return message

    def decode_load(self, window, message):
        subject = _Subject(FLUID, f"of window {window.index}")
        load = self._expect(subject, message, "load", window.index)
        if not _same_time(load.time, window.time) or load.length != window.length:
            subject.refuse(f"it covers {load.length} s from {load.time} s where {window.length} s "
                           f"from {window.time} s are due")
        _check_totals(subject, load)
        return InterfaceLoad(_take(subject, "force", load.force, (self.nodes, 2)),
                             _take(subject, "heat_flow", load.heat_flow, (self.segments,)),
                             (load.impulse_x, load.impulse_y), load.heat, load.time, load.length,
                             load.impedance)

    def _motion(self, subject, motion, window, time):
        message = v1.ToPeer()
        out = message.motion
        out.run_id, out.window, out.time = self.run_id, window, time
        out.position = _put(subject, "position", motion.position, (self.nodes, 2))
        out.velocity = _put(subject, "velocity", motion.velocity, (self.nodes, 2))
        out.temperature = _put(subject, "temperature", motion.temperature, (self.nodes,))
        return message

    def _take_motion(self, subject, motion, time, start):
        if motion.start != start:
            subject.refuse("out of turn: the mark of the start is wrong")
        if not _same_time(motion.time, time):
            subject.refuse(f"its time is {motion.time} s where {time} s is due")
        return InterfaceMotion(_take(subject, "position", motion.position, (self.nodes, 2)),
                               _take(subject, "velocity", motion.velocity, (self.nodes, 2)),
                               _take(subject, "temperature", motion.temperature, (self.nodes,)),
                               time)

    def _expect(self, subject, message, kind, window):
        came = message.WhichOneof("message")
        if came == "failed":
            raise Error(v1.Failed.PEER, f"The {NAMES[subject.sender]} failed: {message.failed.text}")
        if came != kind:
            subject.refuse("a message of another kind came in its turn")
        content = getattr(message, kind)
        if content.run_id != self.run_id:
            subject.refuse(f"it belongs to run {content.run_id}, this is run {self.run_id}")
        if (content.window, content.iteration) != (window, 0):
            subject.refuse(f"out of turn: it is marked window {content.window}, "
                           f"iteration {content.iteration}")
        return content


def check_report(report, window):
    """Numbers of our own solver that are not finite do not leave it."""
    figures = [("stable_step", report.stable_step)]
    figures += [(field.name, value) for field, value in report.ledger.ListFields()
                if field.cpp_type == field.CPPTYPE_DOUBLE]
    figures += [(f"figure '{name}'", value) for name, value in report.ledger.figure.items()]
    figures += [(f"probe '{sample.probe}'", value) for sample in report.sample
                for value in sample.value]
    for name, value in figures:
        if not math.isfinite(value):
            raise Error(v1.Failed.DIVERGED,
                        f"In the report of window {window.index}, {name} is {value}, not a finite "
                        "number; the solution diverged: shorten the window or refine.")


def _same_time(a, b):
    """Both sides work the times of windows out of the lease and may round the last bits otherwise."""
    return abs(a - b) <= 1e-12 * abs(b)


class _Subject:
    """Whose data are looked at, and which: the first half of every sentence."""

    def __init__(self, sender, when, own=False):
        self.sender, self.when, self.own = sender, when, own

    def text(self):
        what = "load" if self.sender == FLUID else "motion"
        return f"The {NAMES[self.sender]}'s {what} {self.when}"

    def refuse(self, what):
        if self.own:
            raise Error(v1.Failed.INTERNAL, f"{self.text()}: {what}; this solver must mend it.")
        raise Error(v1.Failed.PEER, f"{self.text()}: {what}; the {NAMES[self.sender]} broke the "
                                    "protocol and must mend it.")

    def refuse_number(self, field, value):
        what = f"{self.text()}: {field} is {value}, not a finite number; "
        if self.own:
            raise Error(v1.Failed.DIVERGED,
                        what + "the solution diverged: shorten the window or refine.")
        raise Error(v1.Failed.PEER,
                    what + f"the {NAMES[self.sender]} must not send it: see its output.")


def _check_finite(subject, field, values):
    bad = np.argwhere(~np.isfinite(values))
    if len(bad):
        place = f"[{bad[0][0]}]" + ("" if values.ndim == 1 else (".x", ".y")[bad[0][1]])
        subject.refuse_number(field + place, values[tuple(bad[0])])


def _check_totals(subject, load):
    for field in ("impulse_x", "impulse_y", "heat", "impedance"):
        if not math.isfinite(getattr(load, field)):
            subject.refuse_number(field, getattr(load, field))
    if load.impedance < 0:
        subject.refuse(f"impedance is {load.impedance} Pa s/m where no negative number can stand")


def _put(subject, field, values, shape):
    values = np.ascontiguousarray(values, dtype="<f8")
    if values.shape != shape:
        subject.refuse(f"{field} has the shape {values.shape} where {shape} is due")
    _check_finite(subject, field, values)
    return values.tobytes()


def _take(subject, field, data, shape):
    due = 8 * math.prod(shape)
    if len(data) != due:
        subject.refuse(f"{field} holds {len(data)} bytes where {due} are due")
    values = np.frombuffer(data, dtype="<f8").reshape(shape)
    _check_finite(subject, field, values)
    return values


def _check_chains(subject, chains, nodes):
    """Every node belongs to one place of one chain; returns the number of segments."""
    seen = set()
    for c, chain in enumerate(chains):
        least = 3 if chain.closed else 2
        if len(chain.nodes) < least:
            subject.refuse(f"chain[{c}] has {len(chain.nodes)} nodes and needs {least}")
        for node in chain.nodes:
            if not 0 <= node < nodes:
                subject.refuse(f"chain[{c}] names node {node} of {nodes}")
            if node in seen:
                subject.refuse(f"chain[{c}] names node {node} a second time")
            seen.add(node)
    if len(seen) != nodes:
        subject.refuse(f"{nodes - len(seen)} nodes belong to no chain")
    return sum(chain.segments() for chain in chains)
