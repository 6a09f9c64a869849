"""Methods that compute an evidence and draws of a posterior, each with its default settings and a seed.

A method takes a problem and a seed, and returns a function that runs it and one that then tells ln Z, its standard error (NaN where none is stated),
parameter vectors and their weights (`None` where they are equal). Every method but Grouser is given a density in the unit cube, likelihood times
prior, as a likelihood whose prior is uniform. Grouser is given a job: its model answers the residuals.
"""
import atexit
import http.server
import json
import pathlib
import shutil
import subprocess
import tempfile
import threading
import time

import numpy as np

from problem import EXAMPLE, LN_SQRT_TAU


def pyvbmc(problem, seed):
    from pyvbmc import VBMC
    lower, upper = np.transpose([prior.one_sd for prior in problem.priors])
    bounds = np.zeros(problem.dimension), np.ones(problem.dimension), lower, upper
    start = np.random.default_rng(seed).uniform(lower, upper)
    vbmc = VBMC(lambda x: problem.log_density(np.ravel(x)), start, *bounds, options={"display": "off"}, seed=seed)
    found = []

    def result():
        posterior, summary = found[0]
        return summary["elbo"], summary["elbo_sd"], problem.theta(posterior.sample(20_000)[0]), None

    return lambda: found.append(vbmc.optimize()), result


def gpry(problem, seed):
    from gpry import Runner
    runner = Runner(problem.log_density, [[0, 1]] * problem.dimension, seed=seed, plots=False, verbose=1)

    def result():
        samples = runner.last_mc_samples()
        return *runner.last_mc_logZ(), problem.theta(samples["X"]), samples["w"]

    return runner.run, result


def nautilus(problem, seed):
    from nautilus import Sampler
    sampler = Sampler(lambda cube: cube, problem.log_density, problem.dimension, seed=seed)

    def result():
        points, log_weights, _ = sampler.posterior()
        return sampler.log_z, float("nan"), problem.theta(points), np.exp(log_weights)

    return sampler.run, result


def dynesty(problem, seed):
    from dynesty import NestedSampler
    sampler = NestedSampler(problem.log_density, lambda cube: cube, problem.dimension, rstate=np.random.default_rng(seed))

    def result():
        results = sampler.results
        return results.logz[-1], results.logzerr[-1], problem.theta(results.samples), results.importance_weights()

    return lambda: sampler.run_nested(print_progress=False), result


def serve(problem):
    """A UM-Bridge server, on a thread, whose model takes the number of a residual in tenths and the parameters, and gives the residual."""

    class Handler(http.server.BaseHTTPRequestHandler):
        protocol_version, disable_nagle_algorithm = "HTTP/1.1", True

        def handle_one_request(self):
            began = time.thread_time()
            super().handle_one_request()
            problem.seconds += time.thread_time() - began

        def answer(self, value):
            body = json.dumps(value).encode()
            self.send_response(200)
            self.send_header("Content-Length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)

        def do_GET(self):
            self.answer({"protocolVersion": 1.0, "models": ["problem"]})

        def do_POST(self):
            body = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
            if self.path == "/Evaluate":
                (slip,), theta = body["input"]
                return self.answer({"output": [[problem.residuals(np.array(theta))[round(10 * slip) - 1]]]})
            support = {"Evaluate": True, "Gradient": False, "ApplyJacobian": False, "ApplyHessian": False}
            self.answer({"support": support, "inputSizes": [1, problem.dimension], "outputSizes": [1]})

        def log_message(self, *_):
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    return f"http://127.0.0.1:{server.server_port}"


def write_job(problem, seed, folder):
    """Writes the job of a problem; returns the options of the command line that it needs, and nats of ln L beyond the density of its data."""
    sampler = f'[sampler]\nseed = {seed}\nstages = "emulated"\n'
    if problem.is_example:
        for name in ("experiment.toml", "runs.csv"):
            shutil.copy(EXAMPLE / name, folder)
        job = (EXAMPLE / "job.toml").read_text().split("[sampler]")[0]
        (folder / "job.toml").write_text(job + sampler)
        return [], 0.0
    url, count = serve(problem), len(problem.residuals(problem.theta(np.full(problem.dimension, 0.5))))
    names = [f"x_{i}" for i in range(problem.dimension)]
    model = f'kind = "umbridge"\nurl = "{url}"\nmodel = "problem"\nversion = "1"\ninputs = ["slip"]\noutputs = ["drawbar_pull_n"]\n'
    model += f"parameters = {json.dumps([name + ' [1]' for name in names])}\n"
    priors = "".join(f"{name} = {{ {', '.join(f'{key} = {value}' for key, value in prior.job.items())} }}\n"
                     for name, prior in zip(names, problem.priors))
    (folder / "job.toml").write_text(f'experiment = "experiment.toml"\n[model]\n{model}[priors]\n{priors}{sampler}')
    wheel = "[wheel.w]\nradius_m = 0.125\nwidth_m = 0.112\ngrouser_count = 0\n[soil.s]\n"
    (folder / "experiment.toml").write_text(f'runs = "runs.csv"\n{wheel}[noise]\ndrawbar_pull_n = 1.0\n')
    runs = "".join(f"r{i},w,s,{0.1 * (i + 1):.1f},60.0,0.01,0,1,0.0,fit\n" for i in range(count))
    (folder / "runs.csv").write_text("run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,slip_angle_deg,pass,drawbar_pull_n,use\n" + runs)
    return ["--accept", "data_few", "--allow-model", url], problem.constant + count * LN_SQRT_TAU


def grouser(problem, seed):
    temporary = tempfile.TemporaryDirectory()
    atexit.register(temporary.cleanup)
    folder = pathlib.Path(temporary.name)
    options, beyond = write_job(problem, seed, folder)

    def run():
        command = ["coordinator", "run", folder / "job.toml", "--out", folder / "out", "--local-workers", "1", *options]
        ended = subprocess.run(command, capture_output=True, text=True)
        if ended.returncode != 0:
            raise RuntimeError(ended.stderr.strip())

    def result():
        summary = json.loads((folder / "out/summary.json").read_text())["calibrations"][0]
        problem.evaluations = summary["evaluations"]
        draws = np.loadtxt(folder / "out/posterior.csv", delimiter=",", skiprows=1)[:, 2:]
        return summary["log_evidence"] + beyond, summary["log_evidence_se"], draws, None

    return run, result
