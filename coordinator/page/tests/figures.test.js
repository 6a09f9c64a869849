import assert from "node:assert/strict";
import { test } from "node:test";
import { draw, picture } from "../figures/page.js";

const EVIL = '</svg><script>alert("1")</script>';
const figures = {
  experiment: EVIL,
  searches: [{ algorithm: EVIL, history: [
    { evaluations: 100, best: null, mean: null },
    { evaluations: 200, best: -5, mean: -2e3 },
    { evaluations: 300, best: -4, mean: -6 },
  ] }],
  stages: [
    { stage: 0, tempering_exponent: 0, evaluations: 100, log_likelihood: null },
    { stage: 1, tempering_exponent: 0.1, evaluations: 200, log_likelihood: { q05: -9, q50: -5, q95: -4, highest: -3 } },
    { stage: 2, tempering_exponent: 1, evaluations: 300, log_likelihood: { q05: -5, q50: -4, q95: -3, highest: -3 } },
  ],
  populations: {
    parameters: [{ name: EVIL, unit: "1" }, { name: "friction_angle_deg", unit: "deg" }],
    stages: [0, 1, 2].map((stage) => ({ stage, tempering_exponent: stage / 2, points: [[1, 30], [1.2, 12 + stage]] })),
  },
  posteriors: [{
    parameters: [{ name: "k_c", unit: "N/m^(n+1)" }, { name: EVIL, unit: "N/m^(n+2)" }],
    draws: 10,
    range: [[0, 2], [0, 2]],
    grid: [[0, 1, 2], [0, 1, 2]],
    density: [[0, 0.2, 0], [0.2, 1, 0.2], [0, 0.2, 0]],
    highest: 3,
    contours: [{ share: 0.95, density: 0.1 }, { share: 0.5, density: 0.6 }],
    rank_correlation: -0.5,
    marks: [
      { kind: "maximum_likelihood", label: EVIL, at: { x: 1, y: 1 } },
      { kind: "point_estimate", label: "GA optimum", at: { x: 0.5, y: 2 } },
      { kind: "reference", label: "bevameter", at: { x: 1.5, y: null } },
    ],
    lines: [{ label: `k* ${EVIL}`, points: [[0, 2], [2, 0]] }],
  }],
  histories: [{
    run: EVIL, channel: "drawbar_pull", unit: "N",
    measured: { t_s: [0, 1, 2], value: [1, 2, 1] },
    model: [
      { label: "maximum likelihood", t_s: [0, 1, 2], value: [1, 1.5, 1] },
      { label: "GA optimum", t_s: [0, 1, 2], value: [2, 2, 2] },
    ],
  }],
  errors: [{
    channel: "sinkage", unit: "m", runs: 1, draws: 9,
    grid: [0, 0.001, 0.002], density: [500, 300, 0],
    marks: [
      { kind: "mean", label: "mean", at: 0.0012 },
      { kind: "maximum_likelihood", label: "maximum likelihood", at: 0.0001 },
      { kind: "point_estimate", label: EVIL, at: 0.0002 },
    ],
  }],
};
const NAMES = ["search", "stages", "populations", "posterior", "history", "error"];

test("every figure is a picture with a name, and no text of a user becomes markup", () => {
  for (const name of NAMES) {
    const markup = picture(figures, name, 0);
    assert.match(markup, /^<svg role="img" aria-label="[^"]+"/, name);
    assert.ok(!markup.includes("<script"), name);
    assert.ok(!/NaN|undefined|Infinity|null/.test(markup), `${name}: ${markup}`);
    const opened = markup.match(/<svg/g).length;
    assert.equal(markup.match(/<\/svg>/g).length, opened, name);
  }
});

test("axes carry their units, sinkage in millimetres", () => {
  assert.match(picture(figures, "error", 0), /\|error\| of sinkage \[mm\]/);
  assert.match(picture(figures, "error", 0), /mean 1\.2 mm/);
  assert.match(picture(figures, "error", 0), /density \[1\/mm\]/);
  assert.match(picture(figures, "history", 0), /drawbar pull \[N\]/);
  assert.match(picture(figures, "posterior", 0), /k_c \[N\/m\^\(n\+1\)\]/);
});

test("several runs show their root mean square error", () => {
  const several = { errors: [{ ...figures.errors[0], runs: 2 }] };
  assert.match(picture(several, "error", 0), /root mean square error of sinkage/);
});

test("what is known in one coordinate is a line across, a place is a sign", () => {
  const markup = picture(figures, "posterior", 0);
  assert.equal(markup.match(/class="sign likeliest"/g).length, 2, "in the picture and in the legend");
  assert.equal(markup.match(/class="rule reference"/g).length, 4, "k* and the known exponent, both in the legend too");
  assert.equal(markup.match(/class="region"/g).length, 4, "two contours and the legend");
});

test("a search that was refused everything and draws without density are said in words or left out", () => {
  const refused = { searches: [{ algorithm: "ga", history: [{ evaluations: 9, best: null, mean: null }] }] };
  assert.match(picture(refused, "search", 0), /refused/);
  const flat = { errors: [{ ...figures.errors[0], density: [], grid: [0, 0.001] }] };
  assert.ok(!/NaN|undefined|Infinity/.test(picture(flat, "error", 0)));
  const same = { ...figures.errors[0], density: [], grid: [0, 0], marks: [{ kind: "mean", label: "mean", at: 0 }] };
  assert.ok(!/NaN|undefined|Infinity/.test(picture({ errors: [same] }, "error", 0)));
});

test("every place of a document gets its picture", () => {
  const places = NAMES.map((figure) => ({
    dataset: { figure, index: "0" },
    markup: "",
    insertAdjacentHTML(where, markup) { this.markup = where + markup; },
  }));
  draw({
    getElementById: (id) => (id === "figures-data" ? { textContent: JSON.stringify(figures) } : null),
    querySelectorAll: () => places,
  });
  for (const place of places) assert.ok(place.markup.startsWith("afterbegin<svg"));
  assert.throws(() => picture(figures, "nonsense", 0), /no figure nonsense/);
});
