"""Tests of the benchmark: `python3 -m unittest discover benchmark/missing_effect/tests`; needs numpy and scipy."""
import importlib.machinery
import importlib.util
import json
import pathlib
import sys
import tempfile
import types
import unittest
from unittest import mock

import numpy as np

HERE = pathlib.Path(__file__).resolve().parents[1]
sys.path[:0] = [str(HERE), str(HERE / "entries")]
import adcd_residuals
import formula
import generate
import laws
import residual
import score
import wheel
from catalogue import EFFECTS, FAULT_EFFECTS, coordinate, quantile

# Runs without noise of another implementation (60 midpoint strips): slip, load in N, speed of the sled in m/s; pull in N, torque in N m, sinkage in m.
CONDITIONS = [(0.05, 60.0, 0.0095), (0.05, 120.0, 0.076), (0.4, 60.0, 0.048), (0.6, 120.0, 0.032)]
BASE = ({"k_phi": 6241438.514219137, "n": 1.1181419899594378, "friction_angle_deg": 27.871432958177856, "wheel_radius_m": 0.12851168438594004},
        [(10.579259926747266, 2.3007919250695914, 0.0058742104845941065), (41.84247413309578, 7.653433448545589, 0.008822198698920009),
         (22.87898163136781, 3.8657203477085504, 0.005785291164261102), (41.89493822679263, 7.660085933395466, 0.008821949551731347)])
JANOSI = ({"k_phi": 7499271.784033135, "n": 1.1149372768754235, "friction_angle_deg": 29.725862144637787, "wheel_radius_m": 0.12915290065986829},
          [(-3.0746821714584582, 0.5071066255374049, 0.0052791814330160605), (0.08564528375364229, 2.2371980372188993, 0.008070364274603128),
           (12.750391121040245, 2.533154668553348, 0.005191560300666093), (34.26239328831998, 6.591483470879664, 0.007880120726543666)])
OUTSIDE = ({"k_phi": 7209486.480966817, "n": 1.001560169645988, "friction_angle_deg": 26.748561584503463, "wheel_radius_m": 0.13240395977393504},
           [(14.420702063664354, 2.6581053813328044, 0.003474739475625754), (43.551877361016366, 7.621356632733342, 0.005429023797482253),
            (17.79754174611425, 3.102455134978885, 0.0034629902187287816), (32.45796519153955, 6.1668904696788, 0.0054699495014727114)])
LAW = {"acts_on": "shear", "depends_on": ["slip"], "operation": "times", "formula": "where(slip > c, b, 1)", "values": {"c": 0.3, "b": 0.8}}
SDS = (1.2, 0.15, 0.0004)


def solved(parameters, hooks):
    conditions = np.array(CONDITIONS)
    full = lambda x: np.full(len(conditions), x)
    runs = {"slip": conditions[:, 0], "wheel_load_n": conditions[:, 1], "sled_speed_m_s": conditions[:, 2], "width_m": full(0.112), "rig_radius_m": full(0.125)}
    soil = {"log10_p_ref": full(np.log10(parameters["k_phi"] * 0.01 ** parameters["n"])), "kappa": full(0.0)}
    soil |= {key: full(parameters[key]) for key in ("n", "friction_angle_deg", "wheel_radius_m")}
    return wheel.solve(runs, soil, hooks)[0]


