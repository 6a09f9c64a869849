// Where the model fails: residuals of every run and channel, and what orders them.

import { html, useMemo, useState } from "../html.js";
import { RESIDUAL_RANGE } from "../chart/colour.js";
import { varying } from "../chart/condition.js";
import { Figure, fileName } from "../chart/figure.js";
import { Plot, STYLE } from "../chart/library.js";
import { ResidualChart } from "../chart/residual_chart.js";
import { MANY } from "../chart/merged.js";
import { byRun, pointable } from "../chart/runs.js";
import { t } from "../language/language.js";
import { Clauses } from "../part/clauses.js";
import { Pending } from "../part/message.js";
import { NoModel } from "../part/no_model.js";
import { path } from "../rest/routes.js";
import { useAnswer } from "../rest/use_answer.js";
import { conditionWords, runName } from "../words/condition.js";
import { said } from "../words/clauses.js";
import { capital, CHANNELS, minus, short } from "../words/quantity.js";
import { hasErrorsBesideNoise, hasOnlyNoise, residualSds } from "../words/residual.js";

/** @typedef {ConditionKey | "made" | "size"} Order */
/** @typedef {PlacedRow & { sds: number, all_sds: number | null }} JudgedRow */

/** Number of sds beyond which residuals have one colour. */
const MOST_SDS = 4;
/** Cells narrower than this [px] stand without a gap, which would take their colour. */
const LEAST_GAPPED = 4;
/** Number of colour steps per sd in a picture of many cells. */
const STEPS = 4;
/** Height of a cell [px]. */
const CELL = 30;
/** Names of runs stand under cells of this width [px] at least. */
const LEAST_CELL = 14;
/** Height of one character of a slanted name below the axis [px]. */
const CHARACTER = 5.2;

/** @param {{ study: Study, model: Member, query: Record<string, string> }} properties */
export function Failures({ study, model }) {
  const { answer: comparison, error } = useAnswer(model ? path.comparison(model.id) : null);
  const { answer: diagnostics } = useAnswer(model ? path.diagnostics(model.id) : null);
  const [order, setOrder] = useState(/** @type {Order} */ ("slip"));
  const [errors, setErrors] = useState(/** @type {"all" | "noise"} */ ("all"));
  const rows = useMemo(() => withPlace(comparison?.rows ?? []), [comparison]);
  const ofChannel = useMemo(
    () =>
      CHANNELS.map((channel) => ({ channel, own: rows.filter((r) => r.channel === channel) })).filter(
        ({ own }) => own.length > 0,
      ),
    [rows],
  );
  if (!model) return html`<${NoModel} study=${study} />`;
  if (!comparison) return html`<${Pending} answer=${comparison} error=${error} what="the residuals" />`;
  const axes = varying(comparison.rows);
  /** @type {{ key: Order, title: string }[]} */
  const orders = [
    ...axes.map((a) => ({ key: a.key, title: a.title })),
    { key: "made", title: t`order of the runs` },
    { key: "size", title: t`size of the residual` },
  ];
  const axis = axes.find((a) => a.key === order) ?? MADE;
  const findings = diagnostics?.findings ?? [];
  // All errors of a calibration may be its noise alone.
  const named = hasOnlyNoise(rows) ? "noise" : errors;
  return html`
    ${model.story && html`<div class="verdict"><${Clauses} text=${model.story.wrong.text} /></div>`}
    <div class="actions" role="group" aria-label="Ordered by">
      <span class="note">Ordered by</span>
      ${orders.map(
        (o) =>
          html`
            <button type="button" aria-pressed=${o.key === order} onClick=${() => setOrder(o.key)}>${o.title}</button>
          `,
      )}
    </div>
    ${
      hasErrorsBesideNoise(rows) &&
      html`
        <div class="actions" role="group" aria-label=${t`Errors that residuals count in`}>
          <span class="note">${t`Errors that residuals count in`}</span>
          ${ERRORS.map(
            ({ key, words }) => html`
              <button type="button" aria-pressed=${key === errors} onClick=${() => setErrors(key)}>${words}</button>
            `,
          )}
        </div>
      `
    }
    <${HeatMap} rows=${rows} order=${order} errors=${errors} named=${named} name=${study.name} />
    <h2>Residuals against ${axis.title}</h2>
    <p class="note">
      ${
        named === "all"
          ? t`Measured less computed; the grey band is one sd, the mean over the runs, of all errors that the
            calibration assumes or infers: noise, scatter of the soil and discrepancy, as in the diagnosis.`
          : t`Measured less computed; the grey band is one sd, the mean over the runs, of the noise alone.`
      }${" "}
      ${t`The line is the trend that the diagnosis tests, where it is beyond chance (p below 0.01 among all tests).`}
    </p>
    <div class="figures">
      ${ofChannel.map(
        ({ channel, own }) => html`
          <${ResidualChart}
            key=${channel}
            channel=${channel}
            rows=${own}
            axis=${axis}
            errors=${errors}
            trends=${diagnostics?.trends ?? []}
            name=${study.name}
          />
        `,
      )}
    </div>
    ${
      findings.length > 0 &&
      html`
        <h2>What the diagnosis says</h2>
        <ul>${findings.map((/** @type {string} */ text) => html`<li>${capital(said(text))}</li>`)}</ul>
      `
    }
  `;
}

