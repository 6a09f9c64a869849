"""Whether a formula is a law: equal on the law's support once the formula's constants are fitted again, with at most so many constants more."""
import re

import numpy as np
from scipy.optimize import least_squares

EXACT = 1e-4
WORDS = {"exp": np.exp, "log": np.log, "sqrt": np.sqrt, "sin": np.sin, "cos": np.cos, "tan": np.tan, "sinh": np.sinh, "cosh": np.cosh, "tanh": np.tanh,
         "where": np.where, "abs": np.abs, "min": np.minimum, "max": np.maximum, "pi": np.pi}
NUMBER = re.compile(r"(?<![\w.])\d+\.?\d*(?:[eE][-+]?\d+)?")
# Numbers that belong to the form and are no constants of it.
HELD = (0.0, 0.5, 1.0, 2.0)


def constants(text):
    """The formula with a name for each constant, and their values."""
    values = []

    def replaced(match):
        if float(match.group()) in HELD:
            return match.group()
        values.append(float(match.group()))
        return f"constant_{len(values) - 1}"

    return NUMBER.sub(replaced, text), np.array(values)


def function(text, variables):
    """The formula as a function of points by name and of constants. A word that is not known is an error, so that an answer runs no program."""
    unknown = set(re.findall(r"[A-Za-z_]\w*", text)) - set(WORDS) - set(variables)
    if {word for word in unknown if not re.fullmatch(r"constant_\d+", word)} or "__" in text or not re.fullmatch(r"[\w\s.+\-*/(),<>=]*", text):
        raise ValueError(f"formula has words that are not known: {text}")
    code = compile(text, "formula", "eval")

    def at(points, c):
        names = {**WORDS, **points, **{f"constant_{k}": x for k, x in enumerate(c)}}
        with np.errstate(all="ignore"):
            return eval(code, {"__builtins__": {}}, names)

    return at


def more_constants(law, text):
    """Constants of a formula beyond those of the law if it is the law; None if it is not. A factor of a stress is known up to a constant."""
    points = {name: np.array(column) for name, column in law["support"]["points"].items()}
    curve = np.array(law["support"]["values"])
    text, start = constants(text)
    at = function(text, points)
    size = np.sqrt(np.mean(curve**2))
    is_factor = law["operation"] == "times"

    def residuals(c):
        g = np.clip(np.nan_to_num(np.real(at(points, c)) + 0 * curve, nan=1e6), -1e6, 1e6)
        if is_factor:
            g = g * (g @ curve) / max(g @ g, 1e-300)
        return (g - curve) / (EXACT * size)

    fit = least_squares(residuals, start, x_scale=np.maximum(np.abs(start), 1e-6), max_nfev=200) if len(start) else None
    best = residuals(fit.x) if fit else residuals(start)
    if np.sqrt(np.mean(best**2)) > 1:
        return None
    used = np.linalg.matrix_rank(fit.jac * np.maximum(np.abs(fit.x), 1e-6), rtol=1e-6) if fit else 0
    # The law's own constants; its amplitude and scale too. The free factor of a stress counts for none.
    return int(used) - len(law["values"])


def is_law(law, texts, more=1):
    """Whether the first of the formulas, and whether any, is the law."""
    verdicts = []
    for text in texts:
        try:
            extra = more_constants(law, text)
        except (ValueError, TypeError, SyntaxError, NameError, OverflowError, ZeroDivisionError, np.linalg.LinAlgError):
            extra = None
        verdicts.append(extra is not None and extra <= more)
    return bool(verdicts and verdicts[0]), any(verdicts)
