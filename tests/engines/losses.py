"""What killed workers cost: two farms side by side, in one of which a fifth of the workers is killed each minute.

`tests/engines/losses.py PROGRAMS FOLDER MINUTES`, as in `target/release /tmp/losses 5`; not part of CI.
"""

import os
import pathlib
import subprocess
import sys
import time

from farm import Service, until, write_job

WORKERS = 5
MOST_LOST_PERCENT = 2.0


class Farm:
    """A service with workers whose CPU time is counted to the last, killed or not."""

    def __init__(self, programs, folder, job):
        self.worker = programs / "worker"
        self.service = Service(programs, folder, "--lease-ms", "3000", "--verify-percent", "0")
        self.calibration = self.service.submit(job)
        self.cpu_s = 0.0
        self.workers = [self.start() for _ in range(WORKERS)]

    def start(self):
        command = [self.worker, "--coordinator", self.service.url, "--threads", "1"]
        return subprocess.Popen(command, stderr=subprocess.DEVNULL)

    def end(self, worker, how):
        how(worker)
        _, _, usage = os.wait4(worker.pid, 0)
        worker.returncode = 0
        self.cpu_s += usage.ru_utime + usage.ru_stime

    def kill_oldest(self):
        self.end(self.workers.pop(0), subprocess.Popen.kill)
        self.workers.append(self.start())

    def stop(self):
        """Evaluations per second of CPU time."""
        for worker in self.workers:
            self.end(worker, subprocess.Popen.terminate)
        evaluations = self.service.evaluations(self.calibration)
        self.service.stop()
        return evaluations / self.cpu_s, evaluations


def main():
    programs, folder, minutes = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), float(sys.argv[3])
    job = write_job(folder / "job", particles=20_000, travel=40.0)
    quiet, disturbed = (Farm(programs, folder / name, job) for name in ("quiet", "disturbed"))
    for farm in (quiet, disturbed):
        until("evaluations", lambda: farm.service.evaluations(farm.calibration) > WORKERS, 120)
    end, kills = time.monotonic() + 60.0 * minutes, 0
    while time.monotonic() < end:
        time.sleep(60.0 / (0.2 * WORKERS))
        disturbed.kill_oldest()
        kills += 1
    (expected, count), (rate, disturbed_count) = quiet.stop(), disturbed.stop()
    lost = 100.0 * (1.0 - rate / expected)
    print(f"{minutes:g} min, {WORKERS} workers, {1.0 / expected:.2f} s of CPU for an evaluation ({count} and {disturbed_count} evaluations), "
          f"{kills} killed: {lost:.2f} % of the CPU time lost")
    assert lost <= MOST_LOST_PERCENT, lost


main()
