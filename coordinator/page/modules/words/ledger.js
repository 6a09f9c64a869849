// The lines of the error ledger: which of them compare, and what each has beyond the one before it.

import { t } from "../language/language.js";

/**
 * @typedef {{ data_set: number, fitted_runs: number, held_out_runs: number }} Runs
 * @typedef {{ id: number, name: string, effects: string[], line: LedgerEntry }} LedgerLine
 */

/**
 * The lines that were calibrated on the same runs, in their order: errors and evidence over different runs do not
 * compare.
 * @template {LedgerLine} L
 * @param {L[]} lines
 * @returns {L[][]}
 */
export function dataSets(lines) {
  /** @type {Map<number, L[]>} */
  const sets = new Map();
  for (const entry of lines) sets.set(entry.line.data_set, [...(sets.get(entry.line.data_set) ?? []), entry]);
  return [...sets.values()];
}

/** Of each line, the number of changes of the runs before it: neighbours with the same number compare. */
export function changesOfRuns(/** @type {LedgerLine[]} */ lines) {
  let changes = 0;
  return lines.map(({ line }, k) => (k > 0 && line.data_set !== lines[k - 1].line.data_set ? (changes += 1) : changes));
}

/** `28 fitted runs, 12 held out`. */
export function runWords(/** @type {Runs} */ { fitted_runs, held_out_runs }) {
  const fitted = fitted_runs === 1 ? t`1 fitted run` : t`${fitted_runs} fitted runs`;
  return held_out_runs === 0 ? fitted : t`${fitted}, ${held_out_runs} held out`;
}

/**
 * What a line has that the line before it has not: `+ slip_sinkage`, `+ 1 run`; its model where that dropped something,
 * its name where it differs in nothing.
 * @param {LedgerLine | undefined} before
 * @param {LedgerLine} now
 * @returns {string[]} the parts
 */
export function step(before, now) {
  if (!before) return [now.name];
  const added = now.effects.filter((effect) => !before.effects.includes(effect)).map((effect) => `+ ${effect}`);
  const isShorter = before.effects.some((effect) => !now.effects.includes(effect));
  const whole = now.effects.length === 0 ? t`base` : t`with ${now.effects.join(", ")}`;
  const parts = [...(isShorter ? [whole] : added), ...runStep(before.line, now.line)];
  return parts.length === 0 ? [now.name] : parts;
}

/** How the runs changed. */
function runStep(/** @type {Runs} */ before, /** @type {Runs} */ now) {
  if (before.data_set === now.data_set) return [];
  const more = now.fitted_runs + now.held_out_runs - before.fitted_runs - before.held_out_runs;
  if (more === 0) return [t`other runs`];
  const count = Math.abs(more);
  return [`${more > 0 ? "+" : "−"} ${count === 1 ? t`1 run` : t`${count} runs`}`];
}
