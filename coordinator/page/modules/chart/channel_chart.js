// A channel of one wheel against a condition: measurements at their true places, models as lines with their 90 % bands.

import { html, useMemo } from "../html.js";
import { t } from "../language/language.js";
import { conditionWords, runName } from "../words/condition.js";
import { groups } from "../words/group.js";
import { channelName, digits, shown, titled } from "../words/quantity.js";
import { colour, symbol } from "./colour.js";
import { spanWords } from "./condition.js";
import { Entry, Figure, fileName } from "./figure.js";
import { glyph } from "./glyph.js";
import { Plot, STYLE } from "./library.js";
import { MANY } from "./merged.js";
import { LEAST_LINE, meanOf, places } from "./place.js";
import { byRun, pointable } from "./runs.js";

/** Between computed conditions a line bends without a kink, and without going beyond its ends. */
const CURVE = "monotone-x";
/** The height of a low picture [px]. */
const LOW = 150;
/** The largest number of lines of several models that have bands; more bands would hide each other. */
const MOST_BANDS = 8;
/** More bands of a model are fainter: over each other they would be one grey. */
const MOST_DENSE = 4;
/** More levels are not named in the legend. */
const MOST_NAMES = 10;

/**
 * @typedef {{ name: string, colour: string | null, rows: MeasuredRow[], isGhost?: boolean }} Layer
 *   colour: of all its lines; null: each group of runs has its own.
 * @typedef {import("./surface_curves.js").SurfaceCurves} Moving
 * @typedef {ReturnType<typeof shown>} Quantity
 * @typedef {import("../words/group.js").Group<MeasuredRow>} RunGroup
 * @typedef {Pick<MeasuredRow, "slip" | "wheel_load_n" | "sled_speed_m_s" | "measured" | "predicted" | "q05" | "q95">}
 *   MeasuredNumbers
 * @typedef {(key: keyof MeasuredNumbers) => (row: MeasuredRow) => number} ValueOf
 * @param {{ channel: string, wheel: string | null, measurements: MeasuredRow[], layers: Layer[], axis:
 *   ConditionAxis, name: string, moving?: Moving, title?: string, isLow?: boolean }}
 *   properties layers: models, each with the rows of its comparison. measurements: each of them once. isLow: whether
 *   the picture has the smallest readable height.
 */
export function ChannelChart({
  channel,
  wheel,
  measurements,
  layers,
  axis,
  name,
  moving,
  title: stated,
  isLow = false,
}) {
  const ofPicture = (/** @type {MeasuredRow[]} */ rows) =>
    rows.filter((r) => r.channel === channel && (wheel === null || r.wheel === wheel));
  const measured = ofPicture(measurements);
  const quantity = shown(measured[0].unit);
  const found = useMemo(() => groups(measured, axis.key), [measurements, channel, wheel, axis.key]);
  const what = [channelName(channel), wheel === null ? "" : t`wheel ${wheel}`].filter(Boolean).join(", ");
  const title = stated ?? (isLow ? what : t`${what}, measured and computed, by ${axis.title}`);
  const draw = (/** @type {number} */ width) =>
    picture({
      width,
      layers: layers.map((l) => ({ ...l, rows: ofPicture(l.rows) })),
      measured,
      found,
      axis,
      quantity,
      channel,
      moving,
      isLow,
    });
  const drawn = (/** @type {Picture} */ plot) => {
    const release = pointable(plot, { runsIn, words: (from, to) => spanWords(axis, from, to) });
    const curves = found.groups.map((group) => ({ rows: group.rows, stroke: colour(group.colour) }));
    const detach = moving?.attach(plot, curves, (r) => r[axis.key] * axis.scale, quantity.scale);
    return () => {
      release();
      detach?.();
    };
  };
  const runsIn = (/** @type {number} */ from, /** @type {number} */ to) =>
    measured.filter((r) => r[axis.key] * axis.scale >= from && r[axis.key] * axis.scale <= to).map((r) => r.run);
  const used = [...new Set(found.groups.map((g) => g.symbol))].sort((a, b) => a - b);
  // Where the colours are the models', the signs of the measurements tell what colours tell otherwise.
  const isLayered = layers.some((l) => l.colour !== null && !l.isGhost);
  const colours = found.colours.slice(0, MOST_NAMES).map(
    (name, k) =>
      html`
          <${Entry}
            glyph=${
              isLayered
                ? html`<g fill="currentColor">${glyph(k)}</g>`
                : html`<rect x="1" y="5" width="14" height="6" fill=${colour(k)} />`
            }
          >
            ${name}
          <//>
        `,
  );
  const symbols =
    found.symbols.length < 2 || isLayered
      ? []
      : used
          .slice(0, MOST_NAMES)
          .map((k) => html`<${Entry} glyph=${html`<g fill="currentColor">${glyph(k)}</g>`}>${found.symbols[k]}<//>`);
  const hasHoldout = measured.some((r) => r.use === "holdout");
  const isSingle = found.groups.some((group) => places(group.rows, (r) => r[axis.key]).length < LEAST_LINE);
  return html`
    <${Figure}
      title=${title}
      name=${fileName(name, channel, wheel ?? "")}
      deps=${[layers.map((l) => `${l.name} ${l.rows.length}`).join(), layers.at(-1)?.rows, measurements, axis.key]}
      draw=${draw}
      rows=${() => table(layers, ofPicture)}
      onDrawn=${drawn}
      legend=${html`
        ${found.single && html`<span>${found.single}</span>`}
        ${colours}
        ${symbols}
        ${
          hasHoldout &&
          html`
            <${Entry} glyph=${html`<circle cx="8" cy="8" r="4" fill="none" stroke="currentColor" stroke-width="2" />`}>
              held out
            <//>
          `
        }
        ${
          isSingle &&
          html`
            <${Entry} glyph=${html`<path d="M4 4l8 8M12 4L4 12" stroke="currentColor" stroke-width="1.6" />`}>
              computed at a single condition
            <//>
          `
        }
        ${layers
          .filter((l) => l.colour !== null)
          .map(
            (l) =>
              html`
                <${Entry}
                  glyph=${html`
                    <path d="M0 8h16" stroke=${l.colour} stroke-width="2" stroke-dasharray=${l.isGhost ? "3 3" : ""} />
                  `}
                >
                  ${l.name}
                <//>
              `,
          )}
      `}
    />
  `;
}

