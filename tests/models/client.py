"""The client of the PyPI package umbridge against `worker serve --umbridge`: client.py WORKER FOLDER."""

import csv
import subprocess
import sys
from pathlib import Path

import requests
import umbridge

RUN = {"slip": 0.2, "wheel_load_n": 100.0, "sled_speed_m_s": 0.01, "slip_angle_deg": 0.0}
SIZE = {"radius_m": 0.125, "width_m": 0.112}
SOIL = {
    "log10_p_ref": 4.56,
    "kappa": 0.0,
    "n": 1.1,
    "friction_angle_deg": 30.0,
    "cohesion_pa": 100.0,
    "shear_velocity_m_s": 0.001,
    "gamma_exponent": 0.5,
}
CHANNELS = ["drawbar_pull_n", "torque_n_m", "sinkage_m", "lateral_force_n"]
INPUT = [[*RUN.values(), *SIZE.values()], [*SOIL.values()]]


def simulated(worker: str, folder: Path, kind: str) -> list[float]:
    """The channels of the run by `worker simulate`."""
    header = ["run", "wheel", "soil", *RUN, "pass", *CHANNELS, "use"]
    row = ["r", "w", "s", *RUN.values(), 1, 0.0, 0.0, 0.0, "", "fit"]
    with open(folder / "runs.csv", "w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows([header, row])
    wheel = "".join(f"{key} = {value}\n" for key, value in SIZE.items())
    noise = "[noise]\ndrawbar_pull_n = 1.0\ntorque_n_m = 0.1\nsinkage_m = 0.001\nlateral_force_n = 1.0\n"
    (folder / "experiment.toml").write_text(f'runs = "runs.csv"\n[wheel.w]\n{wheel}[soil.s]\n{noise}')
    (folder / "model.toml").write_text(f'kind = "{kind}"\n')
    (folder / "theta.toml").write_text("".join(f"{key} = {value}\n" for key, value in SOIL.items()))
    command = [worker, "simulate", "experiment.toml", "--model", "model.toml", "--parameters", "theta.toml"]
    subprocess.run([*command, "--out", "out.csv"], cwd=folder, check=True, capture_output=True)
    with open(folder / "out.csv", encoding="utf-8") as file:
        (answer,) = csv.DictReader(line for line in file if not line.startswith("#"))
    return [float(answer[channel]) for channel in CHANNELS]


def refusal(model: umbridge.HTTPModel, values: list[list[float]], config: dict[str, object] | None = None) -> str:
    """What the client says of a question that has no answer."""
    try:
        answer = model(values, config or {})
    except Exception as error:  # The package raises no narrower one.
        return str(error)
    raise AssertionError(f"{values} has the answer {answer}")


def changed(name: str, value: float) -> list[list[float]]:
    """The question with another value of a parameter."""
    return [INPUT[0], [*(SOIL | {name: value}).values()]]


def check(url: str, worker: str, folder: Path) -> None:
    """Asks for all that the models are said to do."""
    assert umbridge.supported_models(url) == ["quasi_static", "scm"]
    # The protocol allows no other keys; the version is a header.
    info = requests.get(f"{url}/Info", timeout=60)
    assert info.json().keys() == {"protocolVersion", "models"}, info.text
    assert info.headers["model-version"].startswith("scm-"), info.headers
    about = requests.post(f"{url}/ModelInfo", json={"name": "scm"}, timeout=60).json()
    assert about.keys() == {"support"}, about
    for kind in ("quasi_static", "scm"):
        model = umbridge.HTTPModel(url, kind)
        assert model.get_input_sizes() == [len(side) for side in INPUT]
        assert model.get_output_sizes() == [len(CHANNELS)]
        assert model.supports_evaluate()
        assert not (model.supports_gradient() or model.supports_apply_jacobian() or model.supports_apply_hessian())
        (answer,) = model(INPUT)
        expected = simulated(worker, folder, kind)
        assert answer == expected, (kind, answer, expected)
        print(f"{kind}: {answer}, as worker simulate has it")
    model = umbridge.HTTPModel(url, "quasi_static")
    for question, reason in [
        (changed("friction_angle_deg", 95.0), "friction_angle_deg = 95 deg"),
        (changed("log10_p_ref", 0.0), "InvalidOutput"),
    ]:
        said = refusal(model, question)
        assert reason in said, (reason, said)
    said = refusal(model, INPUT, {"grouser_cuont": 3})
    assert "grouser_count" in said, said


if __name__ == "__main__":
    program, place = sys.argv[1], Path(sys.argv[2])
    served = subprocess.Popen([program, "serve", "--umbridge", "--port", "0"], stdout=subprocess.PIPE, text=True)
    try:
        assert served.stdout is not None
        check(served.stdout.readline().strip(), program, place)
    finally:
        served.terminate()
        served.wait(timeout=60)
