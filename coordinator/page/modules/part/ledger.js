// The error ledger as a table.

import { html } from "../html.js";
import { CHANNELS, digits, minus, short, shown, unitOf } from "../words/quantity.js";
import { Table } from "./table.js";

/** @param {{ study: any, lines: any[] }} properties */
export function Ledger({ lines }) {
  const channels = CHANNELS.filter((channel) => lines.some(({ line }) => line.error.fit[channel]));
  const head = ["model", "runs", ...channels.map((c) => `${short(c)} ${shown(unitOf(c)).unit}`), "noise sds", "in 90 % interval", "ln evidence"];
  const rows = lines.flatMap(({ name, line }) => ["fit", "holdout"].filter((use) => line.error[use]).map((use) => {
    const error = line.error[use];
    const inside = line.coverage90?.[use];
    return [
      use === "fit" ? name : "", use === "fit" ? "fitted" : "held out",
      ...channels.map((c) => (error[c] ? digits(error[c].rmse * shown(unitOf(c)).scale) : "–")),
      digits(error.all.rmse_fixed_sigma ?? error.all.rmse_sigma),
      inside === null || inside === undefined ? "–" : `${Math.round(100 * inside)} %`,
      use === "fit" && line.log_evidence !== null ? minus(line.log_evidence.toFixed(1)) : "",
    ];
  }));
  return html`<${Table} label="Error ledger" head=${head} rows=${rows} numbers=${head.map((_, k) => k).filter((k) => k > 1)} />`;
}