class Model(unittest.TestCase):
    def test_agrees_with_another_implementation(self):
        modulus = {"shear_modulus_m": np.full((len(CONDITIONS), 1), 0.01)}
        for (parameters, expected), hooks in ((BASE, []), (JANOSI, [(EFFECTS["janosi_hanamoto"], modulus)]), (OUTSIDE, [(laws.effect(LAW), {})])):
            error = (solved(parameters, hooks) - np.array(expected)) / SDS
            self.assertLess(np.abs(error).max(), 0.01)

    def test_effects_are_absent_at_no_strength(self):
        base = solved(BASE[0], [])
        for name, effect in {**EFFECTS, **FAULT_EFFECTS}.items():
            if effect["priors"] and "shear_modulus_m" not in effect["priors"]:
                strength = {key: np.full((len(CONDITIONS), 1), 1e-9) for key in effect["priors"]}
                np.testing.assert_allclose(solved(BASE[0], [(effect, strength)]) / base, 1.0, rtol=1e-4, err_msg=name)

    def test_coordinates_of_priors(self):
        for name, effect in EFFECTS.items():
            for prior in effect["priors"].values():
                for u in (-1.3, 0.4):
                    self.assertAlmostEqual(float(coordinate(prior, quantile(prior, u))), u, 6, name)


class Generator(unittest.TestCase):
    def test_is_reproducible_byte_for_byte(self):
        kinds = {generate.kind_of(n, 1)[0]: n for n in range(60, 0, -1)}
        numbers = [kinds["nothing"], kinds["law"]]
        with tempfile.TemporaryDirectory() as first, tempfile.TemporaryDirectory() as second:
            lines = [[json.dumps(generate.campaign(n, 1, pathlib.Path(folder))) for n in numbers] for folder in (first, second)]
            self.assertEqual(*lines)
            for file in pathlib.Path(first).glob("campaigns/*/*"):
                self.assertEqual(file.read_bytes(), (pathlib.Path(second) / file.relative_to(first)).read_bytes())
            for word in ("law", "worth", "hidden", "truth"):
                self.assertFalse(any(word in file.read_text() for file in pathlib.Path(first).glob("campaigns/*/*")), word)

    def test_has_every_kind_as_often_as_stated(self):
        kinds = [generate.kind_of(n, 1) for n in range(500)]
        self.assertEqual(len(set(kinds)), 500)
        for kind, count in generate.KINDS.items():
            self.assertEqual(sum(k == kind for k, _ in kinds), count)


def truth(effects=(), law=None, kind="library", shortfall=None, accepted=(), fault=None, gain=50.0):
    worth = {name: 50.0 for name in effects} | ({"law": 50.0} if law else {})
    return {"number": 0, "kind": kind, "effects": {name: {} for name in effects}, "law": law, "fault": fault, "accepted": list(accepted),
            "oracle": {"worth": worth, "gain": gain, "shortfall": shortfall or {"load_scale": 40.0}, "places": {"pressure/slip": 1.0} if law else {}}, "sds": [1.0, 1.0, 1.0],
            "holdout": [[0.0, 0.0, 0.0]], "base_holdout": [[3.0, 3.0, 3.0]]}


def answer(verdict, named=(), members=(), law=None, probabilities=None, classes=(), faults=()):
    return {"verdict": verdict, "named": list(named), "class": list(members), "law": law, "probabilities": probabilities, "classes": list(classes), "faults": list(faults),
            "holdout": [[1.0, 1.0, 1.0]], "cpu_s": 1.0}


