// The form of the modules, as far as prettier leaves it to people: it breaks no texts and no templates.

import assert from "node:assert/strict";
import { readFile, readdir } from "node:fs/promises";
import { test } from "node:test";

const MODULES = new URL("../modules/", import.meta.url);
const MAX_COLUMNS = 120;
/** A text of the catalogue, or its translation: each stands whole, so that people find it by its words. */
const CATALOGUE_TEXT = /^ *".*"[:,]$/;

test("no line of a module is longer than 120 columns", async () => {
  const names = (await readdir(MODULES, { recursive: true })).filter((name) => name.endsWith(".js"));
  const long = [];
  for (const name of names) {
    const isCatalogue = /^language\/german_\w+\.js$/.test(name);
    for (const [k, line] of (await readFile(new URL(name, MODULES), "utf8")).split("\n").entries())
      if ([...line].length > MAX_COLUMNS && !(isCatalogue && CATALOGUE_TEXT.test(line))) long.push(`${name}:${k + 1}`);
  }
  assert.ok(names.length > 100, `${names.length} modules`);
  assert.deepEqual(long, []);
});
