// The interface described: every operation of openapi.json, its messages, and a way to try what only reads.

import { html, render, useEffect, useState } from "../html.js";
import { Login } from "../part/login.js";
import { Pending } from "../part/message.js";
import { token } from "../rest/token.js";
import { useAnswer } from "../rest/use_answer.js";
import { useRoute } from "../route.js";
import { groups } from "./document.js";
import { OperationCard } from "./operation.js";
import { Schemas } from "./schemas.js";
import { Words } from "./text.js";

const title = (/** @type {string} */ name) => name[0].toUpperCase() + name.slice(1);

/** @param {{ document: OpenApi, place: string[] }} properties */
function Description({ document: description, place }) {
  const target = place.join("/");
  useEffect(() => {
    if (target) document.getElementById(target)?.scrollIntoView();
  }, [target]);
  const tags = groups(description);
  return html`
    <h1>The interface</h1>
    <p><${Words}>${description.info.description}<//></p>
    <p class="note">
      Version ${description.info.version}. <a href="/openapi.json">openapi.json</a> is the same for programs that
      generate clients.
    </p>
    <nav class="views" aria-label="Parts of the interface">
      ${[...tags.map(({ name }) => name), "schemas"].map((name) => html`<a href=${`#/${name}`}>${title(name)}</a>`)}
    </nav>
    ${tags.map(
      (tag) => html`
        <section key=${tag.name} aria-label=${tag.name}>
          <h2 id=${tag.name}>${title(tag.name)}</h2>
          <p>${tag.description}</p>
          ${tag.operations.map(
            (operation) =>
              html`<${OperationCard} key=${operation.id} operation=${operation} isOpen=${target === operation.id} />`,
          )}
        </section>
      `,
    )}
    <section aria-label="schemas">
      <h2 id="schemas">Schemas</h2>
      <p>What the messages hold.</p>
      <${Schemas} schemas=${description.components.schemas} open=${place[0] === "schemas" ? place[1] : null} />
    </section>
  `;
}

function Page() {
  const { place } = useRoute();
  const [isAsked, setAsked] = useState(token.isAsked());
  useEffect(() => token.watch(() => setAsked(token.isAsked())), []);
  const { answer, error } = useAnswer("/openapi.json");
  return html`
    <header class="top">
      <a class="brand" href="/">Grouser</a>
      <nav aria-label="Pages">
        <a href="/#/">Studies</a>
        <a href="/#/new">New calibration</a>
        <a href="/docs" aria-current="page">Interface</a>
      </nav>
      ${token.get() && html`<button type="button" onClick=${() => token.clear()}>Forget the token</button>`}
    </header>
    <main id="content" class="interface" tabindex="-1">
      ${isAsked && html`<${Login} />`}
      ${
        answer
          ? html`<${Description} document=${answer} place=${place} />`
          : html`<h1>The interface</h1><${Pending} answer=${answer} error=${error} what="The description" />`
      }
    </main>
  `;
}

const place = /** @type {HTMLElement} */ (document.getElementById("page"));
place.replaceChildren();
render(html`<${Page} />`, place);
