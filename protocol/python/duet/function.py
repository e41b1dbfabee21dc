"""The scene's functions of place and time (duet.v1.Function)."""

import functools
import re

import numpy as np

_NAMES = {name: getattr(np, name) for name in
          ("sin", "cos", "tan", "sinh", "cosh", "tanh", "exp", "log10", "sqrt", "abs", "sign", "rint", "pi")}
_NAMES |= {"asin": np.arcsin, "acos": np.arccos, "atan": np.arctan, "atan2": np.arctan2, "ln": np.log,
           "min": lambda *values: functools.reduce(np.minimum, values),
           "max": lambda *values: functools.reduce(np.maximum, values)}


def evaluate(function, x=0.0, y=0.0, t=0.0):
    """Its value at (x, y), m, and time t, s; x and y may be arrays.

    A formula may hold what docs/case-file.md lists, but for the choice `a ? b : c` and `&&`, `||`.
    Raises ValueError with a sentence if it cannot be read, or has no finite value.
    """
    kind = function.WhichOneof("kind")
    if kind == "table":
        return np.interp(t, function.table.time, function.table.value)
    if kind != "formula":
        return function.number
    text = function.formula
    unknown = set(re.findall(r"[A-Za-z_]\w*", re.sub(r"\d[eE][+-]?\d", "", text))) - set(_NAMES) - {"x", "y", "t"}
    if unknown or re.search(r"[^\w\s.+\-*/^(),<>=!]", text):
        raise ValueError(f"The formula '{text}' holds {', '.join(sorted(unknown)) or 'a character'} that is not known here.")
    try:
        with np.errstate(all="ignore"):
            value = eval(text.replace("^", "**"), {"__builtins__": {}},
                         _NAMES | {name: np.asarray(place, float)[()] for name, place in (("x", x), ("y", y), ("t", t))})
    except (SyntaxError, TypeError) as fault:
        raise ValueError(f"The formula '{text}' cannot be read: {fault}.") from fault
    except ArithmeticError as fault:
        raise ValueError(f"The formula '{text}' has no finite value at t = {t}: {fault}.") from fault
    if isinstance(value, tuple):
        raise ValueError(f"The formula '{text}' holds several values where one is due.")
    if np.iscomplexobj(value) or not np.all(np.isfinite(value)):
        raise ValueError(f"The formula '{text}' has no finite value somewhere at t = {t}.")
    return value