/** @type {{ key: "all" | "noise", words: string }[]} the errors that residuals may count in */
const ERRORS = [
  { key: "all", words: t`all errors` },
  { key: "noise", words: t`the noise alone` },
];

/** The order in which the runs stand in the file. */
const MADE = { key: "place", title: t`order of the runs`, short: t`runs`, unit: "1", scale: 1 };

/** Rows with the place of their run. */
function withPlace(/** @type {MeasuredRow[]} */ rows) {
  const places = new Map([...new Set(rows.map((r) => r.run))].map((run, k) => [run, k + 1]));
  return rows.map((r) => ({ ...r, place: places.get(r.run) ?? 0 }));
}

/**
 * Runs by channels, coloured by the residual over its sd.
 * @param {{ rows: PlacedRow[], order: Order, errors: "all" | "noise", named: "all" | "noise",
 *   name: string }} properties
 */
function HeatMap({ rows, order, errors, named, name }) {
  const judged = rows.flatMap((r) => {
    const sds = residualSds(r, errors);
    return sds === null ? [] : [{ ...r, sds, all_sds: residualSds(r, "all") }];
  });
  /** @type {Map<string, number>} */
  const worst = new Map();
  for (const r of judged) worst.set(r.run, Math.max(worst.get(r.run) ?? 0, Math.abs(r.sds)));
  const value = (/** @type {PlacedRow} */ row) =>
    order === "size" ? -(worst.get(row.run) ?? 0) : row[order === "made" ? "place" : order];
  const channels = CHANNELS.filter((c) => judged.some((r) => r.channel === c));
  const firstRows = [...new Map(judged.map((r) => [r.run, r])).values()];
  firstRows.sort((a, b) => value(a) - value(b) || a.place - b.place);
  const runs = firstRows.map((row) => row.run);
  const hint = (/** @type {JudgedRow} */ r) =>
    [runName(r), short(r.channel)].join(", ") +
    `\n${conditionWords(r)}\n` +
    (r.sds > 0
      ? t`${inSds(r.all_sds)} sds of all errors, ${inSds(r.residual_sigma)} of the noise alone: measured above
        computed`
      : t`${inSds(r.all_sds)} sds of all errors, ${inSds(r.residual_sigma)} of the noise alone: measured below
        computed`);
  const isMany = judged.length > MANY;
  // A dot above the cells of a run: on a cell it would hide the colour.
  const held = firstRows.filter((r) => r.use === "holdout").map((r) => ({ ...r, channel: channels[0] }));
  const heldLook = { x: "run", y: "channel", dy: -CELL / 2 - 4, fill: "var(--ink)", className: "held" };
  // In a picture of many cells, all cells of one colour step are one element.
  const fill = isMany
    ? (/** @type {JudgedRow} */ r) => Math.round(STEPS * Math.max(-MOST_SDS, Math.min(MOST_SDS, r.sds))) / STEPS
    : "sds";
  const isNamed = (/** @type {number} */ width) => (width - 112) / runs.length >= LEAST_CELL;
  const below = (/** @type {number} */ width) =>
    isNamed(width) ? 24 + CHARACTER * Math.max(...runs.map((run) => run.length)) : 26;
  const draw = (/** @type {number} */ width) =>
    Plot.plot({
      width,
      height: 30 + below(width) + CELL * channels.length,
      marginLeft: 92,
      marginBottom: below(width),
      style: STYLE,
      x: {
        domain: runs,
        label: isNamed(width) ? null : t`runs`,
        tickRotate: -60,
        tickSize: 0,
        ...(isNamed(width) ? {} : { ticks: [] }),
      },
      y: { domain: channels, label: null, tickFormat: short, tickSize: 0 },
      color: {
        type: "linear",
        domain: [-MOST_SDS, 0, MOST_SDS],
        clamp: true,
        interpolate: mix,
      },
      marks: [
        Plot.cell(
          judged,
          byRun(judged, { x: "run", y: "channel", fill, inset: width < LEAST_GAPPED * runs.length ? 0 : 0.5 }, isMany),
        ),
        Plot.dot(held, isMany ? byRun(held, { ...heldLook, r: 1 }, true) : { ...heldLook, r: isNamed(width) ? 2 : 1 }),
        // The words are made of the run that is pointed at alone.
        Plot.tip(
          judged,
          Plot.pointer({
            x: "run",
            y: "channel",
            title: (/** @type {JudgedRow} */ r) => r,
            format: { title: hint },
            fill: "var(--panel)",
            stroke: "var(--rule)",
          }),
        ),
      ],
    });
  return html`
    <${Figure}
      title=${
        named === "all"
          ? t`Residuals of every run and channel, in sds of noise, scatter of the soil and discrepancy`
          : t`Residuals of every run and channel, in sds of the noise alone`
      }
      name=${fileName(name, "residuals")}
      deps=${[rows, order, errors]}
      draw=${draw}
      rows=${() =>
        judged.map((r) => ({
          run: r.run,
          use: r.use,
          channel: r.channel,
          slip: r.slip,
          wheel_load_n: r.wheel_load_n,
          sled_speed_m_s: r.sled_speed_m_s,
          residual_sds: r.all_sds,
          residual_noise_sds: r.residual_sigma,
        }))}
      onDrawn=${(/** @type {Picture} */ plot) => pointable(plot)}
      legend=${html`
        <span><i class="swatch below"></i>computed too high by ${MOST_SDS} sds or more</span>
        <span><i class="swatch level"></i>as measured</span>
        <span><i class="swatch above"></i>computed too low</span>
        ${held.length > 0 && html`<span>dot above: held out</span>`}
      `}
    />
  `;
}

/** A residual over an sd; a dash where it is not known. */
const inSds = (/** @type {number | null | undefined} */ value) =>
  typeof value === "number" ? minus(value.toFixed(1)) : "–";

/** The colour of a share of the scale: mixed from neighbouring colours of the style sheet. */
function mix(/** @type {number} */ share) {
  const [below, level, above] = RESIDUAL_RANGE;
  const [from, to, part] = share < 0.5 ? [below, level, 2 * share] : [level, above, 2 * share - 1];
  return `color-mix(in srgb, ${to} ${(100 * part).toFixed(1)}%, ${from})`;
}
