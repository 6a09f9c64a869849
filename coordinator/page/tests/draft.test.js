import assert from "node:assert/strict";
import { test } from "node:test";

import { parse } from "../modules/columns.js";
import { experimentOf, fileOf, kindOf, missing, requests } from "../modules/draft.js";
import * as modelChoices from "../modules/part/model_choices.js";
import * as template from "../modules/template.js";

const RUNS = "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,history\na,w,s,0.2,100,0.01,logs/a.csv\n";
const FILES = {
  "job.toml":
    'experiment = "rig.toml" # not "other.toml"\n[model]\nkind = "quasi_static"\neffect_files = [\n  "mine.toml",\n]\n',
  "rig.toml": 'runs = "runs.csv"\n[wheel.w]\n[soil.s]\n',
  "runs.csv": RUNS,
  "mine.toml": 'name = "mine"\nsinkage = "sinkage + 1"\n',
};

test("files are told by their content", () => {
  assert.deepEqual(
    Object.entries(FILES).map(([name, text]) => kindOf(name, text)),
    ["job", "experiment", "runs", "effect"],
  );
  assert.equal(kindOf("a.csv", "t_s,torque_n_m\n"), "history");
  assert.equal(kindOf("a.csv", "Rad;Last\n"), "table");
});

test("what is named and absent is said, with who names it", () => {
  assert.equal(experimentOf(FILES, "job.toml"), "rig.toml");
  assert.deepEqual(missing(FILES, "job.toml"), ["logs/a.csv, which runs.csv names"]);
  assert.match(missing({}, null)[0], /a job file/);
  assert.match(missing({ "job.toml": FILES["job.toml"] }, "job.toml")[0], /^rig.toml, the experiment of job.toml/);
});

test("a file without its folder is the one that is named", () => {
  const files = { ...FILES, "a.csv": "t_s,torque_n_m\n0.1,2\n" };
  assert.deepEqual(missing(files, "job.toml"), []);
  const sent = requests(files, "job.toml", "rig.toml");
  assert.deepEqual(Object.keys(sent.experiment.files), ["runs.csv", "logs/a.csv"]);
  assert.deepEqual(Object.keys(sent.job.files), ["mine.toml"]);
});

test("a message finds its file", () => {
  assert.equal(fileOf('experiment.toml line 5: unknown key "foo"', FILES, "job.toml", "rig.toml"), "rig.toml");
  assert.equal(fileOf("runs.csv line 2: no number", FILES, "job.toml", "rig.toml"), "runs.csv");
  assert.equal(fileOf("the service is busy", FILES, "job.toml", "rig.toml"), null);
});

test("templates name what the form says", () => {
  const smooth = { grousers: null, grouserHeightMm: null, grouserThicknessMm: null };
  const wheels = [
    { name: "a", radiusMm: 125, widthMm: 112, ...smooth },
    { name: "b c", radiusMm: 60, widthMm: 60, ...smooth },
  ];
  const open = { density: null, binLength: null, slip: null, load: null, speed: null };
  const noise = { drawbar_pull_n: "1.2", sinkage_m: "unknown" };
  const toml = template.experiment({ wheels, soil: "s", noise, bounds: open });
  assert.doesNotMatch(toml, /grouser|density|\[rig\]/);
  const bounds = { density: 1600, binLength: 2.5, slip: [-0.2, 0.6], load: [40, 120], speed: [0.005, 0.02] };
  const whole = template.experiment({
    wheels: [{ ...wheels[0], grousers: 12, grouserHeightMm: 9, grouserThicknessMm: 2 }],
    soil: "s",
    noise,
    bounds,
  });
  assert.match(whole, /grouser_count = 12\ngrouser_height_m = 0\.009\ngrouser_thickness_m = 0\.002\n/);
  assert.match(whole, /\[soil\.s\]\ndensity_kg_m3 = 1600\n/);
  assert.match(
    whole,
    /\[rig\]\nbin_length_m = 2\.5\nslip_range = \[-0\.2, 0\.6\]\nwheel_load_range_n = \[40, 120\]\nsled_speed_range_m_s = \[0\.005, 0\.02\]\n/,
  );
  assert.match(toml, /\[wheel\.a\]\nradius_m = 0\.125\nwidth_m = 0\.112\n/);
  assert.match(toml, /\[wheel\."b c"\]/);
  assert.match(toml, /drawbar_pull_n = 1\.2\nsinkage_m = "unknown"/);
});

