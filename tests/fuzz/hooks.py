"""What generated requests need to get beyond the first check: an id that exists, the protocol, files that are nearly valid.

Half of the requests, by a hash of what was generated, so that a seed gives the same ones again.
"""

import json
import pathlib
import random
import zlib

import schemathesis

EXAMPLE = pathlib.Path(__file__).parents[2] / "examples" / "hidden-effect"
EXPERIMENT, RUNS = [(EXAMPLE / name).read_text() for name in ("experiment.toml", "runs.csv")]
# A fit, which a worker computes in a moment.
JOB = (EXAMPLE / "job.toml").read_text().split("[discovery]")[0] + "algorithm = \"lm\"\nparticles = 50\n"
EFFECT = """name = "mine"
summary = "s"
source = "s"
drawbar_pull = "drawbar_pull * (1 + gain)"
[parameters.gain]
unit = "1"
neutral = 0.0
prior = { normal = [0.0, 0.2] }
"""
WORDS = ["0", "-1", "1e308", "nan", "", "[", "{", "\"", "\u0007", "9" * 400, "[model]", "= = ="]


def chance(generated):
    """Random numbers that follow from what was generated."""
    return random.Random(zlib.crc32(json.dumps(generated, sort_keys=True, default=str).encode()))


def nearly(text, dice):
    """A text of which a few lines are lost, doubled, or cut by a word."""
    lines = text.splitlines()
    for _ in range(dice.choice([0, 0, 1, 1, 3])):
        place = dice.randrange(len(lines))
        line = lines[place]
        cut = dice.randint(0, len(line))
        lines[place] = dice.choice([line[:cut] + dice.choice(WORDS) + line[cut + 1 :], "", line + "\n" + line])
    return "\n".join(lines) + "\n"


@schemathesis.hook
def map_path_parameters(context, path_parameters):
    path, method = context.operation.path, context.operation.method.lower()
    if path_parameters and "id" in path_parameters:
        dice = chance([path, path_parameters])
        exists = dice.random() < 0.5
        if method == "delete" or (method == "get" and path.endswith("/follow")):
            path_parameters["id"] = 10**6  # The study of the example stays; the events of a campaign do not end.
        elif exists:
            path_parameters["id"] = dice.randint(1, 2)
        elif path.endswith("/events"):
            path_parameters["id"] = 10**6  # The events of a calibration that is not over do not end.
    return path_parameters


@schemathesis.hook
def map_body(context, body):
    dice = chance(body)
    path = context.operation.path
    if not isinstance(body, dict) or dice.random() < 0.5:
        return body
    if path == "/v1/work/exchange":
        body |= {"protocol": 12, "wait_ms": 0}
    elif path == "/v1/experiments":
        body |= {"toml": nearly(EXPERIMENT, dice), "files": {"runs.csv": nearly(RUNS, dice)}}
    elif path == "/v1/calibrations":
        body |= {"experiment": 1, "toml": nearly(JOB, dice), "webhook": None, "files": {}}
    elif path == "/v1/effects":
        body = {"text": nearly(EFFECT, dice)}
    elif path.endswith("/runs"):
        body = {"runs": nearly(RUNS.replace("\nr", "\nmore"), dice)}
    elif path.endswith("/extend"):
        body = {"effect_file": {"name": f"mine{dice.randrange(9)}.toml", "text": nearly(EFFECT, dice)}}
    return body
