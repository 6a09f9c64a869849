// A law outside the library: its curve, its effect file, and the forms that were fitted.

import { html } from "../html.js";
import { t } from "../language/language.js";
import { minus, probability, words } from "../words/quantity.js";
import { Figure, fileName } from "./figure.js";
import { Plot, STYLE } from "./library.js";

const UNITS = /** @type {Record<string, string>} */ ({
  z: "m",
  v_n: "m/s",
  v_t: "m/s",
  j: "m",
  position: "1",
  slip: "1",
  sled_speed: "m/s",
  wheel_load: "N",
  sinkage: "m",
});

/** @param {{ law: Outside, name: string, add: (() => void) | null }} properties */
export function LawChart({ law, name, add }) {
  const isFactor = ["pressure", "shear"].includes(law.acts_on);
  const unit = UNITS[law.depends_on] ?? "1";
  const label = isFactor ? t`factor on ${words(law.acts_on)}` : t`addition to ${words(law.acts_on)} (SI)`;
  const draw = (/** @type {number} */ width) =>
    Plot.plot({
      width,
      height: 260,
      marginTop: 26,
      marginLeft: 60,
      marginBottom: 40,
      inset: 6,
      grid: true,
      style: STYLE,
      x: {
        label: unit === "1" ? words(law.depends_on) : `${words(law.depends_on)} [${unit}]`,
        labelArrow: "none",
        labelAnchor: "center",
      },
      y: { label, labelArrow: "none", nice: true },
      marks: [
        Plot.ruleY([isFactor ? 1 : 0], { stroke: "var(--soft)" }),
        Plot.lineY(law.curve, { x: "0", y: "1", stroke: "var(--ghost)", strokeWidth: 2 }),
      ],
    });
  return html`
    <h2>A law that is not in the library</h2>
    <p>
      ${words(law.acts_on)} depends on ${words(law.depends_on)} (${law.form}), ${law.log_bayes_factor.toFixed(1)} nats
      over the model as it is.
    </p>
    <div class="figures">
      <${Figure}
        title=${t`${words(law.acts_on)} by ${words(law.depends_on)}`}
        name=${fileName(name, "law")}
        deps=${[law]}
        draw=${draw}
        rows=${() =>
          law.curve.map(([x, y]) => ({
            [law.depends_on]: x,
            [isFactor ? "factor" : "addition"]: y,
          }))}
      />
      <div>
        <pre tabindex="0" aria-label="effect file">${law.effect_file}</pre>
        ${add && html`<button class="main" type="button" onClick=${add}>Add this law</button>`}
      </div>
    </div>
    <${Places} places=${law.places ?? []} />
    <${Forms} forms=${law.forms ?? []} />
  `;
}

/** The places where the law may act, if there are several; a record of an earlier version has none. */
function Places(/** @type {{ places: Schemas["LawPlace"][] }} */ { places }) {
  if (places.length < 2) return null;
  return html`
    <h3>Where this law may act</h3>
    <div class="scroll" tabindex="0" role="region" aria-label="Where this law may act">
      <table>
        <thead>
          <tr>
            <th scope="col">changed quantity</th>
            <th scope="col">depends on</th>
            <th scope="col" class="number">probability</th>
          </tr>
        </thead>
        <tbody>
          ${places.map(
            (place) => html`
              <tr key=${`${place.acts_on} ${place.depends_on}`}>
                <th scope="row">${words(place.acts_on)}</th>
                <td>${words(place.depends_on)}</td>
                <td class="number">${probability(place.probability)}</td>
              </tr>
            `,
          )}
        </tbody>
      </table>
    </div>
    <p class="note">
      Probabilities are among all laws outside of the library. Those listed have at least 95 % together.
    </p>
  `;
}

/** The fitted forms of a law; a record of an earlier version has none. */
function Forms(/** @type {{ forms: Schemas["FittedForm"][] }} */ { forms }) {
  if (forms.length < 2) return null;
  return html`
    <h3>Forms of this law</h3>
    <div class="scroll" tabindex="0" role="region" aria-label="Forms of this law">
      <table>
        <thead>
          <tr>
            <th scope="col">form</th>
            <th scope="col" class="number">nats</th>
            <th scope="col" class="number">probability</th>
            <th scope="col" class="number">class</th>
            <th scope="col">formula</th>
          </tr>
        </thead>
        <tbody>
          ${forms.map(
            (form) => html`
              <tr key=${form.form}>
                <th scope="row">${form.form.replaceAll("_", " ")}</th>
                <td class="number">${minus(form.log_bayes_factor.toFixed(1))}</td>
                <td class="number">${probability(form.probability)}</td>
                <td class="number">${form.class}</td>
                <td><code>${form.formula}</code></td>
              </tr>
            `,
          )}
        </tbody>
      </table>
    </div>
    <p class="note">
      These data cannot tell forms of one class apart. Probabilities are among the forms, each of which has the same
      prior.
    </p>
  `;
}
