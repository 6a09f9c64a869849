// Two studies beside each other: a study and what it says without some runs, two days, two soils.

import { varying } from "../chart/condition.js";
import { html, useState } from "../html.js";
import { t } from "../language/language.js";
import { AxisPicker, ChannelCharts } from "../part/channel_charts.js";
import { Pending } from "../part/message.js";
import { Table } from "../part/table.js";
import { path } from "../rest/routes.js";
import { useAnswer, useAnswers } from "../rest/use_answer.js";
import { address } from "../route.js";
import { isOneCampaign, rowsBeside } from "../words/beside.js";

const LOOK_MS = 1000;
const isOver = (/** @type {Study} */ study) => ["finished", "failed", "cancelled"].includes(study.state);

/** @param {{ ids: number[] }} properties ids: of two studies */
export function Beside({ ids }) {
  const [key, setKey] = useState("slip");
  const answers = [useSide(ids[0]), useSide(ids[1])];
  const current = answers.map(({ answer }) => answer?.current ?? null);
  const known = current.filter((id) => id !== null);
  const compared = useAnswers(known.map(path.comparison));
  const diagnosed = useAnswers(known.map(path.diagnostics));
  const missing = answers.findIndex(({ answer }) => !answer);
  if (missing >= 0)
    return html`<${Pending} answer=${null} error=${answers[missing].error} what=${t`study ${ids[missing]}`} />`;
  const sides = answers.flatMap(({ answer: study }, k) => {
    if (!study) return [];
    const line = study.ledger.find(({ calibration }) => calibration === current[k]);
    return [{ study, line, diagnostics: diagnosed[path.diagnostics(current[k] ?? 0)] ?? null }];
  });
  const names = sides.map(({ study }) =>
    sides[0].study.name === sides[1].study.name ? t`${study.name} (study ${study.id})` : study.name,
  );
  const comparisons = current.map((id) => (id === null ? null : (compared[path.comparison(id)]?.rows ?? null)));
  const [a, b] = comparisons;
  // Runs of two campaigns are no points of one picture.
  const isOne = a && b && isOneCampaign(a, b);
  const all = [a, b].flatMap((rows, k) =>
    rows ? [{ name: names[k], colour: isOne ? `var(--series-${k})` : null, rows }] : [],
  );
  const pictures = isOne ? [all] : all.map((layer) => [layer]);
  const axes = all.length > 0 ? varying(all.flatMap((layer) => layer.rows)) : [];
  const axis = axes.find((condition) => condition.key === key) ?? axes[0];
  const link = (/** @type {number} */ k) =>
    html`<a href=${address(["studies", ids[k], isOver(sides[k].study) ? "story" : "live"])}>${names[k]}</a>`;
  return html`
    <h1>${names.join(t` beside `)}</h1>
    ${
      sides.some(({ study }) => !isOver(study)) &&
      html`
        <p role="status">
          The program is at work
          on ${sides
            .filter(({ study }) => !isOver(study))
            .map(({ study }) => study.name)
            .join(" and ")};
          the numbers appear here as they come.
        </p>
      `
    }
    <${Table}
      label="Two studies"
      head=${["", link(0), link(1), t`difference`]}
      rows=${rowsBeside(sides)}
      labels=${["", ...names, t`difference`]}
    />
    <p class="note">
      Of the current models. Errors are root mean squares. Parameters: mean ± sd of the posterior; the difference is
      over the larger of the two sds.
    </p>
    ${
      axis &&
      html`
        <h2>The models over the data</h2>
        <${AxisPicker} axes=${axes} axis=${axis} choose=${setKey} />
        ${pictures.map(
          (layers) => html`
            ${layers.length === 1 && html`<h3>${layers[0].name}</h3>`}
            <${ChannelCharts}
              key=${layers[0].name}
              small=${layers.length === 1}
              layers=${layers}
              axis=${axis}
              name=${layers.map((layer) => layer.name).join(t` beside `)}
            />
          `,
        )}
      `
    }
  `;
}

/** A study, looked at while it is at work. */
const useSide = (/** @type {number} */ id) =>
  useAnswer(path.study(id), { everyMs: (study) => (isOver(study) ? 10 * LOOK_MS : LOOK_MS) });
