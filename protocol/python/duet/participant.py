"""Serve one run: handshake, leases, turns, reports (the twin of participant.cpp and side.cpp)."""

import dataclasses
import math
import os
import resource
import sys
import time

import numpy as np
import zmq
from google.protobuf.message import DecodeError

from .interface_codec import FLUID, NAMES, SOLID, Codec, check_report
from .messages import v1
from .sockets import Aborted, ControlLink, DataPlane
from .solver import Error, FluidSolver, InterfaceLoad, InterfaceMotion, Window

VERSION = v1.Version(major=2, minor=1)

# What each role does in a window, in order (the table of schedule.hpp).
RECEIVE, ADVANCE, SEND = "receive", "advance", "send"
SCHEDULE = {
    v1.Coupling.FLUID_FIRST: {SOLID: (RECEIVE, ADVANCE, SEND), FLUID: (ADVANCE, SEND, RECEIVE)},
    v1.Coupling.SOLID_FIRST: {SOLID: (ADVANCE, SEND, RECEIVE), FLUID: (RECEIVE, ADVANCE, SEND)},
    v1.Coupling.PARALLEL: {SOLID: (ADVANCE, SEND, RECEIVE), FLUID: (ADVANCE, SEND, RECEIVE)},
}


def participate(solver, arguments=None, connect_timeout=10):
    """Serve one run with `--connect ADDRESS` from the command line; return the exit status."""
    arguments = sys.argv[1:] if arguments is None else arguments
    if len(arguments) == 1 and arguments[0].startswith("--connect="):
        arguments = arguments[0].split("=", 1)
    if len(arguments) != 2 or arguments[0] != "--connect":
        print(f"Usage: {sys.argv[0]} --connect ADDRESS", file=sys.stderr)
        return 0 if arguments == ["--help"] else 2
    context = zmq.Context()
    participant = None
    try:
        participant = _Participant(context, solver, arguments[1], connect_timeout)
        participant.serve()
        return 0
    except Aborted as aborted:
        sentence = str(aborted)
    except Error as error:
        sentence = str(error)
        if participant is not None:
            participant.fail(error.code, sentence)
    except Exception as error:  # a fault of the solver: the orchestrator must hear of it
        sentence = f"{type(error).__name__}: {error}"
        if participant is not None:
            participant.fail(v1.Failed.INTERNAL, sentence)
    finally:
        if participant is not None:
            participant.close()
        context.term()
    print(f"{solver.name}: {sentence}", file=sys.stderr)
    return 1


class _SolidSide:
    role, peer = SOLID, "fluid"

    def __init__(self, solid):
        self._solid = solid
        self._motion = InterfaceMotion.empty()
        self._load = None

    def configure(self, configure, codec, data, ready):
        chains, self._motion = self._solid.configure(configure, ready)
        if data is not None:
            data.send(codec.encode_start(chains, self._motion))
        self._load = InterfaceLoad(np.zeros((codec.nodes, 2)), np.zeros(codec.segments))

    def receive(self, window, codec, data):
        self._load = codec.decode_load(window, data.receive())

    def advance(self, window, report):
        self._motion = self._solid.advance(window, self._over(window), report)
        self._motion.time = window.time + window.length

    def _over(self, window):
        """The last load, as the mean over this window that brings the same impulse and heat: unless the fluid goes first, it
        comes from the window before, which may have been longer or shorter."""
        load = self._load
        if load.length == window.length:
            return load
        ratio = load.length / window.length
        return dataclasses.replace(load, force=ratio * load.force, heat_flow=ratio * load.heat_flow,
                                   time=window.time, length=window.length)

    def send(self, window, codec, data):
        data.send(codec.encode_motion(window, self._motion))

    def store(self, checkpoint, codec):
        stamp = Window(checkpoint.window, self._load.time, self._load.length)
        checkpoint.load.CopyFrom(codec.encode_load(stamp, self._load).load)

    def restore(self, checkpoint, codec):
        load = checkpoint.load
        self._load = codec.decode_load(Window(load.window, load.time, load.length),
                                       v1.ToPeer(load=load))


