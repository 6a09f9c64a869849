import assert from "node:assert/strict";
import { test } from "node:test";
import { rings } from "../figures/contour.js";

/** Area inside a ring, by the shoelace formula. */
function area(ring) {
  const sum = ring.reduce((total, [x, y], k) => {
    const [u, v] = ring[(k + 1) % ring.length];
    return total + x * v - u * y;
  }, 0);
  return Math.abs(sum) / 2;
}

const grid = (n, half) => Array.from({ length: n }, (_, k) => half * (2 * k / (n - 1) - 1));

test("the contour of a cone is a circle", () => {
  const g = grid(81, 2);
  const cone = g.map((y) => g.map((x) => 2 - Math.hypot(x, y)));
  const found = rings([g, g], cone, 1);
  assert.equal(found.length, 1);
  for (const [x, y] of found[0]) assert.ok(Math.abs(Math.hypot(x, y) - 1) < 1e-3);
  assert.ok(Math.abs(area(found[0]) - Math.PI) < 0.01);
});

test("two summits give two rings, a hollow gives a hole", () => {
  const g = grid(81, 2);
  const two = g.map((y) => g.map((x) => Math.exp(-8 * ((Math.abs(x) - 1) ** 2 + y * y))));
  assert.equal(rings([g, g], two, 0.5).length, 2);
  const hollow = g.map((y) => g.map((x) => Math.exp(-8 * (Math.hypot(x, y) - 1) ** 2)));
  const found = rings([g, g], hollow, 0.5).map(area).sort((a, b) => a - b);
  assert.equal(found.length, 2);
  // exp(-8 d^2) = 1/2 at d = 0.2943
  const expected = [1 - 0.2943, 1 + 0.2943].map((r) => Math.PI * r * r);
  found.forEach((a, k) => assert.ok(Math.abs(a - expected[k]) < 0.05, `${a} ${expected[k]}`));
});

test("what is cut by the border is closed along it", () => {
  const g = [0, 1, 2];
  const ramp = g.map(() => [1, 0.5, 0]);
  // above 0.5 everything up to x = 1
  assert.ok(Math.abs(area(rings([g, g], ramp, 0.5)[0]) - 2) < 1e-12);
  const flat = g.map(() => [1, 1, 1]);
  assert.ok(Math.abs(area(rings([g, g], flat, 0.5)[0]) - 4) < 1e-12);
});

test("a saddle keeps its rings closed and apart", () => {
  const g = [0, 1];
  const found = rings([g, g], [[1, 0], [0, 1]], 0.6);
  assert.equal(found.length, 2);
  const together = rings([g, g], [[1, 0], [0, 1]], 0.4);
  assert.equal(together.length, 1);
});
