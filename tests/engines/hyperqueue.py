"""A farm by HyperQueue: a server and a machine of its own here, from nothing to a posterior. Needs `hq` in PATH."""

import json
import os
import pathlib
import signal
import subprocess
import sys

from farm import Service, from_nothing, local_run, until, write_job


class HyperQueue:
    """A server with one machine of four cores."""

    name, word = "hyperqueue", "hq "

    def __init__(self, folder):
        folder.mkdir(parents=True)
        os.environ["HQ_SERVER_DIR"] = str(folder)
        log = (folder / "log").open("w")
        start = {"stdout": log, "stderr": log, "cwd": folder}
        self.daemons = [subprocess.Popen(["hq", "server", "start"], **start)]
        until("the server", lambda: _hq("server", "info").returncode == 0)
        self.daemons.append(subprocess.Popen(["hq", "worker", "start", "--cpus=4"], **start))
        until("a machine", lambda: len(json.loads(_hq("--output-mode=json", "worker", "list").stdout)) == 1)

    @staticmethod
    def options(folder):
        """Where a pilot writes its log."""
        return [f"--cwd={folder}"]

    def running(self):
        return [job for job in self.present() if job["task_stats"]["running"]]

    def present(self):
        return json.loads(_hq("--output-mode=json", "job", "list").stdout)

    def stop(self):
        _hq("server", "stop")
        for daemon in self.daemons:
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                daemon.send_signal(signal.SIGKILL)


def _hq(*arguments):
    return subprocess.run(["hq", *arguments], capture_output=True, text=True)


def main():
    programs, folder = map(pathlib.Path, sys.argv[1:3])
    os.environ["GROUSER_WORKER"] = str(programs / "worker")
    job = write_job(folder / "job")
    expected = local_run(programs, job, folder / "local")
    engine = HyperQueue(folder / "hq")
    try:
        service = Service(programs, folder / "service", "--lease-ms", "3000")
        try:
            from_nothing(engine, service, folder, job, expected)
        finally:
            service.stop()
    finally:
        engine.stop()


main()