class Scorer(unittest.TestCase):
    def test_outcomes(self):
        place = lambda acts_on, *depends_on: {"acts_on": acts_on, "depends_on": list(depends_on), "formulas": []}
        shear, outside = place("shear", "v_t"), place("shear", "v_t") | {"support": {"points": {"v_t": [1.0]}, "values": [1.0]}}
        cases = [
            ("right", truth(["moisture"]), answer("named", ["moisture"])), ("wrong", truth(["moisture"]), answer("named", ["moisture", "hard_pan"])),
            ("part", truth(["moisture", "hard_pan"]), answer("named", ["moisture"])), ("class", truth(["moisture"]), answer("class", members=["moisture", "adhesion"])),
            ("alias", truth(["moisture"], shortfall={"adhesion": 1.0}), answer("named", ["adhesion"])), ("undecided", truth(["moisture"]), answer("undecided")),
            ("missed", truth(["moisture"]), answer("nothing")), ("right", truth(kind="nothing"), answer("nothing")),
            ("undecided", truth(kind="nothing"), answer("undecided")), ("wrong", truth(kind="nothing"), answer("named", ["moisture"])),
            ("right", truth(law=outside), answer("law", law=shear)), ("wrong", truth(law=outside), answer("law", law=place("torque", "slip"))),
            ("right", truth(law=outside), answer("law", law=place("pressure", "slip"))), ("wrong", truth(["moisture"]), answer("law", law=shear)),
            ("right", truth(kind="fault", fault={"name": "wrong_width"}, accepted=["wheel_width_error"]), answer("named", ["wheel_width_error"])),
            ("right", truth(kind="fault", fault={"name": "exchanged_sensors"}), answer("undecided", faults=["swapped_columns"])),
            ("wrong", truth(kind="fault", fault={"name": "exchanged_sensors"}), answer("named", ["moisture"])),
            ("wrong", truth(["moisture"]), answer("named", ["moisture"], faults=["force_zero"])),
            ("wrong", truth(kind="nothing"), answer("nothing", faults=["force_zero"])),
            ("wrong", truth(kind="scm", shortfall={"moisture": 0.0}, gain=0.0), answer("named", ["moisture"])),
            ("class", truth(law=outside), answer("law", law=shear | {"places": [["shear", ["v_t"]], ["torque", ["slip"]]]})),
            ("wrong", truth(law=outside), answer("law", law=shear | {"places": [["torque", ["slip"]], ["torque", ["sled_speed"]]]})),
            ("wrong", truth(law=outside), answer("law", law=shear) | {"laws": [shear, place("torque", "slip")]}),
            ("right", truth(law=outside), answer("law", law=shear) | {"laws": [shear, place("pressure", "slip")]}),
        ]
        for expected, hidden, said in cases:
            self.assertEqual(score.outcome(hidden, said), expected, (hidden, said))
        self.assertIsNone(score.outcome(truth(["moisture"]), answer(None)))

    def test_false_claims_count_every_campaign_with_nothing_hidden(self):
        campaigns = [truth(kind="nothing"), truth(kind="scm", shortfall={"moisture": 0.0}, gain=0.0), truth(["moisture"], kind="scm"),
                     truth(kind="fault", fault={"name": "sessions"})]
        cases = [score.judged(campaign, answer("named", ["moisture"])) for campaign in campaigns]
        self.assertEqual(score.false_claims(cases), ["2/2", "1/1"])

    def test_none_is_not_right_where_the_rig_is_at_fault(self):
        fault = {"name": "scaled_sinkage"}
        cases = [(True, truth(kind="nothing")), (True, truth(["end_wall"], gain=0.5)), (False, truth(["moisture"])), (False, truth(kind="fault", fault=fault, gain=2.0))]
        for expected, campaign in cases:
            self.assertEqual(score.is_lead_right(campaign, {"none"}), expected, campaign)

    def test_an_entry_offers_formulas_where_it_failed_too(self):
        law = {"acts_on": "shear", "depends_on": ["slip"], "formulas": ["slip"]}
        answers = score.without_failures({0: answer(None, law=law), 1: answer(None), 2: {"verdict": "failed", "note": ""}})
        self.assertEqual([(a["verdict"], a["offers_formulas"]) for a in answers.values()], [(None, True)] * 3)
        answers = score.without_failures({0: answer("nothing"), 1: {"verdict": "failed", "note": ""}})
        self.assertEqual([(a["verdict"], a["offers_formulas"]) for a in answers.values()], [("nothing", False), ("undecided", False)])

    def test_a_formula_is_judged_against_others_as_short(self):
        nats = {"power": 0.1, "bump": 0.5, "linear": 7.0, "hill": 9.0}
        hidden = lambda shape, formula: {"law": {"shape": shape, "operation": "times"}, "oracle": {"formula": formula}}
        self.assertTrue(score.is_formula_decidable(hidden("square", nats)))
        self.assertFalse(score.is_formula_decidable(hidden("threshold", nats)))
        self.assertTrue(score.is_formula_decidable(hidden("decay", {"saturation": 0.0, "bump": 1.0, "log": 5.0})))

    def test_leading_explanation_and_error(self):
        probabilities = {"moisture": 0.5, "adhesion": 0.35, "none": 0.15}
        self.assertEqual(score.leading(answer("class", probabilities=probabilities, classes=[["moisture", "adhesion"]])), ({"moisture", "adhesion"}, 0.85))
        case = score.judged(truth(["adhesion"]), answer("class", members=["moisture", "adhesion"], probabilities=probabilities, classes=[["moisture", "adhesion"]]))
        self.assertTrue(case["lead_right"])
        self.assertEqual((case["before"], case["after"], case["decidable"]), (3.0, 1.0, True))
        low, high = score.interval(9, 10)
        self.assertAlmostEqual(low, 0.606, 3)
        self.assertAlmostEqual(high, 0.995, 3)

    def test_equality_of_formulas(self):
        x = np.linspace(0.001, 0.02, 41)
        law = {"operation": "times", "values": {"a": -0.5, "s0": 0.005}, "support": {"points": {"v_t": x.tolist()}, "values": (1 - 0.5 * (1 - np.exp(-x / 0.005))).tolist()}}
        self.assertEqual(formula.is_law(law, ["1 + 0.9 * exp(-v_t / 0.004)"]), (True, True))
        self.assertEqual(formula.is_law(law, ["1 - 0.4 * v_t / (v_t + 0.004)", "2 * (0.6 - 0.4 * (1 - exp(-v_t / 0.006)))"]), (False, True))
        self.assertEqual(formula.is_law(law, ["1 - exp(-v_t / 0.01) * sinh(v_t / 0.01) / cosh(0 * v_t) + 0 * tan(v_t)"]), (True, True))
        self.assertEqual(formula.is_law(law, ["__import__('os')"]), (False, False))


