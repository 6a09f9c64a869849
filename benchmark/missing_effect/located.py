"""What could stand for a law: a curve in another place (another quantity, another variable), or another formula in its own place."""
import numpy as np
from scipy.optimize import least_squares

import laws

KNOTS, FITTED, ITERATIONS = 5, 3, 12


def curve(acts_on, variable, points, sd):
    """A curve of five knots over a variable as an effect: the logarithm of a factor of a stress, or what is added to a channel."""
    low, high = np.quantile(points, (0.005, 0.995))
    keys = [f"c{k}" for k in range(KNOTS)]

    def height(state, a, sinkage=None):
        x = getattr(state, variable) if sinkage is None or variable != "sinkage" else sinkage
        place = np.clip((x - low) / (high - low), 0, 1) * (KNOTS - 1)
        return sum(a[key] * np.maximum(1 - np.abs(place - k), 0) for k, key in enumerate(keys))

    if acts_on in laws.STRESSES:
        return {"priors": {key: ("normal", 0.0, 2.0) for key in keys}, acts_on: lambda s, old, a: old * np.exp(height(s, a))}
    place = ("drawbar_pull", "torque", "sinkage").index(acts_on)

    def channels(s, pull, torque, sinkage, a):
        values = [pull, torque, sinkage]
        values[place] = values[place] + height(s, a, sinkage)
        return values
    return {"priors": {key: ("normal", 0.0, 20.0 * sd) for key in keys}, "channels": channels}


def places(campaign, target, hidden, law, state, start, best):
    """Nats by which curves in other places fall short of the law, for the places to which a linear screen promises most."""
    fields = laws.variables(state)
    pairs = [(q, v) for group in (laws.STRESSES, laws.CHANNELS) for q, variables in group.items() for v in variables]
    excluded = {(law["acts_on"], variable) for variable in law["depends_on"]} if len(law["depends_on"]) == 1 else set()
    sds = dict(zip(laws.CHANNELS, campaign.sds))
    added = {f"{q}/{v}": curve(q, v, np.ravel(fields[v]), sds.get(q)) for q, v in pairs if (q, v) not in excluded and np.ptp(fields[v]) > 0}
    catalogue, campaign.effects = campaign.effects, {**campaign.effects, **added}
    base_cost, u, y = campaign.fit(target, hidden, start=start)
    scaled = lambda values: ((values - y) / campaign.sds).reshape(len(values), -1)
    tangent = (scaled(campaign.values(u + 1e-4 * np.eye(len(u)), hidden)) / 1e-4).T
    q, _ = np.linalg.qr(np.vstack([tangent, np.eye(len(u))]))
    residual = np.concatenate([((target - y) / campaign.sds).ravel(), -u])
    residual = residual - q @ (q.T @ residual)
    promises = []
    for name in added:
        steps = np.hstack([np.tile(u, (KNOTS, 1)), 0.02 * np.eye(KNOTS)])
        columns = (scaled(campaign.values(steps, [*hidden, name])) / 0.02).T
        if np.all(np.isfinite(columns)):
            columns = np.vstack([columns, np.zeros((len(u), KNOTS))])
            columns = columns - q @ (q.T @ columns)
            normal = columns.T @ columns + np.eye(KNOTS)
            change = np.linalg.solve(normal, columns.T @ residual)
            promises.append((0.5 * change @ (columns.T @ residual), name, np.clip(change, -0.5, 0.5)))
    promises.sort(key=lambda p: -p[0])
    shortfall = {}
    for _, name, change in promises[:FITTED]:
        cost = campaign.fit(target, [*hidden, name], (), np.concatenate([u, change]), ITERATIONS)[0]
        shortfall[name] = round(float(min(cost, base_cost) - best), 2)
    campaign.effects = catalogue
    return dict(sorted(shortfall.items(), key=lambda pair: pair[1]))


def formulas(campaign, target, hidden, law, state, start, best):
    """Nats by which the best other shapes in the law's own place fall short, their constants fitted to the law's curve."""
    variable, real_shape = law["depends_on"][0], law["shape"]
    points = laws.support(law, state)
    x, curve_ = np.array(points["points"][variable]), np.array(points["values"])
    plus = law["operation"] == "plus"
    levels = len(np.unique(x))
    top = np.quantile(np.abs(x), 0.98)
    shortfall = {}
    for name, shape in laws.SHAPES.items():
        if name == real_shape or levels < 4 and name in laws.NOT_OF_FEW_LEVELS:
            continue
        keys = [key for key in "sbcw" if f"{{{key}}}" in shape]
        formula = shape.format(x=variable, **{key: f"{key}0" for key in "sbcw"})

        def constants(c):
            return {f"{key}0": float(top * k if key == "c" else np.exp(np.clip(k, -12, 12)) * (top if key in "sw" else 1)) for key, k in zip(keys, c)}

        def fitted(c):
            g = np.clip(np.nan_to_num(laws.value(formula, {variable: x, **constants(c)}) + 0 * x, nan=1e6), -1e6, 1e6)
            design = g[:, None] if plus else np.stack([g, np.ones_like(x)], axis=1)
            solution = np.linalg.lstsq(design, curve_, rcond=None)[0]
            return solution, design @ solution - curve_

        starts = [[centre if key == "c" else 0.0 if key == "b" else centre - 1.5 for key in keys] for centre in (0.3, 0.7, 1.5)] if keys else [[]]
        fits = [least_squares(lambda c: fitted(c)[1], first, max_nfev=60) for first in starts] if keys else None
        c = min(fits, key=lambda f: f.cost).x if keys else []
        solution, _ = fitted(c)
        amplitude = solution[0] if plus else solution[0] / solution[1]
        rival = {**law, "formula": f"{'' if plus else '1 + '}a * ({formula})", "values": {**constants(c), "a": float(amplitude)}}
        shortfall[name] = round(float(campaign.fit(target, hidden, [laws.effect(rival)], start, 4)[0] - best), 2)
    return dict(sorted(shortfall.items(), key=lambda pair: pair[1])[:4])
