// The login: the token stays in this browser.

import { html, useState } from "../html.js";
import { token } from "../rest/token.js";

export function Login() {
  const [secret, setSecret] = useState("");
  const enter = (/** @type {Event} */ event) => {
    event.preventDefault();
    if (secret.trim()) token.set(secret.trim());
  };
  return html`
    <form class="card login" onSubmit=${enter}>
      <h2>This service asks for a token</h2>
      <p>
        Whoever runs the service makes one with <code>coordinator token add NAME --role submit</code>. It stays in this
        browser and is sent to this service alone.
      </p>
      <label>
        Token <input
          type="password"
          autocomplete="off"
          value=${secret}
          onInput=${(/** @type {FieldEvent} */ e) => setSecret(e.currentTarget.value)}
        />
      </label>
      <button class="main" type="submit">Use it</button>
    </form>
  `;
}