class _FluidSide:
    role, peer = FLUID, "solid"

    def __init__(self, fluid):
        self._fluid = fluid
        self._end_is_known = False
        self._previous = self._latest = InterfaceMotion.empty()
        self._solid_lags = False  # it advances with the load of the window before
        self._load = self._load_before = None
        self._work_of_loads = self._exchanged_work = 0.0  # J/m

    def configure(self, configure, codec, data, ready):
        chains = []
        if data is not None:
            chains, self._latest = codec.decode_start(data.receive())
        self._previous = self._latest
        if data is not None:
            self._load = InterfaceLoad(np.zeros((codec.nodes, 2)), np.zeros(codec.segments))
        self._load_before = self._load
        schedule = SCHEDULE[configure.schedule]
        self._end_is_known = schedule[FLUID][0] == RECEIVE
        self._solid_lags = schedule[FLUID][0] == schedule[SOLID][0] == ADVANCE
        self._fluid.configure(configure, chains, self._latest, ready)

    def receive(self, window, codec, data):
        self._previous, self._latest = self._latest, codec.decode_motion(window, data.receive())
        # The motion that has just come was made under the load that was sent last, or, where both advance at once, under
        # the one before it; spread over the window as the solid spreads it (_SolidSide._over).
        load = self._load_before if self._solid_lags else self._load
        ratio = load.length / window.length
        work = ratio * load.force * (self._latest.position - self._previous.position)
        self._work_of_loads += work.sum()
        self._exchanged_work += abs(work).sum()

    def advance(self, window, report):
        start, end = self._previous, self._latest
        if not self._end_is_known:
            start, end = self._latest, self._predicted(window)
        self._load_before = self._load
        self._load = self._fluid.advance(window, start, end, report)
        self._load.time, self._load.length = window.time, window.length
        report.ledger.work_of_loads = self._work_of_loads
        report.ledger.exchanged_work = self._exchanged_work

    def _predicted(self, window):
        """The end of the window if acceleration and rate of the temperature go on as in the window before."""
        before, start, w = self._previous, self._latest, window.length
        span = start.time - before.time
        acceleration = (start.velocity - before.velocity) / span if span > 0 else 0.0
        rate = (start.temperature - before.temperature) / span if span > 0 else 0.0
        return dataclasses.replace(
            start, position=start.position + w * start.velocity + 0.5 * w**2 * acceleration,
            velocity=start.velocity + w * acceleration, temperature=start.temperature + w * rate,
            time=window.time + w)

    def send(self, window, codec, data):
        data.send(codec.encode_load(window, self._load))

    def store(self, checkpoint, codec):
        stamp = Window(checkpoint.window, self._latest.time, 0.0)
        checkpoint.motion.CopyFrom(codec.encode_motion(stamp, self._latest).motion)
        stamp = Window(checkpoint.window, self._previous.time, 0.0)
        checkpoint.motion_before.CopyFrom(codec.encode_motion(stamp, self._previous).motion)
        stamp = Window(checkpoint.window, self._load.time, self._load.length)
        checkpoint.load.CopyFrom(codec.encode_load(stamp, self._load).load)
        checkpoint.work_of_loads = self._work_of_loads
        checkpoint.exchanged_work = self._exchanged_work

    def restore(self, checkpoint, codec):
        motion = checkpoint.motion
        self._latest = codec.decode_motion(Window(motion.window, motion.time, 0.0),
                                           v1.ToPeer(motion=motion))
        before = checkpoint.motion_before
        self._previous = codec.decode_motion(Window(before.window, before.time, 0.0),
                                             v1.ToPeer(motion=before))
        load = checkpoint.load
        self._load = codec.decode_load(Window(load.window, load.time, load.length),
                                       v1.ToPeer(load=load))
        self._work_of_loads = checkpoint.work_of_loads
        self._exchanged_work = checkpoint.exchanged_work


