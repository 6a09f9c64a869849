// Two studies beside each other: what they have in common, and what differs.

import { t, translated } from "../language/language.js";
import { runWords } from "./ledger.js";
import { meanAndSpread, shownParameter } from "./parameter.js";
import { capital, channelName, CHANNELS, digits, errorWords, minus, shown, unitOf, words } from "./quantity.js";

/**
 * @typedef {{ study: Study, line?: LedgerEntry, diagnostics: Diagnostics | null }} Side line: of the error ledger of
 *   its current model. diagnostics: of that model
 */

const USES = /** @type {const} */ (["holdout", "fit"]);
const USE_WORDS = { fit: t`fitted runs`, holdout: t`held-out runs` };

/**
 * The rows of the table: what, of the first study, of the second, the difference.
 * @param {Side[]} sides two of them
 * @returns {string[][]}
 */
export function rowsBeside(sides) {
  const of = (/** @type {(side: Side) => string} */ what) => sides.map(what);
  return [
    [t`State`, ...of(({ study }) => translated(study.state)), ""],
    [t`Runs`, ...of(({ line }) => (line ? runWords(line) : "–")), ""],
    [
      t`Model`,
      ...of(({ study, line }) =>
        [
          words(study.model_kind ?? t`unknown`),
          ...(line && line.effects.length > 0 ? [t`with ${line.effects.map(words).join(", ")}`] : []),
        ].join(" "),
      ),
      "",
    ],
    [t`Found`, ...of(({ study }) => capital(study.verdict?.short ?? t`no search yet`)), ""],
    ...errors(sides),
    ...parameters(sides),
  ];
}

/** The errors of the current models, each over its own runs. */
function errors(/** @type {Side[]} */ sides) {
  return USES.flatMap((use) =>
    CHANNELS.flatMap((channel) => {
      const { unit, scale } = shown(unitOf(channel));
      const values = sides.map(({ line }) => line?.error[use]?.[channel]);
      if (values.every((value) => !value)) return [];
      const cells = values.map((value) => (value ? `${errorWords(value.rmse * scale)} ${unit}` : "–"));
      const [a, b] = values;
      const isSame = a && b && a.runs === b.runs;
      return [
        [
          t`Error of ${channelName(channel)}, ${USE_WORDS[use]}`,
          ...cells,
          isSame ? ratioWords(a.rmse, b.rmse) : t`over other runs`,
        ],
      ];
    }),
  );
}

/** The second error over the first: `−50 %`, beyond twice and half as a factor, `× 15.5`. */
function ratioWords(/** @type {number} */ before, /** @type {number} */ now) {
  const ratio = now / before;
  if (ratio > 2 || ratio < 0.5) return `× ${digits(ratio, 2)}`;
  return `${ratio < 1 ? "" : "+"}${minus((100 * (ratio - 1)).toFixed(0))} %`;
}

/** The parameters by posterior mean and sd. */
function parameters(/** @type {Side[]} */ sides) {
  const units = new Map(
    sides.flatMap(({ diagnostics }) => (diagnostics?.parameters ?? []).map((q) => [q.name, q.unit])),
  );
  const names = [...new Set(sides.flatMap(({ line }) => Object.keys(line?.parameters ?? {})))];
  return names.map((name) => {
    const unit = units.get(name);
    const called = shownParameter({ name, unit });
    const word = unit === undefined ? "SI" : called.unit;
    const values = sides.map(({ line }) => line?.parameters[name]);
    const cells = values.map((value) => {
      return value ? `${meanAndSpread(called, value.mean, value.sd)}${word === "" ? "" : ` ${word}`}` : "–";
    });
    const [a, b] = values;
    const sd = a && b ? Math.max(a.sd, b.sd) : 0;
    return [called.name, ...cells, a && b && sd > 0 ? `${minus(digits((b.mean - a.mean) / sd, 2))} sds` : ""];
  });
}

/** Whether the rows of two comparisons are of one campaign: runs of one name have one measurement. */
export function isOneCampaign(/** @type {MeasuredRow[]} */ a, /** @type {MeasuredRow[]} */ b) {
  const measured = new Map(a.map((row) => [`${row.run} ${row.channel}`, row.measured]));
  const shared = b.filter((row) => measured.has(`${row.run} ${row.channel}`));
  return shared.length > 0 && shared.every((row) => measured.get(`${row.run} ${row.channel}`) === row.measured);
}
