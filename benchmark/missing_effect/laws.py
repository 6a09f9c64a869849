"""Laws outside of the catalogue, drawn from a grammar: a stress is multiplied by 1 + a g, to a channel a g is added; g is a shape of one variable, or the
product of two shapes."""
import numpy as np

STRESSES = {"pressure": ("z", "v_n", "position", "slip", "sled_speed", "wheel_load", "v_t", "j"),
            "shear": ("z", "v_t", "j", "position", "slip", "sled_speed", "wheel_load")}
CHANNELS = {"drawbar_pull": ("slip", "sled_speed", "wheel_load", "sinkage"), "torque": ("slip", "sled_speed", "wheel_load", "sinkage"),
            "sinkage": ("slip", "sled_speed", "wheel_load")}
# Shapes over the variable x with a scale s, an exponent b, a centre c and a width w; a channel may be changed by a constant, so none of them is constant.
SHAPES = {
    "linear": "{x} / {s}", "power": "({x} / {s})**{b}", "square": "({x} / {s})**2", "root": "sqrt({x} / {s})", "saturation": "1 - exp(-{x} / {s})",
    "hyperbola": "{x} / ({x} + {s})", "log": "log(1 + {x} / {s})", "tanh": "tanh({x} / {s})", "decay": "exp(-{x} / {s})", "inverse": "1 / (1 + {x} / {s})",
    "hill": "{x}**2 / ({x}**2 + {s}**2)", "peak": "{x} / {s} * exp(1 - {x} / {s})", "bump": "exp(-(({x} - {c}) / {w})**2)",
    "threshold": "where({x} > {c}, 1, 0)", "wave": "sin(pi * {x} / {s})",
}
# Constants of a shape that has an amplitude; a formula is judged against others that have no more.
CONSTANTS = {name: 1 if name in ("linear", "square", "root") else 3 if name == "bump" else 2 for name in SHAPES}
# As a factor, 1 + a g is the same for both up to a constant.
SAME_FACTOR = ({"saturation", "decay"}, {"hyperbola", "inverse"})
# Two or three levels of a condition show no peak.
OF_FEW_LEVELS = ("sled_speed", "wheel_load")
NOT_OF_FEW_LEVELS = ("bump", "wave", "peak", "threshold")
WORDS = {"exp": np.exp, "log": np.log, "sqrt": np.sqrt, "tanh": np.tanh, "sin": np.sin, "where": np.where, "pi": np.pi}


def value(formula, names):
    """A formula of this benchmark at arrays or numbers by name."""
    with np.errstate(all="ignore"):
        return eval(formula, {"__builtins__": {}}, {**WORDS, **names})


def variables(state):
    """The variables that the contact has, by name."""
    names = ("z", "v_n", "v_t", "j", "position", "slip", "sled_speed", "wheel_load", "sinkage")
    shape = state.z.shape
    return {name: np.broadcast_to(getattr(state, name), shape) for name in names}


def shape_of(rng, number, variable, points):
    """The name of a shape, its formula over a variable, and constants that make it bend within the points."""
    choices = [name for name in SHAPES if not (variable in OF_FEW_LEVELS and name in NOT_OF_FEW_LEVELS)]
    name = choices[rng.integers(len(choices))]
    bottom, top = np.quantile(points, (0.02, 0.98))
    constants = {"s": top * (rng.uniform(0.7, 1.1) if name == "wave" else rng.uniform(0.2, 0.7)),
                 "b": rng.uniform(0.3, 0.7) if rng.random() < 0.5 else rng.uniform(1.4, 2.6),
                 "c": np.quantile(points, rng.uniform(0.35, 0.75)), "w": (top - bottom) * rng.uniform(0.15, 0.3)}
    used = {key: float(f"{constant:.6g}") for key, constant in constants.items() if f"{{{key}}}" in SHAPES[name]}
    formula = SHAPES[name].format(x=variable, **{key: f"{key}{number}" for key in constants})
    return name, formula, {f"{key}{number}": constant for key, constant in used.items()}


def draw(rng, state, sds, count):
    """A law of `count` variables on a contact without it; its amplitude is set by its range there and the noise of the channel that it changes."""
    on_stress = rng.random() < 0.7 or count == 2
    quantities = STRESSES if on_stress else CHANNELS
    acts_on = list(quantities)[rng.integers(len(quantities))]
    fields = variables(state)
    chosen = [str(v) for v in rng.permutation(quantities[acts_on])[:count]]
    shapes = [shape_of(rng, k, v, np.ravel(fields[v])) for k, v in enumerate(chosen)]
    product = " * ".join(f"({formula})" for _, formula, _ in shapes) if count > 1 else shapes[0][1]
    constants = {key: number for _, _, used in shapes for key, number in used.items()}
    sizes = np.abs(value(product, {**fields, **constants}))
    largest = float(np.quantile(sizes, 0.99))
    if on_stress:
        size = rng.uniform(0.25, 0.75) * rng.choice([-1, 1.8])
        constants["a"] = float(f"{size / largest:.6g}")
        formula = f"1 + a * {product}" if count > 1 else f"1 + a * ({product})"
    else:
        noise = sds[("drawbar_pull", "torque", "sinkage").index(acts_on)]
        constants["a"] = float(f"{noise * rng.uniform(4, 12) * rng.choice([-1, 1]) / largest:.6g}")
        formula = f"a * ({product})"
    return {"acts_on": acts_on, "depends_on": chosen, "operation": "times" if on_stress else "plus", "formula": formula,
            "values": constants, "shape": "*".join(name for name, _, _ in shapes)}


def effect(law):
    """A law as an effect without strengths."""
    def factor(state, extra=None):
        names = {name: getattr(state, name) for name in law["depends_on"]}
        if extra is not None and "sinkage" in names:
            names["sinkage"] = extra
        return value(law["formula"], {**names, **law["values"]})

    acts_on = law["acts_on"]
    if law["operation"] == "times":
        return {"priors": {}, acts_on: lambda s, old, a: old * np.maximum(factor(s), 0)}
    place = ("drawbar_pull", "torque", "sinkage").index(acts_on)

    def channels(s, pull, torque, sinkage, a):
        values = [pull, torque, sinkage]
        values[place] = values[place] + factor(s, sinkage)
        return values
    return {"priors": {}, "channels": channels}


def support(law, state):
    """Points of each variable that the contacts of the runs reach, and the law there: what equality of formulas is judged on."""
    fields = variables(state)
    points = {name: np.quantile(np.ravel(fields[name]), np.linspace(0.01, 0.99, 41)) for name in law["depends_on"]}
    if len(points) > 1:
        places = np.linspace(0, state.z.size - 1, 81).astype(int)
        points = {name: np.ravel(fields[name])[places] for name in points}
    curve = value(law["formula"], {**points, **law["values"]}) + 0 * next(iter(points.values()))
    return {"points": {name: [float(f"{x:.6g}") for x in column] for name, column in points.items()}, "values": [float(f"{x:.8g}") for x in curve]}
