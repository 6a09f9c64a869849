// The language of the page: that of the browser, or the one that a person chose. A text is known by its English form;
// what the catalogue of a language lacks, and what the service says, stays English.

import { kept } from "../kept.js";

export const LANGUAGES = { en: "English", de: "Deutsch" };

const chosen = kept("language", Object.keys(LANGUAGES), globalThis.navigator?.language?.slice(0, 2) ?? "en");

/** The language of the page. */
export const language = chosen.value;

/** Chooses a language; the page begins anew in it. */
export const choose = (/** @type {string} */ to) => chosen.change(to);

const loadGerman = () => import("./german.js");
const german = language === "de" ? await loadGerman() : null;
/** @type {Record<string, string> | null} texts by their English form; `{0}` stands for the first part that varies */
const catalogue = german?.GERMAN ?? null;
if (globalThis.document) document.documentElement.lang = language;

/** The end of a line within a text, with the indentation of the next. */
const BROKEN = /\s*\n\s*/g;

/**
 * A text with parts that vary: `t`3 of ${n} studies``; a text that goes over several lines of its module has a space
 * for each end of a line.
 * @param {TemplateStringsArray} texts
 * @param {unknown[]} parts
 * @returns {string}
 */
export function t(texts, ...parts) {
  const english = texts.reduce((all, text, k) => `${all}{${k - 1}}${text}`).replace(BROKEN, " ");
  return (catalogue?.[english] ?? english).replace(/\{(\d)\}/g, (_, k) => String(parts[Number(k)]));
}

/** A text of the service, such as a state or what an effect does, where the catalogue has it. */
export const translated = (/** @type {string} */ text) => textIn(catalogue, text);

/** The words of a parameter's name; a name that somebody gave, such as that of a wheel, is none of them. */
export const translatedParameter = (/** @type {string} */ words) => textIn(german?.PARAMETERS ?? null, words);

/** A text in a language; itself where the texts of the language lack it. */
const textIn = (/** @type {Record<string, string> | null} */ texts, /** @type {string} */ text) =>
  texts !== null && Object.hasOwn(texts, text) ? texts[text] : text;

const ofService = () => import("./german_service.js").then((module) => module.germanOf);
const germanOf = language === "de" ? await ofService() : null;

/** A sentence of the service in the language of the page; in English where that has no words for it. */
export function told(/** @type {string} */ text) {
  const german = germanOf?.(text) ?? null;
  return german === null ? text : decimal(german);
}

/** A text with the decimal marks of the language of the page; `v2.1`, `run-1.2` and dates are no numbers. */
export const decimal = (/** @type {string} */ text) =>
  language === "de" ? text.replace(/(?<![\w.]|[A-Za-z_]-)(\d+)\.(?=\d+(?!\w|\.\d))/g, "$1,") : text;

/** The place of a part that varies, within the text of a template. */
const MARK = /\0(\d+)\0/g;
/** Attributes that are read to people. */
const READ = /( (?:aria-label|title|label|placeholder|what|note)=")([^"]+)"/g;
/** A text between tags, with the white space around it. */
const BETWEEN = /(^|>)(\s*)([^<>]+?)(\s*)(?=<|$)/g;

/**
 * The texts of a template that a catalogue knows, each with the numbers of its parts.
 * @param {readonly string[]} statics
 * @returns {string[]} with `{0}` for the first part of each
 */
export function textsOf(statics) {
  /** @type {string[]} */
  const texts = [];
  replaced(statics, (text) => {
    texts.push(text);
    return text;
  });
  return texts;
}

/** The text of a template with its texts replaced; texts without a letter stay. */
function replaced(/** @type {readonly string[]} */ statics, /** @type {(text: string) => string} */ by) {
  const whole = statics.reduce((all, text, k) => `${all}\0${k - 1}\0${text}`);
  const ofText = (/** @type {string} */ text) => {
    /** @type {string[]} */
    const parts = [];
    const key = text.replace(/\s+/g, " ").replace(MARK, (mark) => `{${parts.push(mark) - 1}}`);
    return /\p{L}/u.test(key.replace(/&\w+;/g, "")) ? by(key).replace(/\{(\d+)\}/g, (_, k) => parts[Number(k)]) : text;
  };
  return whole
    .replace(BETWEEN, (_, before, space, text, after) => `${before}${space}${ofText(text)}${after}`)
    .replace(READ, (_, head, text) => `${head}${ofText(text)}"`);
}

/**
 * A template tag whose templates are in the language of a catalogue.
 * @template T
 * @param {Record<string, string>} texts
 * @param {(statics: TemplateStringsArray, ...fields: unknown[]) => T} tag
 * @returns {(statics: TemplateStringsArray, ...fields: unknown[]) => T}
 */
export function inTemplates(texts, tag) {
  /** @type {WeakMap<readonly string[], { statics: TemplateStringsArray, order: number[] }>} */
  const known = new WeakMap();
  return (statics, ...fields) => {
    let template = known.get(statics);
    if (!template) {
      const pieces = replaced(statics, (text) => texts[text] ?? text).split(MARK);
      const kept = pieces.filter((_, k) => k % 2 === 0);
      const order = pieces.filter((_, k) => k % 2 === 1).map(Number);
      template = { statics: Object.assign(kept, { raw: kept }), order };
      known.set(statics, template);
    }
    return tag(template.statics, ...template.order.map((k) => fields[k]));
  };
}

/**
 * A template tag whose templates are in the language of the page.
 * @template T
 * @param {(statics: TemplateStringsArray, ...fields: unknown[]) => T} tag
 * @returns {(statics: TemplateStringsArray, ...fields: unknown[]) => T}
 */
export const inLanguage = (tag) => (catalogue === null ? tag : inTemplates(catalogue, tag));
