// What people say of a study: its author, tags and a note.

import { html } from "../html.js";

/** @param {{ study: Study }} properties */
export function SaidOfStudy({ study: { details } }) {
  const { author, tags, note } = details;
  return html`
    ${
      (author || tags.length > 0) &&
      html`<p class="note">${author && html`<span>Author: ${author}</span> `}<${Tags} tags=${tags} /></p>`
    }
    ${note && html`<p class="said">${note}</p>`}
  `;
}

/** @param {{ tags: string[], choose?: (tag: string) => void }} properties choose: where a tag finds its studies */
export const Tags = ({ tags, choose }) =>
  tags.map((tag) =>
    choose
      ? html`<button type="button" class="tag" key=${tag} onClick=${() => choose(tag)}>${tag}</button> `
      : html`<span class="tag" key=${tag}>${tag}</span> `,
  );
