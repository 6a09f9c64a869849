#!/usr/bin/env python3
"""The leaderboard of Missing Effect 500: `score.py FOLDER [--campaigns N] [--entries NAME,...] [--wrong]`.

FOLDER has truth.jsonl and answers/ENTRY.jsonl. What the columns mean stands in README.md. `--wrong` lists the wrong claims and what was hidden.
"""
import argparse
import json
import pathlib

import numpy as np
from scipy.stats import beta

import formula
import laws

# Nats: beyond which an effect is detectable and an explanation excluded; within which it is an alias; that a formula must be ahead to be decidable.
DECIDABLE, ALIAS, FORMULA = 10.0, 3.0, 3.0
# Names of a library that are one claim: wheel runs cannot tell the first from the second, or the first is a value of the second's parameter.
SAME = {"cohesion_pa": "adhesion", "shear_velocity_zero": "shear_velocity_scale", "gamma_exponent": "pressure_distribution_shape"}
OUTCOMES = ("right", "class", "part", "alias", "undecided", "missed", "wrong")
BINS = (0.0, 0.5, 0.8, 0.9, 0.95, 0.99, 0.999)


def hidden(truth):
    """What is right to claim: names of effects, and `law`."""
    names = set(truth["effects"]) | {name for name in truth["accepted"] if ":" not in name}
    if truth["kind"] == "simulator":
        # Its stresses depend on no speed, so that the base's reference velocity is too large.
        return {"law", "shear_velocity_scale"}
    return names | ({"law"} if truth["law"] else set())


def hides_nothing(truth):
    return not hidden(truth) and not truth["fault"]


def aliases(truth):
    """Effects that fit noise-free data as well as what is hidden, to within a few nats; none where nothing is hidden."""
    if hides_nothing(truth):
        return set()
    shortfall = truth["oracle"].get("shortfall", {})
    accepted = [shortfall[name] for name in truth["accepted"] if name in shortfall]
    limit = min(accepted, default=-np.inf if truth["fault"] else 0.0) + ALIAS
    names = {name for name, nats in shortfall.items() if nats < limit}
    names |= {name.split(">")[1] for name, nats in truth["oracle"].get("replaced", {}).items() if nats < ALIAS}
    return names - hidden(truth)


def is_decidable(truth):
    oracle = truth["oracle"]
    others = [nats for key in ("shortfall", "replaced", "pairs", "places") for nats in oracle.get(key, {}).values()]
    return bool(oracle["worth"]) and min(*oracle["worth"].values(), *others, np.inf) > DECIDABLE


def is_formula_decidable(truth):
    """Whether every other shape with no more constants falls short. The truth has the four shapes that come closest."""
    law, nats = truth["law"], truth["oracle"].get("formula", {})
    shape = law["shape"]
    is_same = lambda name: law["operation"] == "times" and {name, shape} in laws.SAME_FACTOR
    rivals = [n for name, n in nats.items() if laws.CONSTANTS[name] <= laws.CONSTANTS[shape] and not is_same(name)]
    return bool(nats) and min(rivals or [max(nats.values())]) > FORMULA


def is_place(truth, law):
    """Whether a claimed law acts on the right quantity and depends on the right variable."""
    if truth["kind"] == "simulator":
        return True
    if f"law:{law['acts_on']}" in truth["accepted"]:
        return True
    real = truth["law"]
    if not real:
        return False
    if any(truth["oracle"].get("places", {}).get(f"{law['acts_on']}/{variable}", np.inf) < ALIAS for variable in law["depends_on"]):
        return True
    return law["acts_on"] == real["acts_on"] and (len(real["depends_on"]) > 1 or law["depends_on"] == real["depends_on"])


def place_outcome(truth, law):
    """`right` of a law at its place; `class` of one whose places contain it; else `wrong`."""
    places = law.get("places") or [[law["acts_on"], law["depends_on"]]]
    is_right = any(is_place(truth, {**law, "acts_on": acts_on, "depends_on": depends_on}) for acts_on, depends_on in places)
    return "wrong" if not is_right else "right" if len(places) == 1 else "class"


def laws_of(answer):
    """All laws that are claimed; an answer that has no list of them claims its law alone."""
    return answer.get("laws") or ([answer["law"]] if answer.get("law") else [])


