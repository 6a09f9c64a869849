import assert from "node:assert/strict";
import { readFile, readdir } from "node:fs/promises";
import { test } from "node:test";

import { GERMAN } from "../modules/language/german.js";
import { EFFECTS } from "../modules/language/german_effects.js";
import { PARAMETERS } from "../modules/language/german_parameters.js";
import { inTemplates, t, textsOf } from "../modules/language/language.js";
import { parameterName } from "../modules/words/quantity.js";

const MODULES = new URL("../modules/", import.meta.url);

/** The template literals of a source with their tags: nested ones stand on their own. @returns {{ tag: string, statics: string[] }[]} */
function templates(source) {
  const found = [];
  let at = 0;
  const string = (mark) => {
    for (at += 1; at < source.length && source[at] !== mark; at += 1) if (source[at] === "\\") at += 1;
    at += 1;
  };
  const comment = (end) => {
    const stop = source.indexOf(end, at);
    at = stop < 0 ? source.length : stop + end.length;
  };
  /** Reads code up to a closing brace. */
  const code = (isNested) => {
    for (let depth = 0; at < source.length;) {
      const sign = source[at];
      if (source.startsWith("//", at)) comment("\n");
      else if (source.startsWith("/*", at)) comment("*/");
      // A regular expression, which may hold quotes.
      else if (sign === "/" && /[(,=>:[!&|?{};]\s*$/.test(source.slice(Math.max(0, at - 80), at))) {
        for (let isClass = false; at < source.length;) {
          at += 1;
          if (source[at] === "\\") at += 1;
          else if (source[at] === "[") isClass = true;
          else if (source[at] === "]") isClass = false;
          else if (source[at] === "/" && !isClass) break;
        }
        at += 1;
      } else if (sign === '"' || sign === "'") string(sign);
      else if (sign === "`") template();
      else {
        if (sign === "{") depth += 1;
        if (sign === "}" && depth === 0 && isNested) return;
        if (sign === "}") depth -= 1;
        at += 1;
      }
    }
  };
  const template = () => {
    const own = { tag: /[A-Za-z]*$/.exec(source.slice(Math.max(0, at - 20), at))?.[0] ?? "", statics: [""] };
    found.push(own);
    for (at += 1; at < source.length && source[at] !== "`";) {
      if (source.startsWith("${", at)) {
        at += 2;
        code(true);
        at += 1;
        own.statics.push("");
      } else {
        own.statics[own.statics.length - 1] += source[at] === "\\" ? source[(at += 1)] : source[at];
        at += 1;
      }
    }
    at += 1;
  };
  code(false);
  return found;
}

const keyOf = (statics) => statics.reduce((all, text, k) => `${all}{${k - 1}}${text}`).replace(/\s*\n\s*/g, " ");

/** Every text of the page, with the file that has it. */
async function texts() {
  const names = (await readdir(MODULES, { recursive: true })).filter(
    (name) => name.endsWith(".js") && !/^(interface|language)\//.test(name),
  );
  const found = new Map();
  for (const name of names) {
    const source = await readFile(new URL(name, MODULES), "utf8");
    for (const { tag, statics } of templates(source)) {
      const own = tag === "t" ? [keyOf(statics)] : tag === "html" ? textsOf(statics) : [];
      for (const text of own) found.set(text, name);
    }
    // Words of the service that the page knows.
    for (const [, list] of source.matchAll(/translated\("([^"]+)"\)/g)) found.set(list, name);
  }
  return found;
}

/** What is a name, a unit or a symbol in every language. */
const SAME = /^(Grouser|SVG|PNG|CSV|P \{0\}|n|ln|p|[NmPa]+|[a-z]+\.(toml|csv)|(coordinator|worker) .*)$/;
/** States of the service, and what a search does: no module spells them. */
const OF_SERVICE = [
  "corrected",
  "maximum likelihood",
  "queued",
  "running",
  "paused",
  "waiting",
  "finished",
  "failed",
  "cancelled",
  "tries each effect alone",
  "tries the model without each of its effects",
  "tries effects that belong together",
  "combines effects",
  "leaves out effects of the best combinations",
  "exchanges effects that the data hardly tell apart",
  "tries laws outside the library",
  "tries effects beside a law outside the library",
  "tests a law on conditions that are left out",
  "tries effects in the place of those of the model",
  "tests the leading explanations on conditions that are left out",
  "fits formulas of a law outside the library",
  "chooses the runs that would tell",
  "is over",
];

test("every text of the page is in the German catalogue, and the catalogue has no other", async () => {
  const all = await texts();
  assert.ok(all.size > 300, `${all.size} texts`);
  const missing = [...all.keys()].filter((text) => !(text in GERMAN) && !SAME.test(text));
  assert.deepEqual(
    missing.map((text) => `${all.get(text)}: ${text}`),
    [],
  );
  const unused = Object.keys(GERMAN).filter(
    (text) => !all.has(text) && !OF_SERVICE.includes(text) && !(text in EFFECTS) && !(text in PARAMETERS),
  );
  assert.deepEqual(unused, []);
});

const ROOT = new URL("../../../", import.meta.url);
const CATALOGUE = new URL("shared/formula/catalogue/", ROOT);

/** The texts of the effect files of the service. */
const effectFiles = async () =>
  Promise.all((await readdir(CATALOGUE)).map((name) => readFile(new URL(name, CATALOGUE), "utf8")));

test("every parameter that has a word for a name has one in German, and nothing else", async () => {
  const ofEffects = (await effectFiles()).flatMap((text) => [
    ...text.matchAll(/^\[parameters\.(\w+)\]\nunit = "(.+)"$/gm),
  ]);
  const source = await readFile(new URL("shared/src/parameters.rs", ROOT), "utf8");
  const ofModels = [...source.matchAll(/(?:base|inferred)\(\s*"(\w+)",\s*"([^"]+)"/g)];
  const names = new Set([...ofEffects, ...ofModels].map(([, name, unit]) => parameterName(name, unit)));
  // Symbols are the same in every language.
  const isSymbol = (/** @type {string} */ name) =>
    /^(log10 )?[a-z]+( [a-z]{1,3})?\d?$/.test(name) && !(name in PARAMETERS);
  const symbols = [...names].filter(isSymbol);
  assert.deepEqual(symbols.sort(), ["c1", "c2", "k c", "k phi", "kappa", "log10 p ref", "n", "xi n"]);
  assert.deepEqual(
    [...names].filter((name) => !isSymbol(name) && !(name in PARAMETERS)),
    [],
  );
  assert.deepEqual(
    Object.keys(PARAMETERS).filter((name) => !names.has(name)),
    [],
  );
});

test("what every effect of the service does is said in German, and nothing else", async () => {
  const catalogue = await effectFiles();
  const settings = await readFile(new URL("coordinator/job/src/model_switch.rs", ROOT), "utf8");
  const parameters = await readFile(new URL("coordinator/job/src/plain_parameter.rs", ROOT), "utf8");
  const summaries = [
    ...catalogue.flatMap((text) => [...text.matchAll(/^summary = "(.+)"$/gm)]),
    ...settings.matchAll(/summary: "(.+)"/g),
    ...parameters.matchAll(/"(?:\{ .+ \})",\s+"(.+)",/g),
  ].map(([, summary]) => summary);
  assert.ok(summaries.length > 60, `${summaries.length} effects`);
  assert.deepEqual(
    summaries.filter((summary) => !(summary in EFFECTS)),
    [],
  );
  assert.deepEqual(
    Object.keys(EFFECTS).filter((text) => !summaries.includes(text) && !text.startsWith("runs ")),
    [],
  );
});

test("a translation has the parts of its text", () => {
  const parts = (text) => [...text.matchAll(/\{\d+\}/g)].map(([part]) => part).sort();
  for (const [text, german] of Object.entries(GERMAN)) assert.deepEqual(parts(german), parts(text), text);
});

test("a template is translated as sentences, whose parts may change their order", () => {
  const tag = (statics, ...fields) => statics.reduce((all, text, k) => `${all}${fields[k - 1]}${text}`);
  const german = inTemplates(
    { "Show {0} of {1}": "Von {1} zeige {0}", "To the list": "Zur Liste", Name: "Name der Studie" },
    tag,
  );
  const page = (a, b) => german`<p class=${"x"}>
    Show ${a} of ${b}</p><a href="#/" title="To the list">${a} ${b}</a><i>Name</i>`;
  assert.equal(
    page(1, 2),
    '<p class=x>\n    Von 2 zeige 1</p><a href="#/" title="Zur Liste">1 2</a><i>Name der Studie</i>',
  );
  assert.equal(
    page(3, 4),
    '<p class=x>\n    Von 4 zeige 3</p><a href="#/" title="Zur Liste">3 4</a><i>Name der Studie</i>',
  );
});

test("a text that goes over several lines of its module has a space for each end of a line", () => {
  assert.equal(
    t`the model refuses ${3}
      of ${5} draws`,
    "the model refuses 3 of 5 draws",
  );
});
