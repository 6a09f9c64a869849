// A new calibration: its files are dropped, chosen, taken from an example or written from a table, then sent.

import { experimentOf, fileOf, find, kindOf, missing, named, requests } from "../draft.js";
import { author } from "../author.js";
import { html, useEffect, useRef, useState } from "../html.js";
import { t, told } from "../language/language.js";
import { DropZone } from "../part/drop_zone.js";
import { FileCard } from "../part/file_card.js";
import { JobCheck } from "../part/job_check.js";
import { ImportTable } from "../part/import_table.js";
import { Failure } from "../part/message.js";
import { RigForm } from "../part/rig_form.js";
import { RunChoices } from "../part/run_choices.js";
import { errorOf, request } from "../rest/answers.js";
import { addExperiment, check, describe, filesOfStudy, get, path, submit } from "../rest/routes.js";
import { useAnswer } from "../rest/use_answer.js";
import { address } from "../route.js";
import { tagsOf } from "../words/details.js";

/** @typedef {import("../draft.js").Files} Files */

/** A table to import, which the program carries. */
const EXAMPLE_TABLE = { name: "Messung_Sand.xlsx", path: "/page/example/Messung_Sand.xlsx" };

/** @param {{ query: Record<string, string> }} properties query.example: the example to begin with. query.study: the
 *   study to begin again with */