def outcome(truth, answer):
    """One of OUTCOMES, or None of an entry that names nothing."""
    if answer["verdict"] is None:
        return None
    right, other, verdicts, covered = hidden(truth), aliases(truth), [], set()
    for name in (SAME.get(name, name) for name in answer.get("named") or []):
        verdicts.append("right" if name in right else "alias" if name in other else "wrong")
        covered |= {name} & right
    members = {SAME.get(name, name) for name in answer.get("class") or []}
    if members:
        verdicts.append("class" if members & right else "alias" if members & other else "wrong")
        covered |= members & right
    for law in laws_of(answer):
        verdicts.append(place_outcome(truth, law))
        covered |= {"law"} & right
    if answer.get("faults") and not truth["fault"]:
        verdicts.append("wrong")
    if not verdicts:
        if not right or truth["fault"]:
            is_right = bool(answer.get("faults")) or answer["verdict"] == "nothing" if not truth["accepted"] else bool(answer.get("faults"))
            return "right" if is_right else "undecided" if answer["verdict"] != "nothing" or truth["oracle"]["gain"] < DECIDABLE else "missed"
        return "missed" if answer["verdict"] == "nothing" and is_decidable(truth) else "undecided"
    for worst in ("wrong", "alias"):
        if worst in verdicts:
            return worst
    if truth["kind"] not in ("fault", "simulator") and right - covered:
        return "part"
    return "class" if "class" in verdicts else "right"


def leading(answer):
    """The most probable explanation as a set of names, and its probability; a class counts together unless a member has 0.9."""
    probabilities = answer.get("probabilities")
    if not probabilities:
        return None
    name = max(probabilities, key=probabilities.get)
    if probabilities[name] > 0.9:
        return {name}, min(probabilities[name], 1.0)
    groups = [set(names) for names in answer.get("classes") or []]
    groups += [{name} for name in probabilities if not any(name in group for group in groups)]
    total = lambda group: sum(probabilities.get(name, 0.0) for name in group)
    best = max(groups, key=total)
    return best, min(total(best), 1.0)


def is_lead_right(truth, lead):
    right = hidden(truth)
    if "none" in lead:
        return not truth["fault"] and (not right or truth["oracle"]["gain"] < ALIAS)
    if "not_in_library" in lead:
        return "law" in right or any(name.startswith("law:") for name in truth["accepted"])
    return bool({SAME.get(name, name) for name in lead} & right)


def interval(right, count):
    """The 90 % interval of a share by Clopper and Pearson."""
    low = beta.ppf(0.05, right, count - right + 1) if right else 0.0
    high = beta.ppf(0.95, right + 1, count - right) if right < count else 1.0
    return float(low), float(high)


def error(truth, predicted):
    """Root mean square error of held-out predictions against the truth without noise, in noise sds; None where none were made."""
    if not predicted:
        return None
    values = np.array([[np.nan if x is None else x for x in row] for row in predicted], float)
    if values.shape != np.shape(truth["holdout"]):
        return None
    residuals = (values - np.array(truth["holdout"])) / np.array(truth["sds"])
    return float(np.sqrt(np.nanmean(residuals**2))) if np.any(np.isfinite(residuals)) else None


def judged(truth, answer):
    lead = leading(answer)
    said = outcome(truth, answer)
    is_false = said == "wrong" or said is None and any(place_outcome(truth, law) == "wrong" for law in laws_of(answer))
    case = {"number": truth["number"], "kind": truth["kind"], "outcome": said, "hides_nothing": hides_nothing(truth), "claims_falsely": is_false,
            "decidable": is_decidable(truth), "cpu_s": answer.get("cpu_s"), "before": error(truth, truth["base_holdout"]),
            "after": error(truth, answer.get("holdout")), "formula": None, "p": None}
    if lead:
        case["p"], case["lead_right"] = lead[1], is_lead_right(truth, lead[0])
    law, real = answer.get("law"), truth["law"]
    if real and len(real["depends_on"]) == 1 and answer.get("offers_formulas"):
        is_in_place = bool(law) and law["acts_on"] == real["acts_on"] and law["depends_on"] == real["depends_on"]
        first, any_ = formula.is_law(real, law["formulas"]) if is_in_place else (False, False)
        alike = any_ or is_in_place and formula.is_law(real, law.get("alike", []))[1]
        case["formula"] = {"decidable": is_formula_decidable(truth), "first": first, "any": bool(alike), "in_place": is_in_place}
    return case


def share(count, total):
    return f"{count}/{total}" if total else "–"


def median(values):
    values = [x for x in values if x is not None]
    return f"{np.median(values):.2f}" if values else "–"


def line(name, cases):
    """A line of a table: all columns for these cases."""
    named = [c for c in cases if c["outcome"] in OUTCOMES]
    count = lambda *outcomes: sum(c["outcome"] in outcomes for c in named)
    decidable = [c for c in named if c["decidable"]]
    leads = [c for c in cases if c["p"] is not None]
    brier = f"{np.mean([(c['p'] - c['lead_right']) ** 2 for c in leads]):.3f}" if leads else "–"
    formulas = [c["formula"] for c in cases if c["formula"] and c["formula"]["decidable"]]
    cells = [name, str(len(cases)), share(sum(c["outcome"] in ("right", "class") for c in decidable), len(decidable))]
    cells += [str(count(o)) if named else "–" for o in OUTCOMES] + [brier]
    cells += [f"{median(c['before'] for c in cases if c['after'] is not None)} → {median(c['after'] for c in cases)}"]
    cells += [share(sum(f["first"] for f in formulas), len(formulas)), share(sum(f["any"] for f in formulas), len(formulas)), median(c["cpu_s"] for c in cases)]
    return "| " + " | ".join(cells) + " |"