class Entries(unittest.TestCase):
    def test_a_search_that_fails_is_noted(self):
        conditions = np.array([[0.1, 60.0, 0.01], [0.5, 120.0, 0.04]])
        base = types.SimpleNamespace(x=conditions, held_x=conditions, held=np.zeros((2, 3)), residuals=np.ones((2, 3)), sds=np.ones(3))
        formulas = iter(["unknown(x0)", ZeroDivisionError("no terms"), "100.0 * x1"])

        def search(x, y):
            text = next(formulas)
            if isinstance(text, Exception):
                raise text
            return text

        with mock.patch.object(residual, "Base", lambda folder: base):
            said = residual.entry(search)(None)
        self.assertRegex(said["note"], r"^drawbar_pull: unknown.*; torque: ZeroDivisionError: no terms$")
        self.assertEqual((said["law"], said["offers_formulas"]), (None, True))

    def test_constants_of_adcd_are_whole_words(self):
        fitted = types.SimpleNamespace(best_expr="t1*x0 + t10*x1", search_result=types.SimpleNamespace(best_theta={"t1": 2.0, "t10": 3.0}))
        with mock.patch.dict(sys.modules, adcd=types.SimpleNamespace(fit=lambda *values, **options: fitted)):
            self.assertEqual(adcd_residuals.search(np.zeros((1, 3)), np.zeros(1)), "(2.0)*x0 + (3.0)*x1")

    def test_an_answer_that_is_no_object_is_a_failure(self):
        loader = importlib.machinery.SourceFileLoader("run", str(HERE / "run"))
        run = importlib.util.module_from_spec(importlib.util.spec_from_loader("run", loader))
        loader.exec_module(run)
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "answer.json"
            for text in (None, "{", "[]", "{}", "\N{DEGREE SIGN}"):
                if text is not None:
                    file.write_text(text, encoding="latin-1")
                self.assertEqual(run.written_in(file)["verdict"], "failed", text)
            file.write_text('{"verdict": null}')
            self.assertEqual(run.written_in(file), {"verdict": None})


if __name__ == "__main__":
    unittest.main()
