"""A model served by the PyPI package umbridge is calibrated to the same bits as the same model as a program: server.py COORDINATOR FOLDER."""

import re
import shutil
import socket
import subprocess
import sys
import time
from pathlib import Path

EXAMPLE = Path("examples/any-model")
MODEL = """
import sys
import umbridge
from server import INPUTS, PARAMETERS, SIZES
from wheel import wheel

class Wheel(umbridge.Model):
    def get_input_sizes(self, config):
        return SIZES
    def get_output_sizes(self, config):
        return [3]
    def supports_evaluate(self):
        return True
    def __call__(self, parameters, config):
        channels = wheel(**dict(zip(INPUTS + PARAMETERS, sum(parameters, []))))
        return [[channels[name] for name in ("drawbar_pull_n", "torque_n_m", "sinkage_m")]]

umbridge.serve_models([Wheel("wheel")], int(sys.argv[1]))
"""


def calibrated(coordinator: str, folder: Path, job: str, allowed: str) -> str:
    """The posterior of a job of the example, without its search."""
    text = (folder / job).read_text().split("[discovery]")[0]
    (folder / job).write_text(text)
    out = folder / f"out-{job}"
    command = [coordinator, "run", str(folder / job), "--out", str(out), "--allow-model", allowed]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    export = [coordinator, "export", "1", "--out", str(out), "--format", "csv", "--output", str(folder / "posterior.csv")]
    subprocess.run(export, check=True, capture_output=True)
    return (folder / "posterior.csv").read_text()


def wait(server: subprocess.Popen[bytes], port: int) -> None:
    """Waits until the server listens."""
    for _ in range(600):
        assert server.poll() is None, "the server has ended"
        with socket.socket() as probe:
            if probe.connect_ex(("127.0.0.1", port)) == 0:
                return
        time.sleep(0.1)
    raise AssertionError("the server does not listen")


def check(coordinator: str, folder: Path) -> None:
    """Calibrates by server and by program."""
    for file in EXAMPLE.iterdir():
        shutil.copy(file, folder)
    (folder / "by_package.py").write_text(MODEL)
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        port = listener.getsockname()[1]
    url = f"http://127.0.0.1:{port}"
    job = folder / "job.toml"
    job.write_text(re.sub(r"http://127.0.0.1:\d+", url, job.read_text()))
    log = open(folder / "server.log", "w", encoding="utf-8")
    server = subprocess.Popen([sys.executable, "by_package.py", str(port)], cwd=folder, stdout=log, stderr=log)
    try:
        wait(server, port)
        by_server = calibrated(coordinator, folder, "job.toml", url)
    finally:
        server.kill()
        server.wait()
    by_program = calibrated(coordinator, folder, "command.toml", str(folder / "wheel.py"))
    assert by_server == by_program, "the two posteriors differ"
    print(f"{len(by_server.splitlines()) - 1} draws, the same by server and by program")


if __name__ == "__main__":
    check(sys.argv[1], Path(sys.argv[2]))
