"""A service on this machine, a calibration by whatever workers there are, and the same by a local run."""

import json
import os
import pathlib
import signal
import subprocess
import time
import urllib.request

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXPERIMENT = ROOT / "tests/data/nothing-hidden"

JOB = """experiment = "experiment.toml"

[model]
kind = "scm"
dem_spacing_m = 0.003
travel_step_m = 0.0005
steady_travel_m = {travel}

[priors]
log10_p_ref = {{ uniform = [4.0, 5.6] }}
kappa = 0.0
n = {{ uniform = [0.8, 1.6] }}
friction_angle_deg = {{ normal = [30.0, 5.7], bounds = [11.5, 37.3] }}
shear_velocity_m_s = {{ uniform = [1e-4, 5e-3] }}

[sampler]
particles = {particles}
moves = [2, 4]
seed = {seed}
"""


def write_job(folder, particles=60, travel=1.6, seed=1):
    """Six runs of a rolling wheel: evaluations of some hundredths of a second."""
    folder.mkdir(parents=True)
    (folder / "experiment.toml").write_text((EXPERIMENT / "experiment.toml").read_text())
    rows = [row for row in (EXPERIMENT / "runs.csv").read_text().splitlines() if not row.startswith("#")]
    (folder / "runs.csv").write_text("\n".join(rows[:7]) + "\n")
    job = folder / "job.toml"
    job.write_text(JOB.format(particles=particles, travel=travel, seed=seed))
    return job


def local_run(programs, job, folder):
    """The posterior of a run without a farm."""
    command = [programs / "coordinator", "run", job, "--out", folder, *ACCEPT]
    subprocess.run(command, check=True, capture_output=True)
    return (folder / "posterior.csv").read_bytes()


# Few measurements for four parameters, and quick to compute.
ACCEPT = ["--accept", "data_few"]


def until(what, condition, timeout_s=120.0, every_s=0.05):
    """Waits until a condition holds; its value."""
    end = time.monotonic() + timeout_s
    while time.monotonic() < end:
        value = condition()
        if value:
            return value
        time.sleep(every_s)
    raise TimeoutError(f"{what}: not within {timeout_s} s")


class Service:
    """`coordinator serve` with its verbs."""

    def __init__(self, programs, folder, *options):
        folder.mkdir(parents=True, exist_ok=True)
        self.coordinator, self.folder = programs / "coordinator", folder
        self.log = folder / "service.log"
        serve = [self.coordinator, "serve", "--listen", "127.0.0.1:0", "--store", f"sqlite://{folder}/grouser.db", *options]
        self.process = subprocess.Popen(serve, stderr=self.log.open("w"), env=os.environ | {"NO_COLOR": "1"})
        self.url = "http://" + until("the service", self._address)

    def _address(self):
        lines = [line for line in self.log.read_text().splitlines() if "address=" in line]
        return lines and lines[0].split("address=")[1].split()[0]

    def get(self, path):
        with urllib.request.urlopen(self.url + path, timeout=10) as answer:
            return answer.read().decode()

    def json(self, path):
        return json.loads(self.get(path))

    def metric(self, name):
        lines = (line.split() for line in self.get("/metrics").splitlines())
        return sum(float(line[1]) for line in lines if line and line[0] == name)

    def submit(self, job):
        """The number of a new calibration."""
        command = [self.coordinator, "submit", job, "--url", self.url, *ACCEPT]
        before = {row["id"] for row in self.json("/v1/calibrations")}
        subprocess.run(command, check=True, capture_output=True)
        return next(row["id"] for row in self.json("/v1/calibrations") if row["id"] not in before)

    def status(self, calibration):
        return self.json(f"/v1/calibrations/{calibration}")

    def cancel(self, calibration):
        command = [self.coordinator, "cancel", str(calibration), "--url", self.url]
        subprocess.run(command, check=True, capture_output=True)

    def evaluations(self, calibration):
        return (self.status(calibration)["progress"] or {"evaluations": 0})["evaluations"]

    def finished(self, calibration):
        status = self.status(calibration)
        assert status["state"] in ("queued", "running", "finished"), status
        return status["state"] == "finished"

    def posterior(self, calibration):
        command = [self.coordinator, "export", str(calibration), "--url", self.url, "--format", "csv"]
        return subprocess.run(command, check=True, capture_output=True).stdout

    def stop(self):
        self.process.send_signal(signal.SIGTERM)
        self.process.wait(30)


class Scale:
    """`coordinator scale` for an engine."""

    def __init__(self, service, engine, folder, *options, more=()):
        self.log = folder / "scale.log"
        command = [service.coordinator, "scale", engine.name, "--url", service.url, "--threads", "1", "--every", "0.5",
                   "--finish-within", "1", "--max-idle", "2", *options, "--", *engine.options(folder), *more]
        self.process = subprocess.Popen(command, stderr=self.log.open("w"), env=os.environ | {"NO_COLOR": "1"})

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGTERM)
        self.process.wait(30)


def from_nothing(engine, service, folder, job, expected):
    """No pilot before the job, pilots for it, none after it."""
    with Scale(service, engine, folder, "--max", "3"):
        time.sleep(2)
        assert engine.present() == [], "pilots without work"
        submitted = time.monotonic()
        calibration = service.submit(job)
        until("a pilot that runs", engine.running)
        runs = time.monotonic()
        until("an evaluation", lambda: service.evaluations(calibration) > 0)
        first_s, whole_s = time.monotonic() - runs, time.monotonic() - submitted
        until("several pilots", lambda: len(engine.running()) == 3)
        workers = service.json("/v1/workers").values()
        assert all(worker["queue_job"].startswith(engine.word) for worker in workers), workers
        until("the posterior", lambda: service.finished(calibration), 300)
        took_s = time.monotonic() - submitted
        assert service.posterior(calibration) == expected, "other bits than a local run"
        until("an empty queue", lambda: not engine.present())
    print(f"{engine.name}: first evaluation {whole_s:.1f} s after the job came and {first_s:.2f} s after a pilot ran, "
          f"posterior in {took_s:.0f} s, then no pilot; the bits of a local run")
