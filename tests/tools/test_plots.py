"""Draws the pictures of tools/ from a small run's folder (made by the program given as argument) and
looks at what came out."""

import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import matplotlib.image
import numpy

ROOT = Path(__file__).resolve().parents[2]


def run(tool, *options):
    command = ["/usr/bin/python3", ROOT / "tools" / tool, *map(str, options)]
    return subprocess.run(command, capture_output=True, text=True)


class Plots(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.place.name)
        cls.picture = cls.folder / "out.png"
        subprocess.run([make_run, cls.folder], check=True)

    @classmethod
    def tearDownClass(cls):
        cls.place.cleanup()

    def draw(self, tool, *options):
        self.picture.unlink(missing_ok=True)
        result = run(tool, self.folder, "-o", self.picture, *options)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return matplotlib.image.imread(self.picture)[:, :, :3]

    def sentence(self, tool, *options):
        """What the tool says when it fails."""
        result = run(tool, *options)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1, "one sentence, no traceback")
        return result.stderr

    def has_colour(self, picture, colour):
        return (abs(picture - colour).max(axis=2) < 0.02).sum() > 500

    def test_temperature_is_drawn_in_both_bodies(self):
        picture = self.draw("plot_fields.py", "--time", 0, "--range", 1000, 2000)
        inferno = matplotlib.colormaps["inferno"]
        self.assertTrue(self.has_colour(picture, inferno(0.0)[:3]), "the fluid at 1000 K")
        self.assertTrue(self.has_colour(picture, inferno(1.0)[:3]), "the plate at 2000 K")

    def test_a_state_holds_every_particle(self):
        state = self.folder / "state.csv"
        result = run("state_of_run.py", self.folder, "-o", state, "--time", 1)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        table = numpy.genfromtxt(state, delimiter=",", names=True, skip_header=1)
        with h5py.File(self.folder / "fluid.h5") as file:
            frames = [file[name] for name in file if name.startswith("frame_")]
            frame = next(frame for frame in frames if frame.attrs["time"] == 1)
            self.assertTrue(numpy.allclose(table["x"], frame["position"][:, 0]))
            self.assertTrue(numpy.allclose(table["temperature"], frame["temperature"][()]))
            self.assertTrue(numpy.allclose(table["velocity_y"], frame["velocity"][:, 1]))

    def test_each_time_has_its_panel(self):
        one = self.draw("plot_fields.py", "--time", 1)
        three = self.draw("plot_fields.py", "--time", 0, 1, 2, "--arrows", "--mesh")
        self.assertGreater(three.shape[1], 1.5 * one.shape[1])

    def test_time_chooses_the_nearest_snapshot(self):
        early, same, late = (
            self.draw("plot_fields.py", "--title", " ", "--time", t) for t in (0.4, 0.6, 1.9)
        )
        self.assertTrue(numpy.array_equal(early, same))
        self.assertFalse(early.shape == late.shape and numpy.array_equal(early, late))

    def test_a_field_of_one_side_leaves_the_other_grey(self):
        picture = self.draw("plot_fields.py", "--field", "speed", "--time", 2)
        grey = (numpy.ptp(picture, axis=2) < 0.01) & (picture[:, :, 0] > 0.5) & (picture[:, :, 0] < 0.95)
        self.assertGreater(grey.mean(), 0.05)

    def test_histories_with_reference(self):
        without = self.draw("plot_probes.py", "--probe", "plate_centre")
        by_case = self.draw(
            "plot_probes.py", "--probe", "plate_centre", "--reference", self.folder / "history.csv"
        )
        by_hand = self.draw(
            "plot_probes.py", "--probe", "plate_centre", "--reference",
            f"plate_centre={self.folder / 'history.csv'}:T_K",
        )
        self.assertFalse(numpy.array_equal(without, by_case))
        self.assertTrue(numpy.array_equal(by_case, by_hand))

    def test_sweep(self):
        table = self.folder / "sweep.csv"
        head = "fluid.spacing,fluid.formulation,error of nu; mean,error of v,cpu_seconds_fluid,steps_fluid,wall_seconds,ended,revision"
        rows = ["0.2,paper,0.1,0.2,1,5,1,finished,x", "0.1,paper,0.05,0.1,4,9,4,finished,x",
                "0.2,consistent,0.01,0.02,1,5,1,finished,x", "0.1,consistent,,,1,5,1,failed,x"]
        table.write_text("\n".join([head, *rows]) + "\n")
        both = self.folder / "both.png"
        one = self.folder / "one.png"
        other = self.folder / "other.csv"  # beside it, with other keys varied
        other.write_text(table.read_text().replace("formulation", "fourth_order").replace("paper", "true"))
        for options in ((table, "-o", both), (table, "--check", "nu", "-o", one),
                        (table, other, "-o", self.folder / "beside.png")):
            result = run("plot_sweep.py", *options)
            self.assertEqual(result.returncode, 0, result.stderr)
        self.assertGreater(matplotlib.image.imread(both).shape[1], matplotlib.image.imread(one).shape[1])
        self.assertFalse(numpy.array_equal(matplotlib.image.imread(both),
                                           matplotlib.image.imread(self.folder / "beside.png")))
        self.assertIn("there is no check lift; there is nu; mean, v",
                      self.sentence("plot_sweep.py", table, "--check", "lift"))
        self.assertIn("is no table of duet sweep",
                      self.sentence("plot_sweep.py", self.folder / "history.csv"))

    def test_errors_are_sentences(self):
        self.assertIn("has no field voltage; it has pressure, temperature, velocity_x",
                      self.sentence("plot_fields.py", self.folder, "--field", "voltage"))
        self.assertIn("nowhere is not a folder", self.sentence("plot_fields.py", "nowhere"))
        self.assertIn("has no probe lift; it has plate_centre",
                      self.sentence("plot_probes.py", self.folder, "--probe", "lift"))
        self.assertIn("has no column Q; it has t, T_K", self.sentence(
            "plot_probes.py", self.folder, "--reference", f"fluid_mean={self.folder / 'history.csv'}:Q"))
        self.assertIn("cannot read missing.csv: No such file", self.sentence(
            "plot_probes.py", self.folder, "--reference", "fluid_mean=missing.csv:Q"))
        self.assertIn("cannot write", self.sentence(
            "plot_fields.py", self.folder, "-o", self.folder / "none" / "out.png"))
        with tempfile.TemporaryDirectory() as empty:
            self.assertIn("neither fluid.h5 nor solid.h5", self.sentence("plot_fields.py", empty))
            h5py.File(Path(empty) / "fluid.h5", "w").close()
            self.assertIn("holds no frame yet", self.sentence("plot_fields.py", empty))
        with tempfile.TemporaryDirectory() as parted:
            shutil.copy(self.folder / "fluid.h5", parted)
            self.assertIn("fluid_frames, which holds them", self.sentence("plot_fields.py", parted))


make_run = sys.argv.pop()
unittest.main()
