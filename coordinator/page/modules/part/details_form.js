// A form for what people say of a study: its name, author, tags and a note.

import { errorOf } from "../rest/answers.js";
import { html, useState } from "../html.js";
import { describe } from "../rest/routes.js";
import { tagsOf } from "../words/details.js";
import { Failure } from "./message.js";

/** @param {{ study: Study, reload: () => void, close: () => void }} properties */
export function DetailsForm({ study, reload, close }) {
  const { details } = study;
  const [name, setName] = useState(study.name);
  const [author, setAuthor] = useState(details.author ?? "");
  const [tags, setTags] = useState(details.tags.join(", "));
  const [note, setNote] = useState(details.note ?? "");
  const [failure, setFailure] = useState(/** @type {Error | null} */ (null));
  const save = async (/** @type {Event} */ event) => {
    event.preventDefault();
    const said = (/** @type {string} */ text) => text.trim() || null;
    try {
      await describe(study.id, {
        name: said(name) === study.name && details.name === null ? null : said(name),
        author: said(author),
        tags: tagsOf(tags),
        note: said(note),
      });
      reload();
      close();
    } catch (error) {
      setFailure(errorOf(error));
    }
  };
  const typed =
    (/** @type {(text: string) => void} */ set) =>
    (/** @type {FieldEvent<HTMLInputElement | HTMLTextAreaElement>} */ event) =>
      set(event.currentTarget.value);
  return html`
    <form class="card details" onSubmit=${save}>
      <label>Name of the study <input value=${name} onInput=${typed(setName)} /></label>
      <label>Author <input value=${author} onInput=${typed(setAuthor)} /></label>
      <label>Tags <input value=${tags} placeholder="sand, wheel 3" onInput=${typed(setTags)} /></label>
      <label>Note <textarea rows="3" value=${note} onInput=${typed(setNote)}></textarea></label>
      <div class="actions">
        <button class="main" type="submit">Save</button>
        <button type="button" onClick=${close}>Leave as it is</button>
      </div>
      <${Failure} error=${failure} />
    </form>
  `;
}