class _Participant:
    def __init__(self, context, solver, address, connect_timeout):
        self._context, self._solver = context, solver
        self._side = (_FluidSide if isinstance(solver, FluidSolver) else _SolidSide)(solver)
        self._connect_timeout, self._address = connect_timeout, address
        self._data = None
        self._window, self._next_window = Window(), 0
        self._waiting_for_lease = 0.0
        self._control = ControlLink(context, address)

    def serve(self):
        self._greet()
        self._configure()
        while True:
            order = self._next_order()
            kind = order.WhichOneof("message")
            if kind == "lease":
                self._use(order.lease)
            elif kind == "save":
                self._save(order.save)
            elif kind == "restore":
                self._restore(order.restore)
            elif kind == "finish":
                return self._finish()
            else:
                self._out_of_turn("Lease, Save, Restore or Finish")

    def fail(self, code, sentence):
        failed = v1.Failed(code=code, text=sentence, window=self._window.index,
                           time=self._window.time)
        if self._data is not None:
            self._data.tell_failed(failed)
        self._control.send(failed=failed)

    def close(self):
        if self._data is not None:
            self._data.close()
        self._control.close()

    def _greet(self):
        self._control.send(hello=v1.Hello(version=VERSION, role=self._side.role,
                                          solver=self._solver.name, capabilities=["save"],
                                          process_id=os.getpid()))

    def _configure(self):
        self._control.phase = "waiting for the orchestrator"
        answer = self._control.receive(self._connect_timeout)
        if answer is None:
            raise Error(v1.Failed.PEER, f"No orchestrator answered at {self._address} within "
                                        f"{self._connect_timeout} s.")
        if answer.WhichOneof("message") != "configure":
            self._out_of_turn("Configure")
        configure = answer.configure
        self._check(configure)
        self._control.phase = "configuring"
        self._start = time.monotonic()
        self._timeout, self._run_folder = configure.timeout, configure.run_folder
        self._control.interval = configure.heartbeat_interval
        self._acts = SCHEDULE[configure.schedule][self._side.role]
        if configure.peer_address:
            self._data = DataPlane(self._context, configure, self._control, self._side.peer)
        else:
            self._acts = (ADVANCE,)
        self._codec = Codec(configure.run_id)
        ready = v1.Ready()
        self._side.configure(configure, self._codec, self._data, ready)
        ready.nodes, ready.segments = self._codec.nodes, self._codec.segments
        self._control.send(ready=ready)

    def _check(self, configure):
        theirs = configure.version
        if theirs.major != VERSION.major:
            older = "the orchestrator" if theirs.major < VERSION.major else self._solver.name
            raise Error(v1.Failed.VERSION,
                        f"The orchestrator speaks protocol {theirs.major}.{theirs.minor}, "
                        f"{self._solver.name} speaks {VERSION.major}.{VERSION.minor}: the major "
                        f"versions must agree; upgrade {older}.")
        if configure.role != self._side.role:
            raise Error(v1.Failed.PEER, f"The orchestrator does not take this "
                                        f"{NAMES[self._side.role]} for one.")
        if configure.schedule not in SCHEDULE:
            raise Error(v1.Failed.SCENE, f"The schedule with number {configure.schedule} is unknown "
                                         "here; upgrade this solver.")
        for value in (configure.timeout, configure.heartbeat_interval):
            if not (value > 0 and math.isfinite(value)):
                raise Error(v1.Failed.PEER, "The orchestrator's Configure lacks a positive timeout "
                                            "or heartbeat interval.")

    def _next_order(self):
        self._control.phase = "waiting for the orchestrator"
        before = time.monotonic()
        order = self._control.receive(self._timeout)
        self._waiting_for_lease += time.monotonic() - before
        if order is None:
            raise Error(v1.Failed.PEER, f"The orchestrator has sent nothing for {self._timeout} s; "
                                        "it hangs or was stopped.")
        return order

    def _use(self, lease):
        if not (lease.length > 0 and math.isfinite(lease.length) and math.isfinite(lease.time)):
            raise Error(v1.Failed.PEER, f"The orchestrator leased windows of {lease.length} s from "
                                        f"{lease.time} s.")
        for i in range(lease.count):
            last = i + 1 == lease.count
            self._play(Window(lease.first + i, lease.time + i * lease.length, lease.length,
                              last and lease.sample, last and lease.snapshot))

    def _play(self, window):
        if window.index != self._next_window:
            raise Error(v1.Failed.PEER, f"The orchestrator leased window {window.index} where window "
                                        f"{self._next_window} is due.")
        self._window, self._next_window = window, window.index + 1
        self._control.window, self._control.time = window.index, window.time
        report = v1.Report()
        last_of_ours = SEND if SEND in self._acts else ADVANCE
        for act in self._acts:
            if act == RECEIVE:
                self._side.receive(window, self._codec, self._data)
            elif act == ADVANCE:
                self._control.phase = "advancing"
                self._side.advance(window, report)
                check_report(report, window)  # before anything leaves
            else:
                self._side.send(window, self._codec, self._data)
            if act == last_of_ours:
                self._send_report(report)

    def _send_report(self, report):
        report.window = self._window.index
        report.time = self._window.time + self._window.length
        self._fill(report.timing)
        self._control.send(report=report)

    def _save(self, order):
        self._control.phase = "saving"
        if order.window + 1 != self._next_window:
            raise Error(v1.Failed.PEER, f"The orchestrator wants window {order.window} saved where "
                                        f"the last one done is {self._next_window} - 1.")
        checkpoint = v1.Checkpoint(version=VERSION, role=self._side.role, solver=self._solver.name,
                                   window=order.window, time=self._window.time + self._window.length,
                                   state=self._solver.save())
        self._side.store(checkpoint, self._codec.of_no_run())
        path = os.path.join(self._run_folder, order.path)
        with open(path + ".part", "wb") as file:  # aside, then renamed: whole or not there
            file.write(checkpoint.SerializeToString())
        os.replace(path + ".part", path)
        self._control.send(saved=v1.Saved(window=order.window))

    def _restore(self, order):
        self._control.phase = "restoring"
        path = os.path.join(self._run_folder, order.path)
        try:
            with open(path, "rb") as file:
                checkpoint = v1.Checkpoint.FromString(file.read())
        except (OSError, DecodeError) as error:
            raise Error(v1.Failed.INTERNAL, f"'{path}' is missing or no checkpoint of this "
                                            "protocol.") from error
        if (checkpoint.role, checkpoint.solver, checkpoint.window) != (
                self._side.role, self._solver.name, order.window):
            raise Error(v1.Failed.INTERNAL, f"'{path}' holds window {checkpoint.window} of "
                                            f"{checkpoint.solver}, not window {order.window} of "
                                            f"{self._solver.name}.")
        self._side.restore(checkpoint, self._codec.of_no_run())
        self._solver.restore(checkpoint.state)
        self._next_window = checkpoint.window + 1
        self._control.send(restored=v1.Restored(window=checkpoint.window, time=checkpoint.time))

    def _finish(self):
        self._control.phase = "finishing"
        self._solver.finish()
        bye = v1.Bye()
        self._fill(bye.timing)
        self._control.send(bye=bye)

    def _fill(self, timing):
        timing.wall = time.monotonic() - self._start
        timing.cpu = time.process_time()
        timing.waiting_for_peer = 0 if self._data is None else self._data.waited
        timing.waiting_for_lease = self._waiting_for_lease
        timing.peak_memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024

    def _out_of_turn(self, due):
        raise Error(v1.Failed.PEER, f"The orchestrator sent another message where {due} was due.")
