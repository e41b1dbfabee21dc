"""The sockets of a participant: control link with its own thread, and data plane (the twins of
control_link.cpp and exchange.cpp)."""

import collections
import os
import sys
import threading
import time

import zmq
from google.protobuf.message import DecodeError
from zmq.utils.monitor import parse_monitor_message

from .messages import v1
from .solver import Error

PATIENCE = 1000  # ms, of every send, receive and close
GRACE = 2  # s that a computing solver is given when the run is over


class Aborted(Exception):
    """The orchestrator said Abort, or is gone: end, there is nobody to report to."""


def bounded_socket(context, kind):
    socket = context.socket(kind)
    socket.linger = socket.sndtimeo = socket.rcvtimeo = PATIENCE
    socket.reconnect_ivl = 5
    return socket


def milliseconds_until(deadline):
    return max(0, 1 + int(1000 * (deadline - time.monotonic())))


class Monitor:
    """Knows whether a socket's connection is up; used by the socket's own thread."""

    EVENTS = (zmq.EVENT_ACCEPTED | zmq.EVENT_CONNECTED | zmq.EVENT_DISCONNECTED
              | zmq.EVENT_HANDSHAKE_SUCCEEDED)

    def __init__(self, socket):
        self._watched = socket
        self.news = socket.get_monitor_socket(self.EVENTS)
        self._open = set()
        self._greeted = False

    def update(self):
        while self.news.poll(0):
            event = parse_monitor_message(self.news.recv_multipart())
            if event["event"] == zmq.EVENT_HANDSHAKE_SUCCEEDED:
                self._greeted = True
            elif event["event"] == zmq.EVENT_DISCONNECTED:
                self._open.discard(event["value"])
            else:
                self._open.add(event["value"])

    def up(self):
        return bool(self._open)

    def lost(self):
        return self._greeted and not self._open

    def close(self):
        # An open monitor would hang the end of the context.
        self._watched.disable_monitor()
        self.news.close()


class ControlLink:
    """A thread owns the DEALER socket, so that heartbeats go out while the solver computes."""

    def __init__(self, context, address):
        self.window, self.time, self.phase, self.interval = 0, 0.0, "configuring", 1.0
        self._inbox = collections.deque()
        self._reason = None  # why the run is over, once it is
        self.socket = bounded_socket(context, zmq.PAIR)
        self.socket.bind("inproc://control")
        self._far = bounded_socket(context, zmq.PAIR)
        self._far.connect("inproc://control")
        self._dealer = bounded_socket(context, zmq.DEALER)
        self._monitor = Monitor(self._dealer)
        try:
            self._dealer.connect(address)
        except zmq.ZMQError as error:
            raise Error(v1.Failed.PEER, f"Cannot connect to '{address}' ({error}); give the address "
                                        "that the orchestrator printed.") from error
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def close(self):
        self.socket.send(b"")
        self._thread.join()
        self.socket.close()

    def send(self, **message):
        self.socket.send(v1.ToOrchestrator(**message).SerializeToString())

    def receive(self, seconds):
        """The next message in order; None after so many seconds."""
        deadline = time.monotonic() + seconds
        self.heed()
        while not self._inbox:
            if time.monotonic() >= deadline:
                return None
            self.socket.poll(milliseconds_until(deadline))
            self.heed()
        return self._inbox.popleft()

    def heed(self):
        while self.socket.poll(0):
            frames = self.socket.recv_multipart()
            if len(frames) == 2:
                raise Aborted(frames[1].decode())
            self._inbox.append(_parsed(v1.ToSolver, frames[0], "orchestrator"))

    def _run(self):
        poller = zmq.Poller()
        for socket in (self._far, self._dealer, self._monitor.news):
            poller.register(socket, zmq.POLLIN)
        last_beat = float("-inf")
        while self._reason is None:
            if time.monotonic() >= last_beat + self.interval:
                self._beat()
                last_beat = time.monotonic()
            poller.poll(milliseconds_until(last_beat + self.interval))
            if not self._forward_to_orchestrator():
                break
            self._forward_to_solver()
        else:
            self._wait_for_the_solver()
        self._monitor.close()
        self._dealer.close()
        self._far.close()

    def _forward_to_orchestrator(self):
        while self._far.poll(0):
            frame = self._far.recv()
            if not frame:
                return False
            try:
                self._dealer.send(frame)
            except zmq.Again:
                self._end("The orchestrator takes no messages; it hangs or was stopped.")
                return True
        return True

    def _forward_to_solver(self):
        self._monitor.update()
        lost = self._monitor.lost()
        while self._reason is None and self._dealer.poll(0):
            frame = self._dealer.recv()
            try:
                message = v1.ToSolver.FromString(frame)
            except DecodeError:  # the solver's thread will say so
                message = v1.ToSolver()
            if message.WhichOneof("message") == "abort":
                self._end(message.abort.text)
            else:
                self._far.send(frame)
        if lost and self._reason is None:
            self._end("The orchestrator has closed the connection.")

    def _wait_for_the_solver(self):
        deadline = time.monotonic() + GRACE
        while self._far.poll(milliseconds_until(deadline)):
            if not self._far.recv():
                return
        print(self._reason, "The solver did not come back in time; its process ends.",
              file=sys.stderr, flush=True)
        os._exit(1)

    def _beat(self):
        if self._monitor.up():
            beat = v1.Heartbeat(window=self.window, time=self.time, phase=self.phase)
            try:
                self._dealer.send(v1.ToOrchestrator(heartbeat=beat).SerializeToString(),
                                  zmq.DONTWAIT)
            except zmq.Again:
                pass  # the next one may pass

    def _end(self, reason):
        self._reason = reason
        self._far.send_multipart([b"gone", reason.encode()])