test("a job has the priors of its models, a table for each model, and the effects from the start", () => {
  const wheels = [
    { name: "a", radiusMm: 125 },
    { name: "b c", radiusMm: 60 },
  ];
  const priors = template.priorsOf(wheels);
  const one = template.job({ models: ["quasi_static"], priors, effects: [], search: "auto" });
  assert.match(one, /"wheel_radius_m\.a" = \{ uniform = \[0\.125, 0\.155\] \}/);
  assert.match(one, /\[discovery\]\napply = "auto"/);
  assert.match(one, /\[model\]\nkind = "quasi_static"\n\n/);
  assert.match(one, /^n = \{ normal = \[1\.1, 0\.2\], bounds = \[0\.8, 2\.0\] \}/m);
  assert.ok(!one.includes("xi_n_pa_m") && !one.includes("algorithm"));
  const several = template.job({ models: ["wong_reece", "rft"], priors, effects: ["slip_sinkage"], search: "ask" });
  assert.equal(several.match(/\[\[models\]\]\nkind = ".*"\neffects = \["slip_sinkage"\]\n/g)?.length, 2);
  assert.match(several, /^xi_n_pa_m = \{ loguniform = \[100000\.0, 100000000\.0\] \}/m);
  assert.match(template.job({ models: ["scm"], priors, effects: [], search: "off" }), /^algorithm = "lm"/m);
  const alone = template.job({ models: ["rft"], priors, effects: [], search: "off" });
  assert.ok(!alone.includes("friction_angle_deg") && alone.includes("wheel_radius_m"));
});

test("a typed prior takes the place of the proposed one, and what is no prior is said", () => {
  const typed = (form, ...texts) => ({
    models: ["quasi_static"],
    effects: [],
    search: "ask",
    changed: { n: { form, texts } },
  });
  const n = (choices) =>
    modelChoices.priorsOf(choices, [{ name: "w", radiusMm: 125 }]).find((prior) => prior.name === "n");
  assert.deepEqual(n(typed("uniform", "0,9", "1.4")).numbers, [0.9, 1.4]);
  assert.equal(n(typed("uniform", "0,9", "1.4")).bounds, null);
  assert.deepEqual(n(typed("normal", "1", "0.1")).bounds, [0.8, 2]);
  for (const bad of [typed("uniform", "2", "1"), typed("normal", "1", "0"), typed("fixed", "", "1")]) {
    assert.equal(modelChoices.badPriors(bad, ["w"]).length, 1);
    assert.deepEqual(n(bad).numbers, [1.1, 0.2]);
  }
  assert.deepEqual(modelChoices.badPriors(typed("fixed", "1", ""), ["w"]), []);
});

test("priors of models and wheels that are not chosen are not judged, and a loguniform prior is above 0", () => {
  const typed = (models, name, form, ...texts) => ({
    models,
    effects: [],
    search: "ask",
    changed: { [name]: { form, texts } },
  });
  const bad = (wheels, ...of) => modelChoices.badPriors(typed(...of), wheels).length;
  assert.equal(bad(["w"], ["rft"], "xi_n_pa_m", "loguniform", "2", "1"), 1);
  assert.equal(bad(["w"], ["quasi_static"], "xi_n_pa_m", "loguniform", "2", "1"), 0);
  assert.equal(bad(["a", "b"], ["rft"], "wheel_radius_m.b", "uniform", "2", "1"), 1);
  assert.equal(bad(["a"], ["rft"], "wheel_radius_m.b", "uniform", "2", "1"), 0);
  for (const low of ["0", "-1"])
    assert.deepEqual(modelChoices.badPriors(typed(["rft"], "xi_n_pa_m", "loguniform", low, "1"), ["w"]), [
      "prior of xi n pa m: two numbers above 0, the smaller first",
    ]);
  assert.equal(bad(["w"], ["rft"], "xi_n_pa_m", "loguniform", "0,1", "1"), 0);
});
