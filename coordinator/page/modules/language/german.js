// The German catalogue.

import { CALCULATOR } from "./german_calculator.js";
import { CAMPAIGN } from "./german_campaign.js";
import { EFFECTS } from "./german_effects.js";
import { LIBRARY } from "./german_library.js";
import { PARAMETERS } from "./german_parameters.js";
import { SENTENCES } from "./german_sentences.js";
import { WORDS } from "./german_words.js";

/** @type {Record<string, string>} texts by their English form; `{0}` stands for the first part that varies */
export const GERMAN = { ...WORDS, ...SENTENCES, ...CALCULATOR, ...CAMPAIGN, ...LIBRARY, ...EFFECTS, ...PARAMETERS };

export { PARAMETERS };
