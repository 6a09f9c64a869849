// One operation: what it does, what it takes, what it answers.

import { html, useState } from "../html.js";
import { Table } from "../part/table.js";
import { Json, Kind, Words } from "./text.js";
import { Trial } from "./trial.js";

const kindOf = (/** @type {JsonParameter} */ parameter) =>
  parameter.in === "path" ? "in the path" : `in the query${parameter.required ? "" : ", optional"}`;

/** @param {{ parameters: JsonParameter[], label: string }} properties */
const Parameters = ({ parameters, label }) => html`
  <h4>Parameters</h4>
  <${Table}
    label=${label}
    head=${["name", "where", "holds", "meaning"]}
    rows=${parameters.map((parameter) => [
      html`<code>${parameter.name}</code>`,
      kindOf(parameter),
      html`<${Kind} of=${parameter.schema} />`,
      html`<${Words}>${parameter.description}<//>`,
    ])}
  />
`;

/** @param {{ body: NonNullable<JsonOperation["requestBody"]> }} properties */
const Body = ({ body }) =>
  Object.entries(body.content).map(
    ([type, content]) => html`
      <h4>Body</h4>
      <p><code>${type}</code>: <${Kind} of=${content?.schema} /></p>
      ${
        content?.example &&
        html`
          <pre tabindex="0" aria-label="an example of the body">
            <${Json} text=${JSON.stringify(content?.example, null, 2)} />
          </pre>
        `
      }
    `,
  );

/** What an answer holds. */
const held = (/** @type {JsonResponse} */ response) =>
  Object.entries(response.content ?? {}).map(
    ([type, content], k) => html`
      ${k ? ", " : ""}
      ${type === "application/json" ? "" : html`<code>${type}</code> `}
      <${Kind} of=${content?.schema} />
    `,
  );

/** @param {{ operation: import("./document.js").Operation, isOpen: boolean }} properties */
export function OperationCard({ operation, isOpen }) {
  const [isShown, setShown] = useState(isOpen);
  const { id, method, path } = operation;
  return html`
    <details
      class="operation"
      id=${id}
      open=${isOpen}
      onToggle=${(/** @type {DetailsEvent} */ e) => setShown(e.currentTarget.open)}
    >
      <summary>
        <span class="method ${method.toLowerCase()}">${method}</span> <code class="path">${path}</code>
        <span class="what">${operation.summary.replace(/\.$/, "")}</span>
      </summary>
      ${
        (isShown || isOpen) &&
        html`
          <p><${Words}>${operation.description}<//> <a class="note" href=${`#/${id}`}>${id}</a></p>
          ${
            operation.parameters.length > 0 &&
            html`<${Parameters} parameters=${operation.parameters} label=${`parameters of ${id}`} />`
          }
          ${operation.body && html`<${Body} body=${operation.body} />`}
          <h4>Answers</h4>
          <${Table}
            label=${`answers of ${id}`}
            head=${["status", "when", "holds"]}
            rows=${operation.responses.map(([status, response]) => [
              status,
              html`<${Words}>${response.description}<//>`,
              held(response),
            ])}
          />
          ${method === "GET" && html`<${Trial} operation=${operation} />`}
        `
      }
    </details>
  `;
}
