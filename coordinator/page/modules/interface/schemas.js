// The schemas: what each key of a message means.

import { html } from "../html.js";
import { Table } from "../part/table.js";
import { Kind, Words } from "./text.js";

/** The keys of an object, with what they hold. */
const keys = (/** @type {JsonSchema} */ schema) =>
  Object.entries(schema.properties ?? {}).map(([name, held]) => [
    html`
      <code>${name}</code>
      ${
        schema.required?.includes(name)
          ? ""
          : html`
              ${" "}
              <span class="note">optional</span>
            `
      }
    `,
    html`<${Kind} of=${held} />`,
    html`<${Words}>${held.description ?? ""}<//>`,
  ]);

/** @param {{ name: string, schema: JsonSchema }} properties */
const Keys = ({ name, schema }) =>
  html`<${Table} label=${`keys of ${name}`} head=${["key", "holds", "meaning"]} rows=${keys(schema)} />`;

/** The forms that a message may have. @param {{ name: string, schema: JsonSchema }} properties */
const Forms = ({ name, schema }) =>
  (schema.oneOf ?? [schema]).map(
    (form, k) => html`
      ${form !== schema && form.description && html`<p><${Words}>${form.description}<//></p>`}
      ${
        form.properties
          ? html`<${Keys} name=${k ? `${name}, form ${k + 1}` : name} schema=${form} />`
          : html`<p><${Kind} of=${form} /></p>`
      }
    `,
  );

/** @param {{ schemas: Record<string, JsonSchema>, open: string | null }} properties */
export const Schemas = ({ schemas, open }) =>
  Object.entries(schemas).map(
    ([name, schema]) => html`
      <details class="schema" id=${`schemas/${name}`} key=${name} open=${open === name}>
        <summary><code>${name}</code></summary>
        <p><${Words}>${schema.description ?? ""}<//></p>
        <${Forms} name=${name} schema=${schema} />
      </details>
    `,
  );
