// Words of the page in German: the language is that of the browser when the modules are loaded.

import assert from "node:assert/strict";
import { test } from "node:test";

Object.defineProperty(globalThis, "navigator", { value: { language: "de-DE" } });
const { translated } = await import("../modules/language/language.js");
const { parameterName } = await import("../modules/words/quantity.js");

test("the words of a parameter's name are translated, and no name that somebody gave a wheel", () => {
  assert.equal(parameterName("cohesion_pa", "Pa"), "Kohäsion");
  assert.equal(translated("finished"), "fertig");
  // Each is a word of the catalogue, and none of a parameter.
  for (const wheel of ["finished", "Delete", "constructor"])
    assert.equal(parameterName(`cohesion_pa.${wheel}`, "Pa"), `Kohäsion: ${wheel}`);
  assert.equal(translated("constructor"), "constructor");
});