/** Measured and computed values as rows of a file. */
function table(/** @type {Layer[]} */ layers, /** @type {(rows: MeasuredRow[]) => MeasuredRow[]} */ ofPicture) {
  return layers.flatMap((layer) =>
    ofPicture(layer.rows).map((r) => ({
      model: layer.name,
      run: r.run,
      use: r.use,
      wheel: r.wheel,
      slip: r.slip,
      wheel_load_n: r.wheel_load_n,
      sled_speed_m_s: r.sled_speed_m_s,
      slip_angle_deg: r.slip_angle_deg,
      channel: r.channel,
      unit: r.unit,
      measured: r.measured,
      predicted: r.predicted,
      q05: r.q05,
      q95: r.q95,
    })),
  );
}

/**
 * @param {{ width: number, layers: Layer[], measured: MeasuredRow[], found: ReturnType<typeof groups<MeasuredRow>>,
 *   axis: ConditionAxis, quantity: Quantity, channel: string, moving?: Moving, isLow: boolean }} properties
 */
function picture({ width, layers, measured, found, axis, quantity, channel, moving, isLow }) {
  const x = (/** @type {MeasuredRow} */ r) => r[axis.key] * axis.scale;
  /** @type {ValueOf} */
  const value = (key) => (r) => (r[key] ?? NaN) * quantity.scale;
  const place = new Map(found.groups.flatMap((group) => group.rows.map((r) => [r.run, group])));
  const isMany = measured.length > MANY;
  const hasBands = layers.length === 1 || layers.length * found.groups.length <= MOST_BANDS;
  const marks = layers.flatMap((layer) =>
    layerMarks({ ...layer, hasBands: hasBands && !layer.isGhost }, place, x, value, isMany),
  );
  const isLayered = layers.some((l) => l.colour !== null && !l.isGhost);
  const dots = (/** @type {MeasuredRow[]} */ rows, /** @type {(colour: string) => object} */ look) =>
    found.groups.map((group) => {
      const members = rows.filter((r) => place.get(r.run) === group);
      const sign = isLayered
        ? { symbol: symbol(group.colour), ...look("var(--measured)") }
        : { symbol: symbol(group.symbol), ...look(colour(group.colour)) };
      return Plot.dot(members, byRun(members, { x, y: value("measured"), r: 4.2, ...sign }, isMany));
    });
  // No edges where many signs are one path: they would cover neighbouring signs.
  const edge = isMany ? {} : { stroke: "var(--paper)", strokeWidth: 0.7 };
  const predictions = layers.map((layer) => ({
    name: layer.name,
    ofRun: new Map(layer.rows.map((r) => [r.run, r.predicted])),
  }));
  const tip = (/** @type {MeasuredRow} */ r) =>
    [
      runName(r),
      conditionWords(r),
      `${t`measured`} ${digits(r.measured * quantity.scale)} ${quantity.unit}`,
      ...predictions.map(({ name, ofRun }) => {
        const predicted = ofRun.get(r.run);
        return predicted === undefined || predicted === null
          ? ""
          : `${name} ${digits(predicted * quantity.scale)} ${quantity.unit}`;
      }),
    ]
      .filter(Boolean)
      .join("\n");
  return Plot.plot({
    width,
    height: isLow ? LOW : Math.max(240, Math.min(360, 0.62 * width)),
    marginTop: 26,
    marginLeft: 56,
    marginBottom: 40,
    inset: 7,
    grid: true,
    style: STYLE,
    x: { label: titled(axis.title, axis.unit), labelArrow: "none", labelAnchor: "center", nice: true },
    y: {
      label: titled(channelName(channel), quantity.unit),
      labelArrow: "none",
      nice: true,
      ...(moving ? { domain: reach(layers, measured, quantity, moving) } : {}),
    },
    marks: [
      ...marks,
      ...dots(
        measured.filter((r) => r.use !== "holdout"),
        (c) => ({ fill: c, ...edge }),
      ),
      ...dots(
        measured.filter((r) => r.use === "holdout"),
        (c) => ({ fill: "var(--paper)", stroke: c, strokeWidth: 1.8 }),
      ),
      // The words are made of the run that is pointed at alone.
      Plot.tip(
        measured,
        Plot.pointer({
          x,
          y: value("measured"),
          title: (/** @type {MeasuredRow} */ r) => r,
          format: { title: tip },
          maxRadius: 14,
          fill: "var(--panel)",
          stroke: "var(--rule)",
        }),
      ),
    ],
  });
}

