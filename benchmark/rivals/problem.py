"""Problems whose evidence, posterior means and standard deviations are known: those of coordinator/inference/tests/problems.rs by their letters,
and the base of examples/hidden-effect."""
import atexit
import csv
import http.client
import json
import pathlib
import subprocess
import time

import numpy as np
from scipy.special import ndtr, ndtri

EXAMPLE = pathlib.Path(__file__).resolve().parents[2] / "examples/hidden-effect"
LN_SQRT_TAU = 0.5 * np.log(2 * np.pi)


class Prior:
    """A prior on the unit interval: what a job says of it, the parameter at a coordinate, ln of its density there, and the ends of one sd."""

    def __init__(self, job, value, log_density=np.zeros_like, one_sd=(0.16, 0.84)):
        self.job, self.value, self.log_density, self.one_sd = job, value, log_density, one_sd


def uniform(lower, upper):
    return Prior({"uniform": [lower, upper]}, lambda u: lower + (upper - lower) * u)


def lognormal(median, factor):
    return Prior({"lognormal": [median, factor]}, lambda u: median * factor ** ndtri(np.clip(u, 1e-300, 1 - 1e-16)))


def normal(mean, sd, lower, upper):
    """Linear in the parameter: a posterior eight sds from the mean would lie at a quantile of 1e-15."""
    width = upper - lower
    mass = ndtr((upper - mean) / sd) - ndtr((lower - mean) / sd)
    value = lambda u: lower + width * u
    log_density = lambda u: -0.5 * ((value(u) - mean) / sd) ** 2 - LN_SQRT_TAU - np.log(sd * mass / width)
    one_sd = (mean - sd - lower) / width, (mean + sd - lower) / width
    return Prior({"normal": [mean, sd], "bounds": [lower, upper]}, value, log_density, one_sd)


class Problem:
    """A log-likelihood `constant` - |r|^2 / 2 of residuals r, with its evidence, posterior means and sds; counts and times its evaluations."""

    def __init__(self, priors, residuals, constant, log_evidence, mean, sd):
        self.priors, self.residuals, self.constant = priors, residuals, constant
        self.log_evidence, self.mean, self.sd = log_evidence, np.array(mean), np.array(sd)
        self.is_example = False
        self.dimension, self.evaluations, self.seconds = len(priors), 0, 0.0

    def theta(self, cube):
        """Parameters of points of the unit cube, along the last axis."""
        return np.stack([prior.value(cube[..., i]) for i, prior in enumerate(self.priors)], axis=-1)

    def log_density(self, cube):
        """ln of likelihood times prior density in the unit cube."""
        began = time.process_time()
        self.evaluations += 1
        r = self.residuals(self.theta(cube))
        self.seconds += time.process_time() - began
        return self.constant - 0.5 * r @ r + sum(prior.log_density(u) for prior, u in zip(self.priors, cube))


def correlated_gaussian():
    mean, sd, innovation = np.array([1.0, -2, 0.5, 3, 0]), np.array([0.05, 0.2, 0.5, 1, 0.1]), np.sqrt(0.19)

    def residuals(x):
        z = (x - mean) / sd
        return np.append(z[0], (z[1:] - 0.9 * z[:-1]) / innovation)

    constant = -5 * LN_SQRT_TAU - 4 * np.log(innovation) - np.log(sd).sum()
    return Problem([uniform(-10.0, 10.0)] * 5, residuals, constant, -14.97866137, mean, sd)


def shear_building():
    def residuals(theta):
        m1, m2, (k1, k2) = 16.5e3, 16.1e3, 29.7e6 * theta
        half = 0.5 * ((k1 + k2) * m2 + k2 * m1)
        root = np.sqrt(max(half * half - m1 * m2 * k1 * k2, 0.0))
        squares = np.array([k1 * k2 / (half + root), (half + root) / (m1 * m2)])
        return 16 * (squares / (2 * np.pi * np.array([3.13, 9.83])) ** 2 - 1)

    def of_mode(mode, sd):
        q = max(np.roots([1, -1, 0, 0, -((sd / mode) ** 2)]).real)
        return lognormal(float(mode * q), float(np.exp(np.sqrt(np.log(q)))))

    mean, sd = [1.11699503, 0.59343654], [0.66237308, 0.32994652]
    return Problem([of_mode(1.3, 1), of_mode(0.8, 1)], residuals, 0.0, -6.49597365, mean, sd)


def thin_ridge():
    priors = [uniform(-1e9, 1e9), uniform(1.0, 1e10)]
    residuals = lambda theta: np.array([(theta[0] / 0.1 + theta[1] - 1e6) / 5e4])
    constant = -LN_SQRT_TAU - np.log(5e4)
    return Problem(priors, residuals, constant, -23.71899811, [-4.999e8, 5e9], [2.88675135e8, 2.88675135e9])


def hidden_effect():
    """The base of examples/hidden-effect by `worker serve --umbridge`; truth by `stages = "draws"` with 20,000 particles."""
    server = subprocess.Popen(["worker", "serve", "--umbridge", "--port", "0", "--threads", "1"], stdout=subprocess.PIPE, text=True)
    atexit.register(server.terminate)
    connection = http.client.HTTPConnection(server.stdout.readline().strip().removeprefix("http://"))
    with open(EXAMPLE / "runs.csv") as file:
        runs = [run for run in csv.DictReader(line for line in file if not line.startswith("#")) if run["use"] == "fit"]
    conditions = ["slip", "wheel_load_n", "sled_speed_m_s", "slip_angle_deg"]
    inputs = [[float(run[name]) for name in conditions] for run in runs]
    measured = np.array([[float(run[name]) for name in ("drawbar_pull_n", "torque_n_m", "sinkage_m")] for run in runs])
    noise = np.array([1.2, 0.15, 0.0004])

    def residuals(theta):
        p_ref, n, friction, radius = map(float, theta)
        outputs = []
        for condition in inputs:
            request = {"name": "quasi_static", "config": {"rig_radius_m": 0.125, "grouser_count": 0}}
            request["input"] = [[*condition, radius, 0.112], [p_ref, 0.0, n, friction, 0.0, 0.001, 0.5]]
            connection.request("POST", "/Evaluate", json.dumps(request), {"Content-Type": "application/json"})
            outputs.append(json.load(connection.getresponse())["output"][0][:3])
        return ((np.array(outputs) - measured) / noise).ravel()

    priors = [uniform(4.0, 5.6), normal(1.1, 0.2, 0.8, 2.0), normal(30.0, 1.5, 11.5, 37.3), uniform(0.125, 0.155)]
    mean = [4.693817, 1.210841, 18.153739, 0.12501236404]
    sd = [0.02428052, 0.08277878, 0.12035676, 1.2379052e-5]
    constant = -len(runs) * (3 * LN_SQRT_TAU + np.log(noise).sum())
    problem = Problem(priors, residuals, constant, -1347.6686, mean, sd)
    problem.is_example = True
    return problem
