#!/usr/bin/env python3
"""The wheel of wheel.py by UM-Bridge, protocol 1.0, with Python's own modules: server.py [PORT].

Its model "wheel" takes two vectors, the properties of a run and the parameters, and gives one: drawbar pull, torque, sinkage.
"""
import json
import sys
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

from wheel import wheel

INPUTS = ["slip", "wheel_load_n", "radius_m", "width_m"]
PARAMETERS = ["k_phi", "n", "friction_angle_deg", "shear_modulus_m", "peak_share"]
SIZES = [len(INPUTS), len(PARAMETERS)]


def evaluate(body):
    """Status and answer of a request to /Evaluate."""
    if [len(vector) for vector in body["input"]] != SIZES:
        return 400, {"error": {"type": "InvalidInput", "message": f"the input sizes are {SIZES}"}}
    try:
        channels = wheel(**dict(zip(INPUTS + PARAMETERS, sum(body["input"], []))))
    except ValueError as reason:
        return 500, {"error": {"type": "InvalidOutput", "message": str(reason)}}
    return 200, {"output": [[channels[name] for name in ("drawbar_pull_n", "torque_n_m", "sinkage_m")]]}


def post(path, body):
    """Status and answer of a POST."""
    if body.get("name") != "wheel":
        return 400, {"error": {"type": "ModelNotFound", "message": f"no model {body.get('name')}"}}
    support = {"Evaluate": True, "Gradient": False, "ApplyJacobian": False, "ApplyHessian": False}
    routes = {
        "/ModelInfo": lambda: (200, {"support": support}),
        "/InputSizes": lambda: (200, {"inputSizes": SIZES}),
        "/OutputSizes": lambda: (200, {"outputSizes": [3]}),
        "/Evaluate": lambda: evaluate(body),
    }
    unsupported = 400, {"error": {"type": "UnsupportedFeature", "message": f"no {path}"}}
    return routes.get(path, lambda: unsupported)()


class Handler(BaseHTTPRequestHandler):
    """GET /Info, and POST of everything else."""

    protocol_version = "HTTP/1.1"
    disable_nagle_algorithm = True

    def answer(self, status, value):
        body = json.dumps(value).encode()
        self.send_response(status)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def do_GET(self):
        self.answer(200, {"protocolVersion": 1.0, "models": ["wheel"]})

    def do_POST(self):
        length = int(self.headers.get("Content-Length", 0))
        self.answer(*post(self.path, json.loads(self.rfile.read(length) or b"{}")))

    def log_message(self, *_):
        pass


if __name__ == "__main__":
    server = ThreadingHTTPServer(("127.0.0.1", int((sys.argv + ["4242"])[1])), Handler)
    print(f"http://127.0.0.1:{server.server_port}", flush=True)
    server.serve_forever()