/** The least and the greatest value of a picture whose curves move. */
function reach(
  /** @type {Layer[]} */ layers,
  /** @type {MeasuredRow[]} */ measured,
  /** @type {Quantity} */ quantity,
  /** @type {Moving} */ moving,
) {
  const ofLayers = layers.flatMap((layer) => layer.rows.flatMap((r) => [r.predicted, r.q05, r.q95]));
  const values = [...ofLayers, ...measured.flatMap((r) => [r.measured, ...moving.rangeOf(r)])].filter(
    (value) => typeof value === "number",
  );
  return [Math.min(...values) * quantity.scale, Math.max(...values) * quantity.scale];
}

/** The lines of a model: one for each group of runs. */
function layerMarks(
  /** @type {Layer & { hasBands: boolean }} */ layer,
  /** @type {Map<string, RunGroup>} */ place,
  /** @type {(row: MeasuredRow) => number} */ x,
  /** @type {ValueOf} */ value,
  /** @type {boolean} */ isMany,
) {
  const known = layer.rows.filter((r) => r.predicted !== null && r.predicted !== undefined);
  const all = new Set(known.flatMap((r) => place.get(r.run) ?? []));
  return [...all].flatMap((group) => {
    const rows = known.filter((r) => place.get(r.run) === group);
    const stroke = layer.colour ?? colour(group.colour);
    const dash = layer.isGhost ? { strokeDasharray: "4 3", strokeWidth: 2.2 } : { strokeWidth: 1.6 };
    const band = { x, y1: value("q05"), y2: value("q95") };
    const means = atEqual(rows, x);
    if (means.length >= LEAST_LINE) {
      return [
        ...(layer.hasBands
          ? [
              Plot.areaY(means, {
                ...band,
                curve: CURVE,
                fill: stroke,
                fillOpacity: all.size > MOST_DENSE ? 0.08 : 0.16,
              }),
            ]
          : []),
        Plot.lineY(means, {
          x,
          y: value("predicted"),
          curve: CURVE,
          stroke,
          ...dash,
          className: layer.isGhost ? "ghost" : "model",
        }),
      ];
    }
    return [
      ...(layer.hasBands ? [Plot.ruleX(rows, byRun(rows, { ...band, stroke, strokeOpacity: 0.5 }, isMany))] : []),
      Plot.dot(
        rows,
        byRun(
          rows,
          {
            x,
            y: value("predicted"),
            stroke,
            symbol: "times",
            r: 4,
            ...dash,
            className: layer.isGhost ? "ghost" : "model",
          },
          isMany,
        ),
      ),
    ];
  });
}

/** Rows of one place become their mean: repeats do not make a line go up and down. */
function atEqual(/** @type {MeasuredRow[]} */ rows, /** @type {(row: MeasuredRow) => number} */ x) {
  return places(rows, x).map((all) => {
    const mean = (/** @type {keyof MeasuredNumbers} */ key) => meanOf(all, (r) => r[key] ?? NaN);
    return {
      ...all[0],
      slip: mean("slip"),
      wheel_load_n: mean("wheel_load_n"),
      sled_speed_m_s: mean("sled_speed_m_s"),
      predicted: mean("predicted"),
      q05: mean("q05"),
      q95: mean("q95"),
    };
  });
}
