#!/usr/bin/env python3
"""Missing Effect 500: blind campaigns of a wheel in a soil bin, from a generator that shares no code with Grouser.

    generate.py FOLDER [--campaigns 500] [--seed 1] [--jobs 1]

FOLDER/campaigns/NNN gets job.toml, experiment.toml and runs.csv; FOLDER/truth.jsonl says what is hidden, one line for each campaign. A campaign is
a function of the seed and its number, so the first hundred of 500 are those of `--campaigns 100`. What the kinds are stands in README.md.
"""
import argparse
import json
import multiprocessing
import os
import pathlib

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
import numpy as np

import faults
import laws
import located
import resistive
import wheel
from bench import RADIUS_M, WIDTH_M, noise_sds, simulate
from catalogue import EFFECTS, FAULT_EFFECTS, coordinate, quantile
from oracle import Campaign

KINDS = {"library": 120, "pair": 50, "triple": 25, "law": 80, "law_two": 40, "law_effect": 30, "nothing": 45, "fault": 45, "sparse": 20, "heavy": 20,
         "simulator": 10, "scm": 15}
PRIORS = {"log10_p_ref": ("uniform", 4.0, 5.6), "kappa": ("normal", 0.0, 0.3, -0.8, 2.0), "n": ("normal", 1.1, 0.2, 0.8, 2.0),
          "friction_angle_deg": ("normal", 30.0, 5.7, 11.5, 37.3), "wheel_radius_m": ("uniform", 0.125, 0.155)}
SCM_PRIORS = {**PRIORS, "log10_p_ref": ("uniform", 4.6, 5.4), "kappa": 0.0, "n": ("normal", 1.1, 0.1, 0.8, 2.0),
              "friction_angle_deg": ("normal", 30.0, 4.0, 15.0, 37.3), "wheel_radius_m": ("uniform", 0.124, 0.130)}
ATTEMPTS = 60
# Nats of noise-free data that a hidden effect or law must be worth, beside the others that are hidden.
DETECTABLE = 10.0
SCM_MODEL = 'kind = "scm"\ndem_spacing_m = 0.012\ntravel_step_m = 0.003\nsteady_travel_m = 0.3\nsteady_tolerance = 0.01\n'


def kind_of(number, seed):
    kinds = [kind for kind, count in KINDS.items() for _ in range(count)]
    turn = {kind: np.random.default_rng([seed, 1]).permutation(count) for kind, count in KINDS.items()}
    order = np.random.default_rng([seed, 0]).permutation(len(kinds))
    place = int(order[number % len(kinds)])
    kind = kinds[place]
    return kind, int(turn[kind][place - kinds.index(kind)])


