"""Sends generated requests to every route of openapi.json, by schemathesis, and watches the service.

    python tests/fuzz/routes.py FOLDER [--examples N] [--seconds S] [--seed N]

FOLDER has the programs coordinator and worker, as target/release. It fails on a status 5xx, on an answer that openapi.json does not describe, on a panic, on connections left open, and where the
service holds more than GROWTH_MIB more than before.
"""

import argparse
import os
import pathlib
import re
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import urllib.request

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
GROWTH_MIB = 48
# By then trim.c has given back what is free.
TRIMMED_S = 3
CHECKS = "not_a_server_error,status_code_conformance,content_type_conformance,response_schema_conformance"


def get(url):
    with urllib.request.urlopen(url, timeout=30) as response:
        return response.read().decode()


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def anonymous_mib(pid):
    """Resident memory without the pages of files."""
    status = pathlib.Path(f"/proc/{pid}/status").read_text()
    return int(re.search(r"RssAnon:\s+(\d+)", status)[1]) / 1024


def descriptors(pid):
    return len(os.listdir(f"/proc/{pid}/fd"))


def requests(url):
    return sum(int(count) for count in re.findall(r"^grouser_requests_total\{.*\} (\d+)$", get(url + "/metrics"), re.M))


def start(programs, folder):
    """A service on a store that has a finished study with a search, its worker, and its URL."""
    store = pathlib.Path(folder, "store")
    shutil.copytree(ROOT / "examples/hidden-effect", pathlib.Path(folder, "example"))
    job = pathlib.Path(folder, "example/job.toml")
    job.write_text(job.read_text().replace("[sampler]", '[sampler]\nalgorithm = "lm"'))
    coordinator = pathlib.Path(programs, "coordinator")
    subprocess.run([coordinator, "run", job, "--out", store], check=True, stdout=subprocess.DEVNULL)
    address = f"127.0.0.1:{free_port()}"
    log = open(pathlib.Path(folder, "log"), "w")
    serve = [coordinator, "serve", "--listen", address, "--store", f"sqlite://{store}/grouser.db"]
    # What grows is to be what the service holds. An allocator also keeps free pieces, by chance up to twice that, unless it is told to
    # give them back; and each of glibc's arenas has pieces that others cannot use.
    trim = pathlib.Path(folder, "trim.so")
    subprocess.run(["cc", "-shared", "-fPIC", "-pthread", "-o", trim, HERE / "trim.c"], check=True)
    environment = os.environ | {"LD_PRELOAD": str(trim), "MALLOC_ARENA_MAX": "1"}
    service = subprocess.Popen(serve, stdout=log, stderr=log, env=environment)
    work = [pathlib.Path(programs, "worker"), "--coordinator", f"http://{address}", "--threads", "1"]
    worker = subprocess.Popen(work, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    for _ in range(100):
        try:
            get(f"http://{address}/v1/calibrations/1/report")
            if trim.name not in pathlib.Path(f"/proc/{service.pid}/maps").read_text():
                sys.exit(f"{trim} was not preloaded")
            return service, worker, f"http://{address}"
        except OSError:
            time.sleep(0.1)
    sys.exit("the service does not answer")


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("programs")
    arguments.add_argument("--examples", type=int, default=30, help="generated requests for each route")
    arguments.add_argument("--seconds", type=int, help="go on with new requests for so long")
    arguments.add_argument("--seed", type=int, default=1)
    asked = arguments.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        service, worker, url = start(asked.programs, folder)
        try:
            time.sleep(TRIMMED_S)
            before = anonymous_mib(service.pid), descriptors(service.pid)
            command = [sys.executable, "-m", "schemathesis.cli", "run", f"{url}/openapi.json", "--checks", CHECKS]
            command += ["--seed", str(asked.seed), "-n", str(asked.examples), "--continue-on-failure", "--no-shrink"]
            command += ["--request-timeout", "40", "--warnings", "off", "--suppress-health-check", "all"]
            command += ["--max-time", str(asked.seconds)] if asked.seconds else []
            environment = os.environ | {"SCHEMATHESIS_HOOKS": "hooks", "PYTHONPATH": str(HERE), "PYTHONDONTWRITEBYTECODE": "1"}
            refused = subprocess.run(command, cwd=folder, env=environment).returncode
            if service.poll() is not None:
                sys.exit("the service has ended")
            sent = requests(url)
            time.sleep(TRIMMED_S)
            after = anonymous_mib(service.pid), descriptors(service.pid)
            log = pathlib.Path(folder, "log").read_text()
        finally:
            for process in (worker, service):
                process.terminate()
                process.wait(30)
    print(f"{sent} requests; memory {before[0]:.1f} MiB before, {after[0]:.1f} MiB after; {after[1]} descriptors, {before[1]} before")
    faults = [line for line in log.splitlines() if "panicked" in line or "internal error" in line]
    if refused or faults or after[0] - before[0] > GROWTH_MIB or after[1] > before[1] + 8:
        sys.exit("\n".join(["failed: see above"] + faults[:20]))


main()
