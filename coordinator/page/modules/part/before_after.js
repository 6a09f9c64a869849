// The one picture of the first view: measurements of a channel with the model before and after what was added, at the
// wheel load that shows the difference best.

import { CONDITIONS } from "../chart/condition.js";
import { ChannelChart } from "../chart/channel_chart.js";
import { ledgerLines } from "../chart/ledger_lines.js";
import { html } from "../html.js";
import { t } from "../language/language.js";
import { path } from "../rest/routes.js";
import { useAnswers } from "../rest/use_answer.js";
import { groups } from "../words/group.js";
import { lineBefore } from "../words/headline.js";
import { modelName } from "../words/model.js";
import { channelName } from "../words/quantity.js";

/** Fewer slips make no curve: then all loads are drawn. */
const LEAST_SLIPS = 3;

/** The conditions of which one level is drawn, by key. */
const PLACES = /** @type {Record<string, ((level: string) => string) | undefined>} */ ({
  wheel_load_n: (load) => t`at a wheel load of ${load}`,
  slip_angle_deg: (angle) => t`at a slip angle of ${angle}`,
});

/** @param {{ study: Study, model: Member, channel: string }} properties */
export function BeforeAfter({ study, model, channel }) {
  const before = lineBefore(study.ledger, model.id)?.calibration ?? null;
  const ids = before === null ? [model.id] : [before, model.id];
  const answers = useAnswers(ids.map((id) => path.comparison(id)));
  const colours = new Map(ledgerLines(study).map((line) => [line.id, line.colour]));
  const layers = ids.flatMap((id) => {
    const rows = answers[path.comparison(id)]?.rows;
    const colour = ids.length === 1 ? null : (colours.get(id) ?? "var(--series-0)");
    return rows ? [{ id, colour, rows }] : [];
  });
  if (layers.length < ids.length) return html`<p class="empty" aria-busy="true">Loading the picture …</p>`;
  const ofChannel = (/** @type {MeasuredRow[]} */ rows) => rows.filter((row) => row.channel === channel);
  const now = ofChannel(layers.at(-1)?.rows ?? []);
  if (now.length === 0) return null;
  const { wheel, at, runs } = clearest(now, before === null ? now : ofChannel(layers[0].rows));
  const named = layers.flatMap(({ id, colour, rows }) => {
    const member = study.members.find((m) => m.id === id);
    return member ? [{ name: modelName(study, member), colour, rows: rows.filter((r) => runs.has(r.run)) }] : [];
  });
  const where = [at, wheel && t`wheel ${wheel}`].filter(Boolean).join(", ");
  return html`
    <${ChannelChart}
      channel=${channel}
      wheel=${wheel}
      measurements=${named.at(-1)?.rows}
      layers=${named}
      axis=${CONDITIONS[0]}
      name=${`${study.name}-before-after`}
      title=${`${t`${channelName(channel)}, measured and computed`}${where ? `, ${where}` : ""}`}
    />
  `;
}

/**
 * The wheel and the load, or the slip angle where the load has one level, at which the errors of two models differ
 * most, with their runs; without it where too few slips were run at it.
 * @param {MeasuredRow[]} now
 * @param {MeasuredRow[]} before
 */
export function clearest(now, before) {
  const old = new Map(before.map((row) => [row.run, row]));
  const square = (/** @type {MeasuredRow | undefined} */ row) =>
    row?.predicted === null || row?.predicted === undefined ? 0 : (row.measured - row.predicted) ** 2;
  const wheels = [...new Set(now.map((row) => row.wheel))];
  const places = wheels.flatMap((wheel) => {
    const ofWheel = now.filter((row) => row.wheel === wheel);
    const grouped = groups(ofWheel);
    const name = PLACES[grouped.colourKey];
    const levels = name ? grouped.colours : [null];
    return levels.map((level, k) => {
      const rows =
        level === null ? ofWheel : grouped.groups.filter((group) => group.colour === k).flatMap((group) => group.rows);
      const gain =
        rows.reduce((sum, row) => sum + Math.abs(square(old.get(row.run)) - (now === before ? 0 : square(row))), 0) /
        rows.length;
      return {
        wheel: wheels.length > 1 ? wheel : null,
        at: name && level !== null && levels.length > 1 ? name(level) : null,
        rows,
        gain,
      };
    });
  });
  const clear = places.filter(({ rows }) => new Set(rows.map((row) => row.slip)).size >= LEAST_SLIPS);
  const best = clear.toSorted((a, b) => b.gain - a.gain)[0];
  const { wheel, at, rows } = best ?? { wheel: null, at: null, rows: now };
  return { wheel, at, runs: new Set(rows.map((row) => row.run)) };
}