def design(rng, kind):
    """Conditions of the fitted runs, in random order, and of the held-out ones between them and slightly beyond."""
    slip_count, loads, speeds = {"sparse": (4, 2, 2), "scm": (4, 2, 2)}.get(kind) or [(6, 2, 2), (5, 2, 2), (4, 2, 3), (5, 3, 1), (4, 2, 2), (6, 2, 2)][rng.integers(6)]
    edges = np.linspace(0.03, 0.65, slip_count + 1)
    slips = np.round([rng.uniform(a, b) for a, b in zip(edges, edges[1:])], 2)
    loads = np.round(np.linspace(rng.uniform(50, 70), rng.uniform(110, 140), loads), 0)
    rims = np.round(np.geomspace(rng.uniform(0.008, 0.012), rng.uniform(0.04, 0.06), speeds), 4) if speeds > 1 else np.round([rng.uniform(0.01, 0.05)], 4)
    fit = [(s, w, r) for s in slips for w in loads for r in rims]
    if kind == "sparse":
        fit = [run for i, run in enumerate(fit) if (i // (2 * 2) + i // 2 + i) % 2 == 0]
    fit = [fit[i] for i in rng.permutation(len(fit))]
    middle = np.round([loads[:2].mean(), loads[-1] * 1.08], 0)
    between = np.round(np.geomspace(rims[0], rims[-1], 4)[1:3], 4) if speeds > 1 else rims
    held_slips = np.round([(a + b) / 2 for a, b in zip(slips, slips[1:])][:3] + [min(slips[-1] + 0.05, 0.7)], 3)
    grid = [(w, r) for w in middle for r in between]
    held = [(s, *grid[(i + k) % len(grid)]) for i, s in enumerate(held_slips) for k in range(min(3, len(grid)))]
    rows = np.array([(s, w, r * (1 - s)) for s, w, r in fit + held])
    count = len(fit)
    # Held-out runs are made among the others; the table has the fitted ones first, as they were made.
    turns = rng.permutation(len(rows))
    turns = np.concatenate([np.sort(turns[:count]), turns[count:]])
    runs = {"slip": rows[:, 0], "wheel_load_n": rows[:, 1], "sled_speed_m_s": np.round(rows[:, 2], 7), "width_m": np.full(len(rows), WIDTH_M),
            "rig_radius_m": np.full(len(rows), RADIUS_M), "order": turns / (len(rows) - 1) - 0.5}
    return runs, count


def part(runs, count):
    return {key: column[:count] for key, column in runs.items()}


def draw_soil(rng, priors):
    return {key: prior if isinstance(prior, float) else float(quantile(prior, rng.standard_normal())) for key, prior in priors.items()}


def strengths(rng, effects, names):
    return {name: {key: float(quantile(prior, rng.standard_normal())) for key, prior in effects[name]["priors"].items()} for name in names}


def usable(values):
    return np.all(np.isfinite(values)) and np.all(values[:, 2] < 0.5 * RADIUS_M) and np.all(values[:, 2] > 5e-4)


def hidden_names(kind, turn, rng):
    names = list(EFFECTS)
    count = {"pair": 2, "triple": 3, "library": 1, "sparse": 1, "heavy": 1, "law_effect": 1}.get(kind, 0)
    if kind == "library" or (kind == "scm" and turn % 3):
        return [names[(turn * 7) % len(names)]]
    return [str(name) for name in rng.permutation(names)[:count]]


def draw_truth(kind, turn, seed, number):
    """A truth of a kind whose hidden parts are each detectable, or the last one that was drawn: the file of truths says which."""
    for attempt in range(ATTEMPTS):
        rng = np.random.default_rng([seed, number, attempt])
        priors = dict(SCM_PRIORS if kind == "scm" else PRIORS)
        runs, count = design(rng, kind)
        soil = draw_soil(rng, priors)
        base, state = simulate(runs, soil, [])
        if kind == "simulator":
            values = resistive.solve(runs, rng.uniform(0.125, 0.14), float(np.exp(rng.uniform(np.log(1e6), np.log(8e6)))))
            names, a, law = [], {}, None
        else:
            if not usable(base):
                continue
            sds = noise_sds(base[:count])
            names = hidden_names(kind, turn, rng)
            a = strengths(rng, EFFECTS, names)
            law = laws.draw(rng, state, sds, 2 if kind == "law_two" else 1) if kind.startswith("law") else None
            hooks = [(EFFECTS[name], a[name]) for name in names] + ([(laws.effect(law), {})] if law else [])
            values, state = simulate(runs, soil, hooks)
        if not usable(values):
            continue
        sds = noise_sds(values[:count])
        truth = {"number": number, "kind": kind, "turn": turn, "soil": soil, "effects": a, "law": law, "fault": None, "state": state, "runs": runs,
                 "count": count, "priors": priors, "values": values, "sds": sds, "rng": rng, "accepted": []}
        if kind == "fault":
            truth = faults.applied(truth, turn)
            if not usable(truth["values"]):
                continue
        truth["oracle"] = oracle(truth)
        if kind in ("fault", "nothing", "simulator") or all(nats > DETECTABLE for nats in truth["oracle"]["worth"].values()):
            break
    else:
        truth["oracle"] = {**oracle(truth, is_final=True), "undetectable": True}
    return truth


def oracle(truth, is_final=False):
    """Worth of each hidden part in nats beside the others, and how far the best other explanations fall short.

    Unless the truth is final, nothing more is computed once a part is worth too little.
    """
    kind, count, law = truth["kind"], truth["count"], truth["law"]
    effects = {**EFFECTS, **{name: FAULT_EFFECTS[name] for name in truth["accepted"] if name in FAULT_EFFECTS}}
    campaign = Campaign(part(truth["runs"], count), truth["priors"], truth["sds"], effects)
    hidden, hook = list(truth["effects"]), [laws.effect(law)] if law else []
    differences = {"worth": {}, "gain": 0.0, "shortfall": {}}
    if kind in ("nothing", "simulator", "fault"):
        target = truth["values"][:count]
        base = campaign.fit(target)
        differences["gain"] = round(float(base[0]), 2)
        if kind == "fault":
            differences["shortfall"] = {name: round(float(fit[0]), 2) for name, fit in campaign.alternatives(target, base).items()}
        return differences
    start = [0.0 if isinstance(p, float) else float(np.clip(coordinate(p, truth["soil"][key]), -4, 4)) for key, p in truth["priors"].items()]
    start += [float(np.clip(coordinate(EFFECTS[e]["priors"][key], x), -4, 4)) for e in hidden for key, x in truth["effects"][e].items()]
    target = campaign.values(np.array([start]), hidden, hook)[0]
    best = campaign.fit(target, hidden, hook, start)[0]
    widths = [len(EFFECTS[e]["priors"]) for e in hidden]
    bounds = np.cumsum([len(truth["priors"]), *widths])
    without = {}
    for k, name in enumerate(hidden):
        others, shorter = hidden[:k] + hidden[k + 1:], start[: bounds[k]] + start[bounds[k + 1]:]
        without[name] = (others, campaign.fit(target, others, hook, shorter))
        differences["worth"][name] = round(float(without[name][1][0] - best), 2)
        if differences["worth"][name] <= DETECTABLE and not is_final:
            return differences
    if law:
        differences["worth"]["law"] = round(float(campaign.fit(target, hidden, [], start)[0] - best), 2)
        if differences["worth"]["law"] <= DETECTABLE and not is_final:
            return differences
    base = campaign.fit(target, start=start[: bounds[0]])
    differences["gain"] = round(float(base[0] - best), 2)
    singles = campaign.alternatives(target, base, left_out=hidden if len(hidden) == 1 and not law else ())
    differences["shortfall"] = {name: round(float(fit[0] - best), 2) for name, fit in singles.items()}
    if len(hidden) + len(hook) > 1:
        differences["replaced"] = {f"{name}>{other}": round(float(fit[0] - best), 2) for name, (others, left) in without.items()
                                   for other, fit in campaign.alternatives(target, left, others, hook, [name], 2).items()}
    if law:
        # What a law changes, two effects of the library may do together.
        differences["pairs"] = {f"{first}+{second}": round(float(fit[0] - best), 2) for first in list(singles)[:2]
                                for second, fit in campaign.alternatives(target, singles[first], given=[first], fitted=2).items()}
        differences["places"] = located.places(campaign, target, hidden, law, truth["state"], start[: bounds[-1]], best)
    if law and len(law["depends_on"]) == 1:
        differences["formula"] = located.formulas(campaign, target, hidden, law, truth["state"], start, best)
    return differences


def noisy(truth):
    rng, values = truth["rng"], truth["values"]
    z = rng.standard_t(3, values.shape) if truth["kind"] == "heavy" else rng.standard_normal(values.shape)
    return values + truth["sds"] * z


def prior_text(prior):
    if isinstance(prior, float):
        return repr(prior)
    kind, *numbers = prior
    bounds = f", bounds = [{numbers[2]}, {numbers[3]}]" if kind == "normal" and len(numbers) > 2 else ""
    return f"{{ {kind} = [{numbers[0]}, {numbers[1]}]{bounds} }}"


def write_campaign(folder, truth, measured):
    folder.mkdir(parents=True, exist_ok=True)
    grousers = 0 if truth["kind"] == "scm" else wheel.GROUSERS
    model = SCM_MODEL if truth["kind"] == "scm" else 'kind = "quasi_static"\n'
    priors = "".join(f"{key} = {prior_text(p)}\n" for key, p in truth["priors"].items() if key not in truth.get("fixed", ()))
    (folder / "job.toml").write_text(
        f'experiment = "experiment.toml"\n[model]\n{model}shear_velocity_m_s = 0.001\n[priors]\n{priors}[sampler]\nseed = 1\n[discovery]\napply = "auto"\n')
    shape = f"grouser_height_m = {wheel.GROUSER_HEIGHT_M}\ngrouser_thickness_m = 0.002\n" if grousers else ""
    pull, torque, sinkage = truth["sds"]
    (folder / "experiment.toml").write_text(
        f'runs = "runs.csv"\n[wheel.w]\nradius_m = {RADIUS_M}\nwidth_m = {WIDTH_M}\ngrouser_count = {grousers}\n{shape}rig_radius_m = {RADIUS_M}\n'
        f"[soil.s]\ndensity_kg_m3 = {wheel.DENSITY_KG_M3}\n[rig]\nbin_length_m = {wheel.BIN_LENGTH_M}\n"
        f"[noise]\ndrawbar_pull_n = {pull:.6g}\ntorque_n_m = {torque:.6g}\nsinkage_m = {sinkage:.6g}\n")
    runs, count = truth["runs"], truth["count"]
    order = truth["states_order"]
    lines = ["run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n,torque_n_m,sinkage_m," + ("order," if order else "") + "use"]
    for i, (pull, torque, sinkage) in enumerate(measured):
        place = f"{round((runs['order'][i] + 0.5) * (len(measured) - 1)) + 1}," if order else ""
        lines.append(f"r{i:02},w,s,{runs['slip'][i]:.4g},{runs['wheel_load_n'][i]:.4g},{runs['sled_speed_m_s'][i]:.6g},{pull:.7g},{torque:.7g},{sinkage:.7g},"
                     f"{place}{'fit' if i < count else 'holdout'}")
    (folder / "runs.csv").write_text("\n".join(lines) + "\n")


def campaign(number, seed, folder):
    """Writes the campaign; returns its line of the file of truths."""
    kind, turn = kind_of(number, seed)
    truth = draw_truth(kind, turn, seed, number)
    truth["states_order"] = turn % 2 == 0
    measured = noisy(truth)
    if truth["fault"]:
        measured = faults.recorded(truth, measured)
    write_campaign(folder / "campaigns" / f"{number:03}", truth, measured)
    count, sds = truth["count"], truth["sds"]
    fitted = Campaign(part(truth["runs"], count), truth["priors"], sds)
    _, u, _ = fitted.fit(measured[:count])
    held = {key: column[count:] for key, column in truth["runs"].items()}
    before = fitted.values(np.array([u]), [], runs=held)[0]
    rounded = lambda array: [[float(f"{x:.7g}") for x in row] for row in np.nan_to_num(array)]
    line = {key: truth[key] for key in ("number", "kind", "soil", "effects", "law", "fault", "accepted", "oracle")}
    if truth["law"]:
        line["law"]["support"] = laws.support(truth["law"], truth["state"])
    return {**line, "sds": [float(f"{x:.7g}") for x in sds], "holdout": rounded(truth["values"][count:]), "base_holdout": rounded(before)}


def line_of(task):
    return json.dumps(campaign(*task))


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("folder", type=pathlib.Path)
    arguments.add_argument("--campaigns", type=int, default=sum(KINDS.values()))
    arguments.add_argument("--seed", type=int, default=1)
    arguments.add_argument("--jobs", type=int, default=1)
    chosen = arguments.parse_args()
    chosen.folder.mkdir(parents=True, exist_ok=True)
    file = chosen.folder / "truth.jsonl"
    lines = file.read_text().splitlines() if file.exists() else []
    with file.open("a") as truths, multiprocessing.Pool(chosen.jobs) as pool:
        tasks = [(number, chosen.seed, chosen.folder) for number in range(len(lines), chosen.campaigns)]
        for line in pool.imap(line_of, tasks):
            truths.write(line + "\n")
            truths.flush()


if __name__ == "__main__":
    main()
