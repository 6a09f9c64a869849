// A question to this service, by hand: what it answers, in how long, and the line of a shell that asks the same.

import { html, useState } from "../html.js";
import { Failure } from "../part/message.js";
import { errorOf, request } from "../rest/answers.js";
import { token } from "../rest/token.js";
import { curl, filled } from "./document.js";
import { Json } from "./text.js";

/** So much of an answer is shown. */
const MOST_CHARACTERS = 20_000;

/** JSON with line breaks; what is none stays as it is. */
function readable(/** @type {string} */ text) {
  try {
    return JSON.stringify(JSON.parse(text), null, 2);
  } catch {
    return text;
  }
}

/** @typedef {{ status: number, text: string, ms: number }} Read */

/** @param {{ operation: import("./document.js").Operation }} properties */
export function Trial({ operation }) {
  const [values, setValues] = useState(/** @type {Record<string, string>} */ ({}));
  const [state, setState] = useState(
    /** @type {{ answer: Read | null, error: Error | null, isAsking: boolean }} */ ({
      answer: null,
      error: null,
      isAsking: false,
    }),
  );
  const path = filled(operation, values);
  const isStream = operation.responses.some(([, response]) => response.content?.["text/event-stream"]);
  const ask = async (/** @type {Event} */ event) => {
    event.preventDefault();
    setState({ answer: null, error: null, isAsking: true });
    const begin = performance.now();
    try {
      const response = await request("GET", path);
      const text = readable(await response.text());
      setState({
        answer: { status: response.status, text, ms: Math.round(performance.now() - begin) },
        error: null,
        isAsking: false,
      });
    } catch (error) {
      setState({ answer: null, error: errorOf(error), isAsking: false });
    }
  };
  return html`
    <form class="trial" onSubmit=${ask}>
      <h4>Try it</h4>
      <div class="actions">
        ${operation.parameters.map(
          ({ name, in: place }) => html`
            <label class="field">
              ${name}${" "}
              <input
                required=${place === "path"}
                value=${values[name] ?? ""}
                onInput=${(/** @type {FieldEvent} */ e) => setValues({ ...values, [name]: e.currentTarget.value })}
              />
            </label>
          `,
        )}
        ${!isStream && html`<button class="main" type="submit" disabled=${state.isAsking}>GET</button>`}
      </div>
      <pre tabindex="0" aria-label="the same on a terminal">${curl(location.origin + path, token.get())}</pre>
      <${Failure} error=${state.error} />
      ${
        state.answer &&
        html`
          <p class="note" role="status">
            ${state.answer.status} after ${state.answer.ms} ms, ${state.answer.text.length} characters
          </p>
          <pre class="answer" tabindex="0" aria-label="the answer">
            <${Json} text=${state.answer.text.slice(0, MOST_CHARACTERS)} />
            ${state.answer.text.length > MOST_CHARACTERS && "\n…"}
          </pre>
        `
      }
    </form>
  `;
}
