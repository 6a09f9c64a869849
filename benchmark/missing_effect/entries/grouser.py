#!/usr/bin/env python3
"""Grouser: the whole study of `apply = "auto"`, with the normal approximation about the most probable parameters as its posterior.

The program is $COORDINATOR, or `coordinator` of the path. A question that Grouser asks of a campaign (a column that looks exchanged, a zero that is off) is reported as a
fault of the rig, and accepted as meant, so that the study goes on.
"""
import csv
import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile

from answer import main, rows

HOSTS = {"pressure": ("p", 1), "shear": ("tau", 1), "drawbar_pull": ("drawbar_pull", 0), "torque": ("torque", 0), "sinkage": ("sinkage", 0)}
# The place of a law is stated alone if it has more probability than this.
PLACED = 0.9
VERDICTS = {"nothing_detectable": "nothing", "named": "named", "class": "class", "not_in_library": "law", "undecided": "undecided"}
ASKED = ("swapped_columns", "exchanged_wheels", "radius_or_diameter", "force_zero", "sinkage_zero", "rig_radius_m", "wheel_radius_m", "drawbar_pull_n", "torque_n_m",
         "sinkage_m", "drawbar_pull_sign", "torque_sign", "sinkage_sign")


def started(folder, accepted):
    command = [os.environ.get("COORDINATOR", "coordinator"), "run", folder / "job.toml", "--out", folder / "out", "--local-workers", "1"]
    for name in accepted:
        command += ["--accept", name]
    return subprocess.run(command, capture_output=True, text=True)


def formula(text, acts_on):
    """A formula of Grouser as one of this benchmark: what a stress is multiplied by, or what is added to a channel."""
    host, neutral = HOSTS[acts_on]
    text = re.sub(rf"\b{host}\b(?!\()", f"{neutral}.0", text)
    return re.sub(r"\bif\(", "where(", text).replace("^", "**")


def law_of(outside):
    texts = [part["members"][0]["formula"] for part in (outside.get("formulas") or {}).get("classes", [])]
    texts += [form["formula"] for form in outside["forms"]]
    others = [member["formula"] for part in (outside.get("formulas") or {}).get("classes", []) for member in part["members"][1:]]
    acts_on = outside["acts_on"]
    claimed = {"acts_on": acts_on, "depends_on": outside["depends_on"]}
    told = [place for place in outside["places"] if place["probability"] > PLACED and claimed.items() <= place.items()]
    places = told or outside["places"]
    return {"acts_on": acts_on, "depends_on": [outside["depends_on"]], "operation": "times" if HOSTS[acts_on][1] else "plus",
            "places": [[place["acts_on"], [place["depends_on"]]] for place in places],
            "formulas": [formula(text, acts_on) for text in dict.fromkeys(texts)], "alike": [formula(text, acts_on) for text in others]}


def best(row):
    """The prediction that Grouser offers where misfit may remain: of all models of the ledger, corrected by what they miss; else of the last model."""
    text = row.get("combined") or row.get("corrected") or row.get("model")
    return float(text) if text else None


def entry(campaign):
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary) / "campaign"
        shutil.copytree(campaign, folder)
        job = (folder / "job.toml").read_text()
        (folder / "job.toml").write_text(job.replace("[sampler]", '[sampler]\nalgorithm = "lm"'))
        accepted = []
        while True:
            ended = started(folder, accepted)
            asked = [name for name in re.findall(r"--accept ([\w.]+)", ended.stderr) if name not in accepted]
            if ended.returncode == 0 or not asked:
                break
            accepted += asked
        if ended.returncode != 0:
            return {"verdict": "undecided", "offers_formulas": True, "faults": [name for name in accepted if name in ASKED], "note": f"error: {ended.stderr.strip()[-400:]}"}
        summary = json.loads((folder / "out/summary.json").read_text())
        predicted = {(r["run"], r["channel"]): r for r in csv.DictReader((folder / "out/predictions.csv").open())}
        discovery = summary["discovery"]
        first = discovery["rounds"][0]
        laws = [law_of(r["outside"]) for r in discovery["rounds"] if r["outside"] and r["verdict"] == "not_in_library"]
        # A law in the chosen list has the name of its file; what a catalogue has stands in the list of explanations.
        listed = {e["name"] for r in discovery["rounds"] for e in r["effects"]}
        claimed = [name for name in discovery["chosen"] if name in listed]
        last = discovery["rounds"][-1]
        members = []
        if last["verdict"] == "class":
            lead = last["effects"][0]["class"]
            members = [e["name"] for e in last["effects"] if e["class"] == lead]
        classes = {}
        for e in first["effects"]:
            classes.setdefault(e["class"], []).append(e["name"])
        holdout = [[best(predicted.get((r["run"], channel), {})) for channel in ("drawbar_pull", "torque", "sinkage")]
                   for r in rows(campaign) if r["use"] == "holdout"]
        verdict = VERDICTS[discovery["verdict"]]
        if laws:
            verdict = "law"
        elif claimed:
            verdict = "named"
        elif members:
            verdict = "class"
        return {"verdict": verdict, "named": claimed, "class": members, "probabilities": {e["name"]: e["probability"] for e in first["effects"]},
                "classes": [names for names in classes.values() if len(names) > 1], "law": laws[0] if laws else None, "laws": laws,
                "offers_formulas": True, "faults": [name for name in accepted if name in ASKED], "holdout": holdout,
                "note": f"{discovery['verdict']}; rounds {[r['verdict'] for r in discovery['rounds']]}; chosen {discovery['chosen']}"}


if __name__ == "__main__":
    main(entry)
