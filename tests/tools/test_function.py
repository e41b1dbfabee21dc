"""duet.evaluate: numbers, formulas and tables of a scene, as a Python solver takes them."""

import pathlib
import sys
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "protocol" / "python"))
import duet  # noqa: E402


class EvaluateTest(unittest.TestCase):
    def test_number(self):
        self.assertEqual(duet.evaluate(duet.v1.Function(number=3.5), 1, 2, 3), 3.5)

    def test_formula_over_arrays(self):
        formula = duet.v1.Function(formula="300 + 1e1*sin(pi*x)*y^2 - (t > 1)")
        values = duet.evaluate(formula, np.array([0, 0.5]), np.array([7, 2]), 2.0)
        np.testing.assert_allclose(values, [299, 339])

    def test_table_is_constant_beyond_its_ends(self):
        table = duet.v1.Function(table=duet.v1.TimeTable(time=[1, 2], value=[10, 20]))
        self.assertEqual([duet.evaluate(table, t=t) for t in (0, 1.5, 9)], [10, 15, 20])

    def test_bounds_of_several_values(self):
        x = np.array([1.0, 5.0])
        np.testing.assert_allclose(duet.evaluate(duet.v1.Function(formula="max(x, y, 2)"), x, 3.0), [3, 5])
        np.testing.assert_allclose(x, [1, 5])

    def test_no_finite_value_is_refused_at_a_point_too(self):
        for text in ("1/x", "10.0^400", "(x-1)^0.5", "2 , 3"):
            with self.subTest(text), self.assertRaises(ValueError):
                duet.evaluate(duet.v1.Function(formula=text), 0.0)

    def test_what_is_no_formula_is_refused(self):
        for text in ("z + 1", "__import__('os')", "x.real", "x +", "1/x"):
            with self.subTest(text), self.assertRaises(ValueError), np.errstate(all="ignore"):
                duet.evaluate(duet.v1.Function(formula=text), np.zeros(2))


if __name__ == "__main__":
    unittest.main()
