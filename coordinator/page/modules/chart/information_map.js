// What a further run would tell about the open explanations, over slip and load, for each speed of the rim.

import { html } from "../html.js";
import { t } from "../language/language.js";
import { slipUnit } from "../units.js";
import { conditionWords, speedWords } from "../words/condition.js";
import { digits, minus, shown, titled } from "../words/quantity.js";
import { rimSpeed } from "../words/group.js";
import { levelOf, levels, levelWords } from "../words/level.js";
import { Figure, fileName } from "./figure.js";
import { Plot, STYLE } from "./library.js";
import { separatedWords } from "../words/few.js";

/** @typedef {import("../words/condition.js").Condition} Condition */
/** @typedef {Schemas["RunInformation"]} RunInformation */

/** What is drawn: an estimate below 0 is 0 within its error. */
export const shownNats = (/** @type {number} */ nats) => Math.max(0, nats);

/** What is said of an estimate. */
export const natsWords = (/** @type {number} */ nats) =>
  nats < 0 ? t`0 nats within the error of the estimate, ${digits(nats, 2)}` : `${digits(nats, 2)} nats`;

/** @param {{ record: Discovery, name: string }} properties */
export function InformationMap({ record, name }) {
  const runs = record.information ?? [];
  if (runs.length === 0) return html`<${ProposedRuns} record=${record} />`;
  const speeds = levels(runs.map(rimSpeed));
  const max = Math.max(...runs.map((r) => r.nats), 1e-6);
  const hasNegative = runs.some((r) => r.nats < 0);
  const draw = (/** @type {number} */ k) => (/** @type {number} */ width) => {
    const ofSpeed = runs.filter((r) => levelOf(speeds, rimSpeed(r)) === k);
    const isOfSpeed = (/** @type {Condition} */ run) => ofSpeed.some((other) => isSame(other, run));
    const next = record.next_runs.map((r, n) => ({ ...r, n: n + 1 })).filter(isOfSpeed);
    const slipWord = (/** @type {number} */ slip) => minus(Number((slip * slipUnit.scale).toPrecision(3)));
    const loadWord = (/** @type {number} */ load) => digits(load * shown("N").scale);
    const told = (/** @type {RunInformation} */ r) => [natsWords(r.nats), conditionWords(r)].join("; ");
    return Plot.plot({
      width,
      height: 210,
      marginTop: 26,
      marginLeft: 60,
      marginBottom: 40,
      style: STYLE,
      x: {
        label: titled(t`slip`, slipUnit.unit),
        labelArrow: "none",
        labelAnchor: "center",
        type: "band",
        tickFormat: slipWord,
      },
      y: {
        label: titled(t`wheel load`, shown("N").unit),
        tickFormat: loadWord,
        labelArrow: "none",
        type: "band",
        reverse: true,
      },
      color: {
        type: "linear",
        domain: [0, max],
        clamp: true,
        interpolate: (/** @type {number} */ share) =>
          `color-mix(in srgb, var(--accent) ${(100 * share).toFixed(1)}%, var(--panel))`,
      },
      marks: [
        Plot.cell(ofSpeed, {
          x: "slip",
          y: "wheel_load_n",
          fill: (/** @type {RunInformation} */ r) => shownNats(r.nats),
          inset: 0.5,
          title: told,
        }),
        Plot.dot(next, { x: "slip", y: "wheel_load_n", r: 10, fill: "var(--paper)", stroke: "currentColor" }),
        Plot.text(next, { x: "slip", y: "wheel_load_n", text: "n", fontWeight: "bold", fill: "currentColor" }),
      ],
    });
  };
  return html`
    <p class="note">
      The stronger the colour of a run, the more it tells about which explanation holds (a sure answer to a yes or no is
      worth ${digits(Math.log(2), 2)} nats). Numbers: the runs to make, each chosen given those before
      it.${hasNegative ? t` An estimate below 0 is 0 within its error, and is drawn as 0.` : ""}
    </p>
    <p class="legend">
      <span>
        0
        nats <i class="ramp" role="img" aria-label="colours from no information to the most"></i> ${digits(max, 2)} nats
      </span>
    </p>
    <div class="figures small">
      ${speeds.map(
        (speed, k) => html`
          <${Figure}
            key=${k}
            title=${t`Information of a run at a rim speed of
              ${levelWords(speed, shown("m/s").unit, shown("m/s").scale)}`}
            name=${fileName(name, "next-runs", k + 1)}
            deps=${[record]}
            draw=${draw(k)}
            rows=${() => runs.filter((r) => levelOf(speeds, rimSpeed(r)) === k)}
          />
        `,
      )}
    </div>
    <${ProposedRuns} record=${record} />
  `;
}

const isSame = (/** @type {Condition} */ a, /** @type {Condition} */ b) =>
  a.slip === b.slip && a.wheel_load_n === b.wheel_load_n && a.sled_speed_m_s === b.sled_speed_m_s;

function ProposedRuns(/** @type {{ record: Discovery }} */ { record }) {
  if (record.next_runs.length === 0) return null;
  return html`
    <ol>
      ${record.next_runs.map(
        (r, k) => html`
          <li>
            ${conditionWords(r)} (${t`rim ${speedWords(rimSpeed(r))}`}):${" "}
            ${
              k === 0 ? t`tells ${digits(r.information_nats, 2)} nats` : t`adds ${digits(r.information_nats, 2)} nats`
            };${" "}
            ${t`it separates ${separatedWords(r.separates)}`}
          </li>
        `,
      )}
    </ol>
  `;
}
