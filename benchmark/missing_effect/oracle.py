"""What a campaign can tell: fits of the benchmark's own model, with and without effects, to noise-free values.

The fit minimises J = half the squared residuals in noise sds plus half the squared standard normal coordinates of all parameters. `nats` of one
explanation over another are differences of J; nothing is charged for the choice or for a strength.
"""
import numpy as np

import wheel
from catalogue import EFFECTS, quantile

STRIPS = 30
ITERATIONS = 30
# How far out in its prior a parameter may lie; closer bounds make rivals look worse than they are [standard deviations].
FARTHEST = 7.0
# The strengths at which alternatives are screened, and how many of them are fitted.
SCREENED, FITTED = (0.3, 1.2), 4


class Campaign:
    def __init__(self, runs, priors, sds, effects=EFFECTS):
        self.runs, self.priors, self.sds, self.effects = runs, priors, np.asarray(sds), effects
        self.rows = len(runs["slip"])

    def names(self, chosen):
        return [(None, key) for key in self.priors] + [(effect, key) for effect in chosen for key in self.effects[effect]["priors"]]

    def values(self, points, chosen, laws=(), runs=None):
        """Channels at each of these points (a row of normal coordinates each): (points, rows, channels)."""
        runs = runs or self.runs
        rows, count = len(runs["slip"]), len(points)
        tiled = {key: np.tile(column, count) for key, column in runs.items()}
        parameters = {}
        for k, (effect, key) in enumerate(self.names(chosen)):
            prior = self.effects[effect]["priors"][key] if effect else self.priors[key]
            numbers = quantile(prior, points[:, k]) if not isinstance(prior, float) else np.full(count, prior)
            parameters[effect, key] = np.repeat(numbers, rows)
        soil = {key: parameters[None, key] for key in self.priors}
        hooks = [(self.effects[e], {key: parameters[e, key].reshape(-1, 1) for key in self.effects[e]["priors"]}) for e in chosen]
        hooks += [(law, {}) for law in laws]
        return wheel.solve(tiled, soil, hooks, STRIPS)[0].reshape(count, rows, 3)

    def fit(self, target, chosen=(), laws=(), start=None, iterations=ITERATIONS):
        """The least J, its coordinates and the values there, by Levenberg and Marquardt's method from one start."""
        chosen = list(chosen)
        u = np.zeros(len(self.names(chosen))) if start is None else np.array(start, float)
        residuals = lambda y: np.nan_to_num(((y - target) / self.sds).reshape(len(y), -1), nan=1e3)
        damping, best, y = 1e-2, np.inf, None
        for _ in range(iterations):
            points = u + np.vstack([np.zeros_like(u), 1e-4 * np.eye(len(u))])
            all_values = self.values(points, chosen, laws)
            r = residuals(all_values)
            jacobian = ((r[1:] - r[0]) / 1e-4).T
            best, y = 0.5 * (r[0] @ r[0] + u @ u), all_values[0]
            gradient, hessian = jacobian.T @ r[0] + u, jacobian.T @ jacobian + np.eye(len(u))
            gained = 0.0
            # Four dampings are tried at once.
            dampings = damping * np.array([0.1, 1.0, 10.0, 1000.0])
            steps = np.array([-np.linalg.solve(hessian + d * np.diag(np.diag(hessian)), gradient) for d in dampings])
            trials = np.clip(u + np.clip(steps, -2, 2), -FARTHEST, FARTHEST)
            r = residuals(self.values(trials, chosen, laws))
            costs = 0.5 * (np.sum(r**2, axis=1) + np.sum(trials**2, axis=1))
            k = int(np.argmin(costs))
            if costs[k] < best:
                gained, u, damping = best - costs[k], trials[k], max(dampings[k], 1e-6)
                best = costs[k]
            if gained < 0.01:
                break
        return best, u, y

    def alternatives(self, target, base, given=(), laws=(), left_out=(), fitted=FITTED):
        """Fits of base plus `given` and one more effect by its name, best first: those to which a linear screen promises most are fitted."""
        best, u, y = base
        scaled = lambda values: ((values - y) / self.sds).reshape(len(values), -1)
        points = u + 1e-4 * np.eye(len(u))
        columns = (scaled(self.values(points, list(given), laws)) / 1e-4).T
        columns = np.vstack([columns, np.eye(len(u))])
        q, _ = np.linalg.qr(columns)
        residual = np.concatenate([((target - y) / self.sds).ravel(), -u])
        residual = residual - q @ (q.T @ residual)
        promises = []
        for name in self.effects:
            if name in given or name in left_out:
                continue
            count = len(self.effects[name]["priors"])
            signs = (1, -1) if any(p[0] == "normal" for p in self.effects[name]["priors"].values()) else (1,)
            starts = np.array([np.concatenate([u, np.full(count, sign * z)]) for z in SCREENED for sign in signs])
            changes = scaled(self.values(starts, [*given, name], laws))
            for start, change in zip(starts, changes):
                if np.all(np.isfinite(change)) and np.any(change):
                    direction = np.concatenate([change, np.zeros(len(u))])
                    direction = direction - q @ (q.T @ direction)
                    size = direction @ direction
                    if size > 1e-8:
                        share = np.clip(residual @ direction / size, 0, 2)
                        promises.append((share * (residual @ direction) - 0.5 * share**2 * size, name, start))
        promises.sort(key=lambda p: -p[0])
        fits = {}
        for promise, name, start in promises:
            if name not in fits and len(fits) < fitted:
                fits[name] = self.fit(target, [*given, name], laws, start)
        return dict(sorted(fits.items(), key=lambda pair: pair[1][0]))
