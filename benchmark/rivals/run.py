#!/usr/bin/env python3
"""Emulated sampling beside PyVBMC, GPry, nautilus and dynesty on problems with known evidence.

run.py [--seeds N] [--methods M,...] [--problems P,...] [--results FILE] prints a Markdown table. Runs are appended to the file, and not repeated
if they are in it. `coordinator` and `worker` must be in the path, and the packages of requirements.txt installed. A run has 15 minutes.
"""
import argparse
import json
import os
import pathlib
import resource
import signal
import time

for library in ("OMP", "OPENBLAS", "MKL"):
    os.environ[f"{library}_NUM_THREADS"] = "1"
import numpy as np

import method
import problem

LIMIT_S = 900
METHODS = {name: getattr(method, name) for name in ("grouser", "pyvbmc", "gpry", "nautilus", "dynesty")}
PROBLEMS = {
    "a": problem.correlated_gaussian,
    "b": problem.shear_building,
    "c2": problem.thin_ridge,
    "hidden-effect": problem.hidden_effect,
}


class TimeUp(BaseException):
    """The time of a run is over; not an `Exception`, which a method might catch."""


def end_run(*_):
    raise TimeUp


def cpu_s():
    """CPU time of this process and of those that have ended."""
    ended = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + ended.ru_utime + ended.ru_stime


def sample(target, name, seed):
    """Runs a method, and returns what it found as JSON."""
    found = {"seed": seed}
    try:
        run, result = METHODS[name](target, seed)
        began = time.monotonic(), cpu_s(), target.seconds
        signal.setitimer(signal.ITIMER_REAL, LIMIT_S)
        try:
            run()
        except TimeUp:
            found["end"] = "not finished in 15 min"
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
            found["wall_s"] = time.monotonic() - began[0]
            found["own_s"] = cpu_s() - began[1] - (target.seconds - began[2])
        log_evidence, se, thetas, weights = result()
        mean = np.average(thetas, axis=0, weights=weights)
        sd = np.sqrt(np.average((thetas - mean) ** 2, axis=0, weights=weights))
        found |= {"error": log_evidence - target.log_evidence, "se": se}
        found |= {"mean": list((mean - target.mean) / target.sd), "sd": list(sd / target.sd - 1)}
    except Exception as error:
        found.setdefault("end", f"{type(error).__name__}: {error}".split(". ")[0])
    return found | {"evaluations": target.evaluations}


def row(name, of, runs):
    """A line of the table: means over the seeds, root mean squares of errors."""
    finished = [run for run in runs if "error" in run]
    mean = lambda key, runs: np.mean([run[key] for run in runs])
    rms = lambda key: np.sqrt(np.mean([np.square(run[key]) for run in finished], axis=0))
    cells = [of, name, str(len(runs)), f"{mean('evaluations', runs):,.0f}"]
    if finished:
        se = mean("se", finished)
        cells += [f"{rms('error'):.3f}", "–" if np.isnan(se) else f"{se:.3f}"]
        cells += [" ".join(f"{error:.2f}" for error in rms(key)) for key in ("mean", "sd")]
    else:
        cells += ["–"] * 4
    cells.append(f"{mean('own_s', runs):.1f}" if all("own_s" in run for run in runs) else "–")
    cells.append("; ".join(sorted({run["end"] for run in runs if "end" in run})))
    return "| " + " | ".join(cells) + " |"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--methods", default=",".join(METHODS))
    parser.add_argument("--problems", default=",".join(PROBLEMS))
    parser.add_argument("--results", type=pathlib.Path, default=pathlib.Path("rivals.jsonl"))
    options = parser.parse_args()
    signal.signal(signal.SIGALRM, end_run)
    known = [json.loads(line) for line in options.results.read_text().splitlines()] if options.results.exists() else []
    runs = {(run["problem"], run["method"], run["seed"]): run for run in known}
    for of in options.problems.split(","):
        for name in options.methods.split(","):
            for seed in range(1, options.seeds + 1):
                if (of, name, seed) in runs:
                    continue
                run = {"problem": of, "method": name} | sample(PROBLEMS[of](), name, seed)
                runs[of, name, seed] = run
                with open(options.results, "a") as file:
                    print(json.dumps(run), file=file)
    print("| problem | method | seeds | evaluations | error of ln Z | stated | errors of means, sds | errors of sds | own CPU s | |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    for of in PROBLEMS:
        for name in METHODS:
            some = [run for (its, by, _), run in runs.items() if (its, by) == (of, name)]
            if some:
                print(row(name, of, some))


if __name__ == "__main__":
    main()