class DataPlane:
    """One PAIR socket straight to the other solver; every wait also heeds the orchestrator."""

    def __init__(self, context, configure, control, peer):
        self._control, self._peer = control, peer
        self._timeout = configure.timeout
        self.waited = 0.0  # s, for the peer
        self._pair = bounded_socket(context, zmq.PAIR)
        self._monitor = Monitor(self._pair)
        self._record = None
        try:
            if configure.peer_bind:
                self._pair.bind(configure.peer_address)
            else:
                self._pair.connect(configure.peer_address)
            if configure.record:
                self._record = bounded_socket(context, zmq.PUSH)
                self._record.connect(configure.record_address)
        except zmq.ZMQError as error:
            raise Error(v1.Failed.PEER, "Cannot open the data plane "
                                        f"'{configure.peer_address}' or the record "
                                        f"'{configure.record_address}': {error}.") from error

    def send(self, message):
        frame = message.SerializeToString()
        self._wait(zmq.POLLOUT)
        self._pair.send(frame)
        if self._record is not None:
            try:
                self._record.send(frame)
            except zmq.Again as error:
                raise Error(v1.Failed.PEER, "The orchestrator does not take the record of the "
                                            "exchanges; its disk may be full or too slow.") from error

    def receive(self):
        self._wait(zmq.POLLIN)
        frames = self._pair.recv_multipart()
        if len(frames) != 1:
            raise Error(v1.Failed.PEER, f"The {self._peer} sent a message of several frames.")
        return _parsed(v1.ToPeer, frames[0], self._peer)

    def tell_failed(self, failed):
        """So that the peer need not wait; never blocks or raises."""
        try:
            self._pair.send(v1.ToPeer(failed=failed).SerializeToString(), zmq.DONTWAIT)
        except zmq.ZMQError:
            pass  # the peer then learns it from the closed connection

    def close(self):
        self._monitor.close()
        self._pair.close()
        if self._record is not None:
            self._record.close()

    def _wait(self, events):
        start = time.monotonic()
        deadline = start + self._timeout
        phase, self._control.phase = self._control.phase, "waiting for the other solver"
        poller = zmq.Poller()
        poller.register(self._pair, events)
        poller.register(self._control.socket, zmq.POLLIN)
        poller.register(self._monitor.news, zmq.POLLIN)
        while True:
            # What the peer sent before it went is in the pipe before the news of its going.
            self._monitor.update()
            if self._pair.poll(0, events):
                break
            if self._monitor.lost():
                raise Error(v1.Failed.PEER, f"The {self._peer} has closed its connection: its "
                                            "process has ended.")
            if time.monotonic() >= deadline:
                raise Error(v1.Failed.PEER, f"The {self._peer} has been silent for {self._timeout} "
                                            "s; it hangs, or its windows take longer than the "
                                            "timeout.")
            if self._control.socket in dict(poller.poll(milliseconds_until(deadline))):
                self._control.heed()
        self._control.phase = phase
        self.waited += time.monotonic() - start


def _parsed(kind, frame, sender):
    try:
        return kind.FromString(frame)
    except DecodeError as error:
        raise Error(v1.Failed.PEER, f"The {sender} sent {len(frame)} bytes that are no message of "
                                    "the protocol.") from error
