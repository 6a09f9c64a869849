import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import vm from "node:vm";

import { symbol } from "../modules/chart/colour.js";
import { glyph } from "../modules/chart/glyph.js";

// The vendored libraries are scripts that leave their names behind, as in the document.
vm.runInThisContext(readFileSync(new URL("../vendor/d3.js", import.meta.url), "utf8"));
const { natsWords, shownNats } = await import("../modules/chart/information_map.js");
const { marksLike, moved, nearest, outline } = await import("../modules/chart/merged.js");
const { scaleOf, ticksOf } = await import("../modules/chart/pairs.js");
const { tickWords } = await import("../modules/words/quantity.js");

test("an estimate of information below 0 is drawn and called 0 within its error", () => {
  assert.equal(shownNats(-0.0005), 0);
  assert.equal(shownNats(0.07), 0.07);
  assert.match(natsWords(-0.0005), /^0 nats within the error/);
  assert.equal(natsWords(0.071), "0.071 nats");
});

test("the axis of a parameter ends at the bounds of its prior, in the unit that is shown", () => {
  const kappa = { name: "kappa", unit: "1", bounds: [-0.95, null], mean: -0.6, sd: 0.25, q05: -0.93, q95: -0.1 };
  assert.deepEqual(
    scaleOf(kappa, [0, 110])
      .domain()
      .map((v) => Number(v.toFixed(3))),
    [-0.95, 0.275],
  );
  const radius = {
    name: "wheel_radius_m",
    unit: "m",
    bounds: [0.125, 0.155],
    mean: 0.14,
    sd: 0.002,
    q05: 0.137,
    q95: 0.143,
  };
  assert.deepEqual(
    scaleOf(radius, [0, 110])
      .domain()
      .map((v) => Number(v.toFixed(3))),
    [133, 147],
  );
  // A logarithm is drawn as its quantity.
  const pressure = {
    name: "log10_p_ref",
    unit: "log10 Pa",
    bounds: [4, 5.6],
    mean: 4.5,
    sd: 0.02,
    q05: 4.46,
    q95: 4.53,
  };
  const axis = scaleOf(pressure, [0, 110]);
  assert.deepEqual(
    axis.domain().map((v) => Number(v.toFixed(1))),
    [26.9, 37.2],
  );
  assert.ok(Math.abs(axis(10 ** 1.5) - 55) < 1e-9);
});

test("labels of ticks stay in their cell and apart", () => {
  const wide = (/** @type {string} */ text) => 5.4 * text.length;
  for (const [low, high] of [
    [-0.95, 0.275],
    [133, 147],
    [0.99, 1.012],
    [1.2e6, 9.7e6],
    [0, 1],
    [-2e-5, 3e-5],
    [3.31, 3.34],
    [41.6, 49.9],
    [26.9, 372],
  ]) {
    for (const [side, kind] of [110, 180].flatMap((side) => [
      [side, "scaleLinear"],
      ...(low > 0 ? [[side, "scaleLog"]] : []),
    ])) {
      const axis = globalThis.d3[kind]([low, high], [0, side]);
      const values = ticksOf(axis, wide);
      const ends = values.map((v) => [axis(v) - wide(tickWords(v)) / 2, axis(v) + wide(tickWords(v)) / 2]);
      assert.ok(values.length > 0, `${low} to ${high}, ${kind}: no tick`);
      assert.ok(
        ends.every(([from, to]) => from >= -4 && to <= side + 4),
        JSON.stringify(ends),
      );
      assert.ok(
        ends.slice(1).every(([from], k) => from - ends[k][1] >= 4),
        JSON.stringify(ends),
      );
      assert.equal(new Set(values.map(tickWords)).size, values.length, `${low} to ${high}: ${values.map(tickWords)}`);
    }
  }
});

test("an element of a mark becomes a part of one path, at its place", () => {
  const element = (/** @type {string} */ tagName, /** @type {Record<string, string>} */ attributes) => ({
    tagName,
    getAttribute: (/** @type {string} */ name) => attributes[name] ?? null,
  });
  const place = ({ x, y, d }) => [x, y, d];
  assert.deepEqual(place(outline(element("circle", { cx: "10", cy: "5", r: "2" }))), [
    10,
    5,
    "M8,5a2,2 0 1,0 4,0a2,2 0 1,0 -4,0",
  ]);
  assert.deepEqual(place(outline(element("rect", { x: "1", y: "2", width: "4", height: "6" }))), [
    3,
    5,
    "M1,2h4v6h-4Z",
  ]);
  assert.deepEqual(place(outline(element("line", { x1: "1", y1: "2", x2: "1", y2: "8" }))), [1, 5, "M1,2L1,8"]);
  const symbol = "M-1,-1h2v2h-2Z";
  assert.deepEqual(place(outline(element("path", { transform: "translate(10.5,-3)", d: symbol }))), [
    10.5,
    -3,
    "M9.5,-4h2v2h-2Z",
  ]);
  assert.equal(moved("M2,0A2,2,0,1,1,-2,0L1e-3,4Z", 10, 20), "M12,20A2,2,0,1,1,8,20L10.001,24Z");
});

test("the marks of a group have the form of the first one, and places and colours of their own", () => {
  const element = (/** @type {string} */ tagName, /** @type {Record<string, string>} */ attributes) => ({
    tagName,
    getAttribute: (/** @type {string} */ name) => attributes[name] ?? null,
  });
  const runOf = (/** @type {number} */ place) => `r${place}`;
  const dots = marksLike(
    element("circle", { cx: "20", cy: "7", r: "2" }),
    [1, 2],
    { x: [0, 20, 30], y: [0, 7, 5], fill: ["", "red", "blue"] },
    runOf,
  );
  assert.deepEqual(
    dots.map(({ run, x, y, fill, stroke, d }) => [run, x, y, fill, stroke, d]),
    [
      ["r1", 20, 7, "red", null, "M18,7a2,2 0 1,0 4,0a2,2 0 1,0 -4,0"],
      ["r2", 30, 5, "blue", null, "M28,5a2,2 0 1,0 4,0a2,2 0 1,0 -4,0"],
    ],
  );
  const lines = marksLike(
    element("line", { x1: "1", y1: "2", x2: "1", y2: "8" }),
    [0, 1],
    { x: [1, 3], y1: [2, 4], y2: [8, 6] },
    runOf,
  );
  assert.deepEqual(
    lines.map(({ y, d }) => [y, d]),
    [
      [5, "M1,2V8"],
      [5, "M3,4V6"],
    ],
  );
});

test("a pointer means the nearest of merged marks, and none far away", () => {
  const marks = [
    { run: "a", x: 10, y: 10, reach: 6, d: "" },
    { run: "b", x: 18, y: 10, reach: 6, d: "" },
  ];
  assert.equal(nearest(marks, 13, 10), "a");
  assert.equal(nearest(marks, 15, 10), "b");
  assert.equal(nearest(marks, 80, 10), undefined);
});

test("no sign of a measurement is that of a value which a model computes at a single condition", () => {
  const signs = Array.from({ length: 8 }, (_, k) => symbol(k));
  assert.equal(new Set(signs).size, 8);
  assert.ok(!signs.includes("times"), `${signs}`);
  for (const k of signs.keys()) assert.ok(glyph(k), `${signs[k]} has a glyph for legends`);
});
