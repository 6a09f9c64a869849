// The page of a service: the home of all studies, or one study in one of its views.

import { html, render, useEffect, useLayoutEffect, useState } from "./html.js";
import { t } from "./language/language.js";
import { arrive, keepLeftView } from "./left_view.js";
import { Later } from "./part/later.js";
import { Settings } from "./part/settings.js";
import { token } from "./rest/token.js";
import { useRoute } from "./route.js";
import { StudyPage } from "./view/study.js";

const login = () => import("./part/login.js").then((module) => module.Login);
const home = () => import("./view/home.js").then((module) => module.Home);
const beside = () => import("./view/beside.js").then((module) => module.Beside);
const newCalibration = () => import("./view/new_calibration.js").then((module) => module.NewCalibration);

function Page() {
  const route = useRoute();
  const [isAsked, setAsked] = useState(token.isAsked());
  useEffect(() => token.watch(() => setAsked(token.isAsked())), []);
  const [first, id, view] = route.place;
  const isBeside =
    first === "beside" && route.place.slice(1, 3).every((one) => /^\d+$/.test(one)) && route.place.length === 3;
  const isStudy = first === "studies" && /^\d+$/.test(id ?? "");
  // Before the view is painted: a place that is kept in between would be that of the view before it.
  useLayoutEffect(() => {
    document.getElementById("content")?.focus({ preventScroll: true });
    return arrive();
  }, [first, id, view]);
  useEffect(keepLeftView, []);
  useEffect(() => {
    // A study names itself when it is known.
    if (isStudy) return;
    const title = first === "new" ? t`New calibration` : first === "beside" ? t`Two studies` : t`Studies`;
    document.title = `${title} – Grouser`;
  }, [first, isStudy]);
  return html`
    <a class="skip" href="#content" onClick=${skip}>To the content</a>
    <header class="top">
      <a class="brand" href="#/">Grouser</a>
      <nav aria-label="Pages">
        <a href="#/" aria-current=${first === undefined ? "page" : null}>Studies</a>
        <a href="#/new" aria-current=${first === "new" ? "page" : null}>New calibration</a>
        <a href="/docs">Interface</a>
      </nav>
      <${Settings} />
      ${token.get() && html`<button type="button" onClick=${() => token.clear()}>Forget the token</button>`}
    </header>
    <main id="content" tabindex="-1">
      ${isAsked && html`<${Later} title="The login" load=${login} />`}
      ${first === undefined && html`<${Later} title="The list of studies" load=${home} />`}
      ${first === "new" && html`<${Later} title="New calibration" load=${newCalibration} query=${route.query} />`}
      ${isStudy && html`<${StudyPage} key=${id} id=${Number(id)} view=${view ?? "story"} query=${route.query} />`}
      ${
        isBeside &&
        html`
          <${Later}
            key=${route.place.join("/")}
            title="The comparison"
            load=${beside}
            ids=${route.place.slice(1).map(Number)}
          />
        `
      }
      ${
        !isStudy &&
        !isBeside &&
        !["new", undefined].includes(first) &&
        html`<h1>There is no such page</h1><p><a href="#/">To the studies</a></p>`
      }
    </main>
  `;
}

/** Goes to the content without changing the address, which is that of a view. */
function skip(/** @type {Event} */ event) {
  event.preventDefault();
  document.getElementById("content")?.focus();
}

const place = /** @type {HTMLElement} */ (document.getElementById("page"));
place.replaceChildren();
render(html`<${Page} />`, place);
