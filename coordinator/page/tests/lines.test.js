// The form of the modules, as far as prettier leaves it to people: it breaks no texts and no templates.

import assert from "node:assert/strict";
import { readFile, readdir } from "node:fs/promises";
import { test } from "node:test";

const MODULES = new URL("../modules/", import.meta.url);
const MAX_COLUMNS = 120;
/** A text of the catalogue, or its translation: each stands whole, so that people find it by its words. */
const CATALOGUE_TEXT = /^ *".*"[:,]$/;

const names = (await readdir(MODULES, { recursive: true })).filter((name) => name.endsWith(".js"));
const textOf = (name) => readFile(new URL(name, MODULES), "utf8");

/** The types of the comments of a source: what stands in braces behind a tag. */
function typesOf(source) {
  const types = [];
  for (const { index } of source.matchAll(/@(?:type|typedef|param|returns|template)\s*\{/g)) {
    const begin = source.indexOf("{", index);
    let end = begin;
    for (let depth = 0; end < source.length; end += 1) {
      if (source[end] === "{") depth += 1;
      if (source[end] === "}") depth -= 1;
      if (depth === 0) break;
    }
    types.push(source.slice(begin, end + 1));
  }
  return types;
}

test("no line of a module is longer than 120 columns", async () => {
  const long = [];
  for (const name of names) {
    const isCatalogue = /^language\/german_\w+\.js$/.test(name);
    for (const [k, line] of (await textOf(name)).split("\n").entries())
      if ([...line].length > MAX_COLUMNS && !(isCatalogue && CATALOGUE_TEXT.test(line))) long.push(`${name}:${k + 1}`);
  }
  assert.ok(names.length > 100, `${names.length} modules`);
  assert.deepEqual(long, []);
});

test("no module has a value of any type", async () => {
  const loose = [];
  let count = 0;
  for (const name of names) {
    const types = typesOf(await textOf(name));
    count += types.length;
    for (const type of types) if (/\bany\b/.test(type)) loose.push(`${name}: ${type}`);
  }
  assert.ok(count > 500, `${count} types`);
  assert.deepEqual(loose, []);
});