export function NewCalibration({ query }) {
  const [files, setFiles] = useState(/** @type {Files} */ ({}));
  // The bytes of what was dropped: a table is read from these.
  const [bytes, setBytes] = useState(/** @type {Record<string, Uint8Array>} */ ({}));
  const [asked, setJob] = useState(/** @type {string | null} */ (null));
  const [name, setName] = useState("");
  const [person, setPerson] = useState(author.known());
  const [tags, setTags] = useState("");
  const [failure, setFailure] = useState(/** @type {Error | null} */ (null));
  const [isSent, setSent] = useState(false);
  // What the service says of the job as it stands; nothing where it has changed since.
  const [checked, setChecked] = useState(/** @type {Schemas["JobCheck"] | null} */ (null));
  const [isChecking, setChecking] = useState(false);
  // A calibration that runs, although its author and tags were not kept.
  const [begun, setBegun] = useState(/** @type {{ study: number, message: string } | null} */ (null));
  const examples = useAnswer(path.examples);
  const kinds = Object.fromEntries(Object.entries(files).map(([own, text]) => [own, kindOf(own, text)]));
  const of = (/** @type {string} */ kind) => Object.keys(files).filter((own) => kinds[own] === kind);
  const job = asked !== null && asked in files ? asked : (of("job")[0] ?? null);
  const experiment = job === null ? null : experimentOf(files, job);
  const draft = useRef({ files, job });
  draft.current = { files, job };
  const change = (/** @type {Files} */ next) => {
    setFiles(next);
    setFailure(null);
    setChecked(null);
    setBegun(null);
  };
  const add = (/** @type {Files} */ more) => change({ ...files, ...more });
  const remove = (/** @type {string} */ own) => {
    change(without(files, own));
    setBytes(without(bytes, own));
  };
  const take = (/** @type {import("../part/drop_zone.js").Read} */ read) => {
    add(read.texts);
    setBytes({ ...bytes, ...read.bytes });
    // A table gives the study its name, until somebody types another.
    const own = Object.keys(read.bytes).find((file) => !/\.toml$|^runs\.csv$/i.test(file));
    if (own && name === "") setName(own.replace(/\.[^.]*$/, ""));
  };
  const open = async (/** @type {string} */ example) => {
    try {
      const answer = await get(`${path.examples}/${encodeURIComponent(example)}`);
      change({ [answer.job.name]: answer.job.text, [answer.experiment.name]: answer.experiment.text, ...answer.files });
      setJob(answer.job.name);
      setName(answer.name);
    } catch (error) {
      setFailure(errorOf(error));
    }
  };
  useEffect(() => void (query.example && open(query.example)), [query.example]);
  const openTable = async () => {
    try {
      const content = await (await request("GET", EXAMPLE_TABLE.path)).arrayBuffer();
      take({ texts: {}, bytes: { [EXAMPLE_TABLE.name]: new Uint8Array(content) } });
    } catch (error) {
      setFailure(errorOf(error));
    }
  };
  const again = async (/** @type {string} */ study) => {
    try {
      const draft = await filesOfStudy(study);
      change(draft.files);
      setJob("job.toml");
      setName(draft.name);
    } catch (error) {
      setFailure(errorOf(error));
    }
  };
  useEffect(() => void (query.study && again(query.study)), [query.study]);
  /**
   * Keeps author and tags, and the author for the next study of this browser. The service may have named an author
   * already.
   */
  const said = async (/** @type {number} */ study) => {
    author.keep(person);
    const [name, words] = [person.trim(), tagsOf(tags)];
    if (name === "" && words.length === 0) return;
    const { details } = await get(path.study(study));
    await describe(study, { ...details, author: name || details.author, tags: words });
  };
  const look = async () => {
    setChecking(true);
    setFailure(null);
    setChecked(null);
    // A pilot takes a while: its answer counts only for the draft that it was asked about.
    const isSame = () => draft.current.files === files && draft.current.job === job;
    try {
      const { experiment: rig, job: calibration } = requests(
        files,
        /** @type {string} */ (job),
        /** @type {string} */ (experiment),
      );
      const answer = await check({ experiment: rig, ...calibration });
      if (isSame()) setChecked(answer);
    } catch (error) {
      if (isSame()) setFailure(errorOf(error));
    }
    setChecking(false);
  };
  const start = async () => {
    setSent(true);
    setFailure(null);
    try {
      const { experiment: rig, job: calibration } = requests(
        files,
        /** @type {string} */ (job),
        /** @type {string} */ (experiment),
      );
      const { id } = await addExperiment(rig);
      const created = await submit({ experiment: id, ...calibration, name: name.trim() || null });
      try {
        await said(created.study);
        location.hash = address(["studies", created.study, "live"]);
      } catch (error) {
        setBegun({ study: created.study, message: /** @type {Error} */ (error).message });
      }
    } catch (error) {
      setFailure(errorOf(error));
    }
    setSent(false);
  };
  const absent = missing(files, job);
  const list = job === null ? null : named(files, job, experiment);
  const used =
    list === null
      ? null
      : new Set([job, experiment, ...[...list.job, ...list.experiment].map((one) => find(files, one.name))]);
  const table = Object.keys(bytes).find((own) => !(own in files)) ?? of("table")[0];
  const runs = find(files, "runs.csv");
  const isRuns = runs !== null && kinds[runs] === "runs";
  const place = failure && fileOf(failure.message, files, job, experiment);
  // The form writes what is still needed.
  const isAsked = isRuns && job === null && of("experiment").length === 0;
  const isEmpty = Object.keys(files).length === 0 && !table;
  return html`
    <h1>New calibration</h1>
    <${DropZone} onFiles=${take} />
    ${
      examples.answer &&
      examples.answer.length > 0 &&
      html`
        <p>Or begin with an example:</p>
        <ul class="examples">
          ${examples.answer.map(
            (e) =>
              html`
                <li>
                  <button type="button" onClick=${() => open(e.name)}>${e.name}</button>${" "}
                  <span><b>${told(e.title)}</b>: <span class="note">${told(e.summary)}</span></span>
                </li>
              `,
          )}
          <li>
            <button type="button" onClick=${openTable}>${EXAMPLE_TABLE.name}</button>${" "}
            <span>
              <b>A German Excel file</b>:${" "}
              <span class="note">
                a table as a rig keeps it, in per cent, kN and mm with decimal commas: its
                import; <a href=${EXAMPLE_TABLE.path} download>save the file</a>
              </span>
            </span>
          </li>
        </ul>
      `
    }
    ${
      table &&
      html`
        <${ImportTable}
          key=${table}
          name=${table}
          bytes=${bytes[table] ?? new TextEncoder().encode(files[table])}
          onRemove=${() => remove(table)}
          onFiles=${(/** @type {Files} */ made) => {
            change({ ...without(files, table), ...made });
            setBytes(without(bytes, table));
          }}
        />
      `
    }
    ${
      isRuns &&
      html`<${RunChoices} text=${files[runs]} onText=${(/** @type {string} */ text) => add({ [runs]: text })} />`
    }
    ${isAsked && html`<${RigForm} runs=${files[runs]} onFiles=${add} />`}
    ${Object.keys(files)
      .filter((own) => own !== table)
      .map(
        (own) => html`
          <${FileCard}
            key=${own}
            name=${own}
            text=${files[own]}
            kind=${kinds[own]}
            isUsed=${used === null || used.has(own)}
            error=${place === own ? failure : null}
            onText=${(/** @type {string} */ text) => add({ [own]: text })}
            onRemove=${() => remove(own)}
          />
        `,
      )}
    ${
      of("job").length > 1 &&
      html`
        <p>
          <label>
            Job <select
              value=${job}
              onChange=${(/** @type {SelectEvent} */ e) => {
                setJob(e.currentTarget.value);
                setChecked(null);
              }}
            >
              ${of("job").map((own) => html`<option value=${own} selected=${own === job}>${own}</option>`)}
            </select>
          </label>
        </p>
      `
    }
    ${
      !isEmpty &&
      !table &&
      !isAsked &&
      absent.length > 0 &&
      html`
        <div class="missing" role="status">
          <p>Still needed:</p>
          <ul>${absent.map((what) => html`<li>${what}</li>`)}</ul>
        </div>
      `
    }
    ${failure && place === null && html`<${Failure} error=${failure} />`}
    ${
      begun &&
      html`
        <p class="note" role="status">
          The calibration runs, but its author and tags were not
          kept: ${begun.message}. <a href=${address(["studies", begun.study, "live"])}>See it run</a>
        </p>
      `
    }
    ${checked && html`<${JobCheck} answer=${checked} />`}
    ${
      !isEmpty &&
      html`
        <div class="actions">
          <label>
            Name <input
              value=${name}
              placeholder="as the study is listed"
              onInput=${(/** @type {FieldEvent} */ e) => setName(e.currentTarget.value)}
            />
          </label>
          <label>
            Author <input
              value=${person}
              onInput=${(/** @type {FieldEvent} */ e) => setPerson(e.currentTarget.value)}
            />
          </label>
          <label>
            Tags <input
              value=${tags}
              placeholder="sand, wheel 3"
              onInput=${(/** @type {FieldEvent} */ e) => setTags(e.currentTarget.value)}
            />
          </label>
          <button type="button" disabled=${absent.length > 0 || Boolean(table) || isChecking} onClick=${look}>
            ${isChecking ? t`A pilot runs …` : t`Check, with its cost`}
          </button>
          <button
            class="main"
            type="button"
            disabled=${absent.length > 0 || Boolean(table) || isSent || begun !== null}
            onClick=${start}
          >
            ${isSent ? t`It is being sent` : t`Start the calibration`}
          </button>
        </div>
      `
    }
  `;
}

/**
 * The entries but one.
 * @template Value
 * @param {Record<string, Value>} all
 * @param {string} name
 * @returns {Record<string, Value>}
 */
const without = (all, name) => Object.fromEntries(Object.entries(all).filter(([key]) => key !== name));
