"""Reads series as ParaView does: every reference of STEM.xdmf must lead to a data set of the stated
shape and type, and STEM.h5 must show the same by the frame's name. Prints the number of frames of
each; exits with 1 and a sentence if not. With --sealed it also wants the values that the killed
writer of snapshot_series.cpp wrote."""

import sys
import xml.etree.ElementTree as xml
from pathlib import Path

import h5py
import numpy


def arrays(stem, element):
    for item in element.iter("DataItem"):
        file, place = item.text.split(":")
        with h5py.File(stem.parent / file, "r") as data:
            if place not in data:
                sys.exit(f"{item.text} does not exist")
            array = data[place][()]
        shape = tuple(int(n) for n in item.get("Dimensions").split())
        kind = {"Float": "<f8", "UInt": "<u4"}[item.get("NumberType")]
        # XDMF leaves a last extent of one out.
        if array.shape != shape and array.shape != shape + (1,):
            sys.exit(f"{item.text} has the shape {array.shape}, the XDMF says {shape}")
        if array.dtype != numpy.dtype(kind):
            sys.exit(f"{item.text} has the type {array.dtype}, the XDMF says {kind}")
        yield place.rsplit("/", 1)[1], array


def frames(stem, sealed):
    if not Path(f"{stem}.xdmf").exists():
        return 0  # it comes with the first frame
    data = h5py.File(f"{stem}.h5", "r")
    grids = xml.parse(f"{stem}.xdmf").getroot().findall("./Domain/Grid/Grid")
    for index, grid in enumerate(grids):
        found = dict(arrays(stem, grid))
        frame = data[f"frame_{index:06}"]
        for name, array in found.items():
            if not (frame[name][()].reshape(array.shape) == array).all():
                sys.exit(f"frame {index}: {stem}.h5 has another {name} than the XDMF")
        connectivity = found["connectivity"]
        if grid.find("Topology").get("NumberOfElements") != str(len(connectivity)):
            sys.exit(f"frame {index}: the topology's count is not that of its connectivity")
        if connectivity.max() >= len(found["position"]):
            sys.exit(f"frame {index}: a cell names a point beyond the last")
        if sealed and not (found["temperature"] == index).all():
            sys.exit(f"frame {index}: the temperature is not {index}")
    return len(grids)


stems = [argument for argument in sys.argv[1:] if argument != "--sealed"]
print(*(frames(Path(stem), "--sealed" in sys.argv) for stem in stems))
