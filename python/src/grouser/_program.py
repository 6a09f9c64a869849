"""The program that comes with the package: where it lies, how it is called."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sysconfig
import threading
import weakref
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from ._error import GrouserError, ProgramError

NAME = "coordinator"
# The log line of a service that has taken its address.
SERVING = re.compile(r"serving\b.*\baddress=(\S+)")
STARTUP_S = 30.0


def find() -> Path:
    """The program ``coordinator``: that of this installation, else the first on the path.

    Raises:
        GrouserError: there is none.
    """
    package = Path(__file__).resolve().parent.parent
    schemes = [sysconfig.get_path("scripts"), sysconfig.get_path("scripts", f"{os.name}_user")]
    # Installed with `pip install --target`, the programs lie beside the package.
    for folder in [*schemes, str(package / "bin")]:
        program = Path(folder) / NAME
        if program.is_file() and os.access(program, os.X_OK):
            return program
    found = shutil.which(NAME)
    if found is None:
        raise GrouserError(f"the program {NAME} is neither in {schemes[0]} nor on the path")
    return Path(found)


def call(
    arguments: Sequence[str],
    environment: Mapping[str, str] | None = None,
    on_line: Callable[[str], None] | None = None,
) -> str:
    """Runs a command to its end and returns what it prints.

    Args:
        arguments: verb and options.
        environment: variables beside those of this process.
        on_line: told each line of the error stream as it is written.

    Raises:
        ProgramError: it failed; the message is the program's.
        KeyboardInterrupt: the program has been stopped, too; the same command goes on where it was.
    """
    process = subprocess.Popen(
        [str(find()), *arguments],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env={**os.environ, **(environment or {})},
        text=True,
        encoding="utf-8",
        errors="replace",
    )
    assert process.stdout is not None and process.stderr is not None
    printed: list[str] = []
    reading = threading.Thread(target=lambda out: printed.append(out.read()), args=(process.stdout,), daemon=True)
    reading.start()
    said: list[str] = []
    try:
        for line in process.stderr:
            said.append(line.rstrip("\n"))
            if on_line is not None:
                on_line(said[-1])
        status = process.wait()
    except BaseException:
        process.terminate()
        process.wait()
        raise
    finally:
        reading.join()
        process.stdout.close()
        process.stderr.close()
    if status != 0:
        raise ProgramError(_reason(said) or f"{NAME} ended with {status}", status)
    return printed[0]


def _reason(said: Sequence[str]) -> str:
    """The error that a program ended with: its last ``error:`` and what follows it."""
    starts = [i for i, line in enumerate(said) if line.startswith("error:")]
    if not starts:
        return said[-1] if said else ""
    return "\n".join(said[starts[-1] :]).removeprefix("error:").strip()


class LocalService:
    """A service on this machine alone, at a free port of the loopback address; it ends with this object, or when Python ends orderly.

    While it is there, every user of this machine can use it through that port.

    Args:
        store: its SQLite file.
        read_only: it shows what the store holds and changes nothing.

    Attributes:
        url: its address.
    """

    def __init__(self, store: Path, *, read_only: bool) -> None:
        command = [str(find()), "serve", "--listen", "127.0.0.1:0", "--store", f"sqlite://{store}"]
        command += ["--read-only"] if read_only else []
        # Settings of another service in the environment do not count, and the address is read from the log.
        environment = {k: v for k, v in os.environ.items() if not k.startswith("GROUSER_")}
        process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            env={**environment, "RUST_LOG": "info"},
            text=True,
            encoding="utf-8",
            errors="replace",
        )
        self.close = weakref.finalize(self, _stop, process)
        timer = threading.Timer(STARTUP_S, process.kill)
        timer.start()
        try:
            self.url = f"http://{_address(process)}"
        finally:
            timer.cancel()


def _address(process: subprocess.Popen[str]) -> str:
    assert process.stderr is not None
    said: list[str] = []
    for line in process.stderr:
        said.append(line.rstrip("\n"))
        serving = SERVING.search(line)
        if serving:
            # A pipe that nobody reads would fill up and halt the service.
            threading.Thread(target=_drain, args=(process,), daemon=True).start()
            return serving.group(1)
    status = process.wait()
    raise ProgramError(_reason(said) or f"{NAME} serve ended with {status}", status)


def _drain(process: subprocess.Popen[str]) -> None:
    assert process.stderr is not None
    try:
        for _ in process.stderr:
            pass
    except ValueError:
        # Closed while it was read: the service has been stopped.
        pass


def _stop(process: subprocess.Popen[str]) -> None:
    if process.poll() is None:
        process.terminate()
        try:
            process.wait(timeout=5)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
