#!/usr/bin/env python3
"""The search of formulas beside other programs, on generated laws whose formulas are known.

    cargo bench -p equation --bench recovery -- --seed 2 --laws 200 --cases cases.jsonl
    formula.py cases.jsonl [--methods M,...] [--laws N] [--results FILE]

A method is given the points, the noisy values and their standard deviation, and returns the formula that it prefers, then the others that
it offers, each as text over x. A formula is the truth if, its constants fitted again, it gives the curve without noise to 1e-4 of its root
mean square, with as many constants as the truth has; `+1` allows one more. A run has a minute of CPU time. Runs are appended to the results and not repeated.
To enter, add a function to METHODS. Packages: formula-requirements.txt.
"""
import argparse
import json
import logging
import os
import pathlib
import signal
import time
import warnings

for library in ("OMP", "OPENBLAS", "MKL"):
    os.environ[f"{library}_NUM_THREADS"] = "1"
import numpy as np
import sympy
from scipy.optimize import least_squares

LIMIT_S = 60
EXACT = 1e-4
warnings.filterwarnings("ignore")
logging.disable(logging.INFO)


def pyoperon(x, y, sd):
    from pyoperon.sklearn import SymbolicRegressor
    symbols = "add,sub,mul,div,pow,exp,log,tanh,sqrt,square,constant,variable"
    model = SymbolicRegressor(allowed_symbols=symbols, objectives=["r2", "length"], max_length=15, max_time=LIMIT_S, max_evaluations=10**8,
                              uncertainty=[sd], random_state=1)
    model.fit(x[:, None], y)
    text = lambda tree: model.get_model_string(tree, precision=12).replace("X1", "x").replace("^", "**")
    return [text(model.model_)] + [text(entry["tree"]) for entry in model.pareto_front_]


def bms(x, y, sd):
    from autora.theorist.bms import BMSRegressor
    model = BMSRegressor(epochs=300)
    model.fit(x[:, None], y[:, None])
    text, values = str(model.model_), next(iter(model.model_.par_values.values()))
    for name, value in values.items():
        text = text.replace(name, f"({float(value)!r})")
    return [text.replace("X0", "x")]


def adcd(x, y, sd):
    import adcd
    answer = adcd.fit({"x": x}, y, np.zeros_like(x), limit_variable="x", correction_mode="additive", verbose=False)
    text = str(answer.best_expr)
    for name, value in answer.search_result.best_theta.items():
        text = text.replace(name, f"({float(value)!r})")
    return [text]


METHODS = {"pyoperon": pyoperon, "bms": bms, "adcd": adcd}


def parameters(text):
    """A formula with a symbol for each constant, and their values. Whole exponents, halves and ones are no constants."""
    symbols, values = [], []

    def held(number):
        return number in (0, 1, -1, 2, -2) or abs(number) == sympy.Rational(1, 2)

    def replaced(node):
        if node.is_Number or node.is_NumberSymbol:
            exact = sympy.nsimplify(node) if abs(float(node) - round(2 * float(node)) / 2) < 1e-9 else node
            if held(exact):
                return exact
            symbols.append(sympy.Symbol(f"c{len(symbols)}"))
            values.append(float(node))
            return symbols[-1]
        return node.func(*map(replaced, node.args)) if node.args else node

    return replaced(sympy.sympify(text)), symbols, np.array(values)


def verdict(case, text):
    """Constants of a formula beyond those of the truth if it is the truth; None if it is not."""
    x, exact = np.array(case["points"]), np.array(case["exact"])
    size = np.sqrt(np.mean(exact**2))
    formula, symbols, values = parameters(text)
    function = sympy.lambdify([sympy.Symbol("x"), *symbols], formula, "numpy")
    residuals = lambda c: np.nan_to_num(np.real(function(x + 0j, *c)) + 0 * x - exact, nan=1e6, posinf=1e6, neginf=-1e6) / (EXACT * size)
    best = residuals(values)
    if len(values) and 0.5 * best @ best >= 5:
        best = least_squares(residuals, values, x_scale=np.maximum(np.abs(values), 1e-3), max_nfev=300).fun
    return len(symbols) - case["constants"] if 0.5 * best @ best < 5 else None


def judge(case, formulas):
    """Whether the first formula, and any, is the truth with at most 0 and at most 1 constants more."""
    more = []
    for text in formulas:
        try:
            more.append(verdict(case, text))
        except (ValueError, TypeError, SyntaxError, AttributeError, OverflowError, sympy.SympifyError):
            more.append(None)
    is_true = lambda extra, allowed: extra is not None and extra <= allowed
    return {"first": [is_true(more[0], k) for k in (0, 1)], "any": [any(is_true(m, k) for m in more) for k in (0, 1)]}


class TimeUp(BaseException):
    """The time of a run is over; not an `Exception`, which a method might catch."""


def end_run(*_):
    raise TimeUp


def run(case, name):
    signal.setitimer(signal.ITIMER_PROF, LIMIT_S)
    began = time.process_time()
    try:
        formulas = METHODS[name](np.array(case["points"]), np.array(case["values"]), case["sd"])
    except (TimeUp, Exception) as error:  # a method may fail in any way
        formulas = [f"failed: {type(error).__name__}"]
    signal.setitimer(signal.ITIMER_PROF, 0)
    seconds = time.process_time() - began
    return {"formulas": formulas, "seconds": seconds, **judge(case, formulas)}


def table(cases, results):
    print("| method | noise | laws | its formula is the truth (+1 constant) | among those it offers (+1) | s |\n|---|---|---|---|---|---|")
    for noise in (0.01, 0.1):
        ours = [case for case in cases if case["noise"] == noise]
        share = lambda values: f"{np.mean(list(values)):.2f}" if len(ours) else "-"
        print(f"| Grouser | {noise:.0%} | {len(ours)} | {share(c['simplest'] for c in ours)} | {share(c['in_class'] for c in ours)} "
              f"| {np.mean([c['seconds'] for c in ours]):.1f} |")
        for name in METHODS:
            runs = [r for r in results if r["method"] == name and r["noise"] == noise]
            if runs:
                mean = lambda key, k: f"{np.mean([r[key][k] for r in runs]):.2f}"
                print(f"| {name} | {noise:.0%} | {len(runs)} | {mean('first', 0)} ({mean('first', 1)}) | {mean('any', 0)} ({mean('any', 1)}) "
                      f"| {np.mean([r['seconds'] for r in runs]):.1f} |")


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("cases", type=pathlib.Path)
    arguments.add_argument("--methods", default=",".join(METHODS))
    arguments.add_argument("--laws", type=int, default=200, help="laws of each noise for the other methods")
    arguments.add_argument("--results", type=pathlib.Path, default=pathlib.Path("formula-results.jsonl"))
    chosen = arguments.parse_args()
    signal.signal(signal.SIGPROF, end_run)
    cases = [json.loads(line) for line in chosen.cases.read_text().splitlines()]
    read = chosen.results.read_text().splitlines() if chosen.results.exists() else []
    results = [json.loads(line) for line in read]
    done = {(r["method"], r["noise"], r["number"]) for r in results}
    for name in filter(None, chosen.methods.split(",")):
        for noise in (0.01, 0.1):
            for number, case in enumerate([c for c in cases if c["noise"] == noise][: chosen.laws]):
                if (name, noise, number) not in done:
                    results.append({"method": name, "noise": noise, "number": number, "law": case["law"], **run(case, name)})
                    with chosen.results.open("a") as file:
                        file.write(json.dumps(results[-1]) + "\n")
    table(cases, results)


if __name__ == "__main__":
    main()