def head(first):
    names = [first, "campaigns", "decidable: right or class", *OUTCOMES, "Brier", "held-out error before → after", "formula first", "formula offered", "CPU s"]
    return "| " + " | ".join(names) + " |\n|" + "---|" * len(names)


def calibration(entry, cases):
    leads = [c for c in cases if c["p"] is not None]
    lines = []
    for low, high in zip(BINS, (*BINS[1:], 1.0000001)):
        inside = [c for c in leads if low <= c["p"] < high]
        if inside:
            right, mean = sum(c["lead_right"] for c in inside), np.mean([c["p"] for c in inside])
            ends = interval(right, len(inside))
            lines.append(f"| {entry} | {low} to {min(high, 1):g} | {right}/{len(inside)} = {right / len(inside):.2f} [{ends[0]:.2f}, {ends[1]:.2f}] "
                         f"| {mean:.3f} | {'yes' if ends[0] <= mean <= ends[1] else 'no'} |")
    return lines


def false_claims(cases):
    cells = []
    for is_inside in (lambda c: c["hides_nothing"], lambda c: c["kind"] == "fault"):
        inside = [c for c in cases if is_inside(c)]
        cells.append(share(sum(c["claims_falsely"] for c in inside), len(inside)))
    return cells


def without_failures(answers):
    """Answers of an entry as of one that never failed: a failure is undecided, or has no verdict if no answer of the entry has one. An entry that
    offers a formula anywhere offers formulas, so that an answer without one is one that does not have the law."""
    names = any(answer["verdict"] not in (None, "failed") for answer in answers.values())
    offers = any(answer.get("offers_formulas") or laws_of(answer) for answer in answers.values())
    instead = {"failed": "undecided" if names else None}
    return {n: {**answer, "verdict": instead.get(answer["verdict"], answer["verdict"]), "offers_formulas": offers} for n, answer in answers.items()}


def read(path, campaigns):
    lines = [json.loads(text) for text in path.read_text().splitlines()]
    return {item["number"]: item for item in lines if item["number"] < campaigns}


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("folder", type=pathlib.Path)
    arguments.add_argument("--campaigns", type=int, default=10**9)
    arguments.add_argument("--entries")
    arguments.add_argument("--wrong", action="store_true")
    chosen = arguments.parse_args()
    truths = read(chosen.folder / "truth.jsonl", chosen.campaigns)
    files = sorted((chosen.folder / "answers").glob("*.jsonl"))
    entries = {f.stem: without_failures(read(f, chosen.campaigns)) for f in files if not chosen.entries or f.stem in chosen.entries.split(",")}
    scores = {entry: [judged(truths[n], answers[n]) for n in sorted(answers) if n in truths] for entry, answers in entries.items()}
    print("## Leaderboard\n\n" + head("entry"))
    for entry, cases in scores.items():
        print(line(entry, cases))
    print("\n| entry | false claims, nothing hidden | false claims, fault of the rig | CPU s, all |\n|---|---|---|---|")
    for entry, cases in scores.items():
        print(f"| {entry} | {' | '.join(false_claims(cases))} | {sum(c['cpu_s'] or 0 for c in cases):.0f} |")
    for entry, cases in scores.items():
        print(f"\n## {entry} by kind\n\n" + head("kind"))
        for kind in dict.fromkeys(t["kind"] for t in truths.values()):
            inside = [c for c in cases if c["kind"] == kind]
            if inside:
                print(line(kind, inside))
    print("\n## Calibration of the leading explanation\n\n| entry | P | right [90 %] | mean P | within |\n|---|---|---|---|---|")
    print("\n".join(row for entry, cases in scores.items() for row in calibration(entry, cases)))
    if chosen.wrong:
        for entry, cases in scores.items():
            for c in cases:
                if c["outcome"] == "wrong":
                    truth, answer = truths[c["number"]], entries[entry][c["number"]]
                    real = truth["law"] and f"{truth['law']['acts_on']}({', '.join(truth['law']['depends_on'])}) {truth['law']['shape']}"
                    claimed = [f"{law['acts_on']}({', '.join(law['depends_on'])})" for law in laws_of(answer)]
                    print(f"\n{entry} {c['number']:03} {c['kind']}: hidden {truth['effects']} {real or ''} {truth['fault'] or ''}; said {answer.get('named')} {answer.get('class')} "
                          f"{claimed} {answer.get('faults') or ''}; P {c['p']}; oracle {truth['oracle']}; {answer.get('note')}")


if __name__ == "__main__":
    main()
