"""Files of deploy/ for Kubernetes and HTCondor: right by the schemas or the parser, with arguments that our programs know."""

import copy
import pathlib
import subprocess
import sys
import tomllib

import classad2
import htcondor2
import kubernetes_validate
import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDER = ROOT / "deploy/kubernetes"
VERSIONS = ["1.29", "1.37"]


def documents(path):
    return list(yaml.safe_load_all(path.read_text()))


def validate(document):
    for version in VERSIONS:
        kubernetes_validate.validate(document, version, strict=True)


def refuses(document):
    try:
        validate(document)
    except kubernetes_validate.ValidationError:
        return True
    return False


def containers(document):
    pod = document.get("spec", {}).get("template", {}).get("spec", {})
    return [*pod.get("initContainers", []), *pod.get("containers", [])]


def knows(programs, container):
    """Whether the program of a container's image takes its arguments; with --help behind them it does nothing else."""
    program = programs / container["image"].split("/")[1].split(":")[0]
    ended = subprocess.run([program, *container["args"], "--help"], capture_output=True, text=True)
    return ended.returncode == 0


def check_submit_file(programs):
    """The submit file of HTCondor: its syntax, its expression, and what the worker is told."""
    submit = htcondor2.Submit((ROOT / "deploy/htcondor/worker.sub").read_text())
    assert submit.getQArgs() == "$(workers)"
    again = classad2.ExprTree(submit["on_exit_remove"])
    ends = {status: again.eval(classad2.ClassAd({"ExitCode": status})) for status in (0, 1, 69, 75)}
    assert ends == {0: True, 1: False, 69: True, 75: False}, ends
    words = submit.expand("arguments").split()
    assert knows(programs, {"image": "x/worker", "args": words}), words


def main():
    programs = pathlib.Path(sys.argv[1])
    check_submit_file(programs)
    version = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]["package"]["version"]
    base = documents(FOLDER / "kustomization.yaml")[0]
    names = [*base["resources"], "job.yaml"]
    assert {image["name"]: image["newTag"] for image in base["images"]} == {
        "grouser/coordinator": version,
        "grouser/worker": version,
    }
    tagged = [container["image"] for document in documents(FOLDER / "job.yaml") for container in containers(document)]
    assert tagged and all(image.endswith(f":{version}") for image in tagged), tagged
    checked = 0
    for name in names:
        for document in documents(FOLDER / name):
            validate(document)
            wrong = copy.deepcopy(document)
            wrong["spec"]["replica"] = 1
            assert refuses(wrong), f"{name}: a key that does not exist passes"
            for container in containers(document):
                assert knows(programs, container), f"{name}: {container['args']}"
                wrong = {**container, "args": [*container["args"], "--no-such-option"]}
                assert not knows(programs, wrong)
            checked += 1
    # A resource of an operator: its schema is not among those of Kubernetes.
    monitor = documents(FOLDER / "monitoring/pod-monitor.yaml")[0]
    assert monitor["kind"] == "PodMonitor"
    labels = monitor["spec"]["selector"]["matchLabels"]
    pods = [document["spec"]["template"]["metadata"]["labels"] for name in names for document in documents(FOLDER / name)
            if "template" in document["spec"]]
    assert any(labels.items() <= pod.items() for pod in pods), "the monitor finds no pod"
    print(f"the submit file is right by HTCondor {htcondor2.version().split()[1]}")
    print(f"{checked} manifests are right by the schemas of Kubernetes {' and '.join(VERSIONS)}")


main()
