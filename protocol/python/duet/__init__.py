"""Take part in a run of Duet with a solver written in Python.

    class MySolid(duet.SolidSolver):
        def configure(self, configure, ready): ...
        def advance(self, window, load, report): ...

    duet.participate(MySolid())

Needs Debian's python3-zmq, python3-protobuf, python3-numpy and protobuf-compiler.
"""

from .function import evaluate
from .messages import v1
from .participant import participate
from .solver import (Chain, Error, FluidSolver, InterfaceLoad, InterfaceMotion, SolidSolver, Window)

__all__ = ["Chain", "Error", "FluidSolver", "InterfaceLoad", "InterfaceMotion", "SolidSolver",
           "Window", "evaluate", "participate", "v1"]
