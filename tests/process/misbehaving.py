#!/usr/bin/python3
"""A participant that goes wrong on purpose: misbehaving.py ROLE HOW --connect ADDRESS

In its sixth window, or for some ways from the start, it does what HOW says, and leaves the time of it in
the file that DUET_TEST_STAMP names.
"""

import os
import pathlib
import signal
import sys
import time

import numpy as np
import zmq

PROTOCOL = pathlib.Path(__file__).resolve().parents[2] / "protocol"
sys.path[:0] = [str(PROTOCOL / "python"), str(PROTOCOL / "examples")]
import duet  # noqa: E402
import duet.participant as library  # noqa: E402
from minimal_fluid import MinimalFluid  # noqa: E402
from minimal_solid import MinimalSolid  # noqa: E402

ROLE, HOW = sys.argv[1:3]


def stamp():
    pathlib.Path(os.environ["DUET_TEST_STAMP"]).write_text(repr(time.time()))


def go_wrong(report):
    if HOW == "exit":
        stamp()
        os._exit(3)
    elif HOW == "leave":
        stamp()
        os._exit(0)
    elif HOW == "kill":
        stamp()
        os.kill(os.getpid(), signal.SIGKILL)
    elif HOW == "stop":
        stamp()
        os.kill(os.getpid(), signal.SIGSTOP)
    elif HOW == "raise":
        stamp()
        raise RuntimeError("something unforeseen")
    elif HOW == "miscount":
        stamp()
        report.ledger.heat_from_interface += 1


def wrong(base):
    class Wrong(base):
        def advance(self, window, *given):
            result = super().advance(window, *given)
            if window.index == 5:
                go_wrong(given[-1])
            return result

    return Wrong


class WrongData:
    """The data plane, with one message spoilt on the wire, behind the library's own checks."""

    def __init__(self, data):
        self._data = data

    def __getattr__(self, name):
        return getattr(self._data, name)

    def send(self, message):
        if HOW == "nan" and message.load.window == 5:
            stamp()
            message.load.force = np.full(len(message.load.force) // 8, np.nan).tobytes()
        self._data.send(message)


class GarbageData(WrongData):
    def send(self, message):
        if message.load.window == 5:
            stamp()
            self._data._pair.send(b"\xff\xfe garbage")
        else:
            self._data.send(message)


def spoil_data_plane():
    right = library._FluidSide.send
    spoilt = GarbageData if HOW == "data-garbage" else WrongData

    def send(self, window, codec, data):
        right(self, window, codec, spoilt(data))

    library._FluidSide.send = send


def spoil_control_plane():
    right = library._Participant._send_report

    def send_report(self, report):
        if self._window.index == 5:
            stamp()
            self._control.socket.send(b"\xff\xfe garbage")
        right(self, report)

    library._Participant._send_report = send_report


def stranger(first_words):
    """Connects by hand, says one thing, and waits to be thrown out."""
    context = zmq.Context()
    socket = context.socket(zmq.DEALER)
    socket.setsockopt(zmq.LINGER, 0)
    socket.connect(sys.argv[sys.argv.index("--connect") + 1])
    stamp()
    socket.send(first_words)
    time.sleep(60)


def main():
    role = {"solid": duet.v1.ROLE_SOLID, "fluid": duet.v1.ROLE_FLUID}[ROLE]
    if HOW == "never-connect":
        stamp()
        time.sleep(60)
    if HOW == "garbage":
        stranger(b"\xff\xfe garbage")
    if HOW == "version":
        hello = duet.v1.Hello(version=duet.v1.Version(major=99), role=role, solver="from the future")
        stranger(duet.v1.ToOrchestrator(hello=hello).SerializeToString())
    if HOW in ("nan", "data-garbage"):
        spoil_data_plane()
    if HOW == "control-garbage":
        spoil_control_plane()
    base = MinimalSolid if ROLE == "solid" else MinimalFluid
    sys.exit(duet.participate(wrong(base)(), sys.argv[3:]))


if __name__ == "__main__":
    main()
