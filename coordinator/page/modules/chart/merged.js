// Marks of many runs as one path for each colour: a picture of thousands of elements is slow to draw and to light up.

/** A picture of more marks is drawn with merged ones. */
export const MANY = 300;
/** Smallest distance from the middle of a mark at which a pointer selects it [px]. */
const LEAST_REACH = 6;
const SVG = "http://www.w3.org/2000/svg";

/** @typedef {{ run: string, x: number, y: number, reach: number, d: string }} Mark its middle, and its outline in the picture */
/** @type {WeakMap<Element, Mark[]>} */
const marksOf = new WeakMap();

/** The outline of an element at its place, with its middle. @returns {Omit<Mark, "run">} */
export function outline(/** @type {{ tagName: string, getAttribute: (name: string) => string | null }} */ element) {
  const number = (/** @type {string} */ name) => Number(element.getAttribute(name) ?? 0);
  switch (element.tagName) {
    case "circle": {
      const [x, y, r] = [number("cx"), number("cy"), number("r")];
      return { x, y, reach: Math.max(r, LEAST_REACH), d: `M${x - r},${y}a${r},${r} 0 1,0 ${2 * r},0a${r},${r} 0 1,0 ${-2 * r},0` };
    }
    case "rect": {
      const [x, y, width, height] = [number("x"), number("y"), number("width"), number("height")];
      return { x: x + width / 2, y: y + height / 2, reach: Math.max(width, height) / 2, d: `M${x},${y}h${width}v${height}h${-width}Z` };
    }
    case "line": {
      const [x1, y1, x2, y2] = [number("x1"), number("y1"), number("x2"), number("y2")];
      return { x: (x1 + x2) / 2, y: (y1 + y2) / 2, reach: LEAST_REACH, d: `M${x1},${y1}L${x2},${y2}` };
    }
    default: {
      const [left, top] = numbersOf(element.getAttribute("transform") ?? "");
      return { x: left ?? 0, y: top ?? 0, reach: LEAST_REACH, d: moved(element.getAttribute("d") ?? "", left ?? 0, top ?? 0) };
    }
  }
}

const numbersOf = (/** @type {string} */ text) => text.match(/-?[\d.]+(?:e-?\d+)?/g)?.map(Number) ?? [];

/** @type {{ d: string, parts: { head: string, x: number, y: number }[] }} the symbol that was moved last: most marks of a group have one */
let last = { d: "", parts: [] };

/** The data of a symbol elsewhere: its absolute ends move, what follows them is relative. */
export function moved(/** @type {string} */ d, /** @type {number} */ left, /** @type {number} */ top) {
  if (d !== last.d) last = { d, parts: partsOf(d) };
  return last.parts.map(({ head, x, y }) => (Number.isNaN(x) ? head : `${head}${x + left},${y + top}`)).join("");
}

/** The commands of a symbol: of each the text before its end point, and the end point; NaN where that is relative. */
function partsOf(/** @type {string} */ d) {
  return [...d.matchAll(/([MLHVCSQTAZ])([^MLHVCSQTAZ]*)/gi)].map(([text, command, values]) => {
    const numbers = numbersOf(values);
    if (!"MLA".includes(command)) return { head: text, x: NaN, y: NaN };
    const [x, y] = numbers.slice(-2);
    return { head: command + numbers.slice(0, -2).map((value) => `${value},`).join(""), x, y };
  });
}

/**
 * Replaces the elements of a group by one path for each of their colours; on an event `light` with runs, those stand out.
 * @param {SVGGElement} group
 * @param {(element: any) => string | undefined} runOf
 */
export function merge(group, runOf) {
  /** @type {Map<string, { fill: string | null, stroke: string | null, d: string[] }>} */
  const paths = new Map();
  /** @type {Mark[]} */
  const marks = [];
  for (const element of [...group.children]) {
    const run = runOf(element);
    if (run === undefined) continue;
    const mark = { run, ...outline(element) };
    marks.push(mark);
    const [fill, stroke] = [element.getAttribute("fill"), element.getAttribute("stroke")];
    const own = paths.get(`${fill} ${stroke}`) ?? { fill, stroke, d: [] };
    own.d.push(mark.d);
    paths.set(`${fill} ${stroke}`, own);
  }
  group.replaceChildren(...[...paths.values()].map(({ fill, stroke, d }) => path(d, { fill, stroke })));
  group.classList.add("merged");
  marksOf.set(group, marks);
  group.addEventListener("light", (event) => {
    group.querySelector(".lit")?.remove();
    const runs = /** @type {CustomEvent<Set<string> | null>} */ (event).detail;
    const d = runs === null ? [] : marks.filter((mark) => runs.has(mark.run)).map((mark) => mark.d);
    if (d.length > 0) group.append(path(d, { class: "lit" }));
  });
}

function path(/** @type {string[]} */ d, /** @type {Record<string, string | null>} */ attributes) {
  const made = document.createElementNS(SVG, "path");
  made.setAttribute("d", d.join(""));
  for (const [name, value] of Object.entries(attributes)) if (value !== null) made.setAttribute(name, value);
  return made;
}

/** The run of the mark nearest to a place; undefined where none reaches it. */
export function nearest(/** @type {Mark[]} */ marks, /** @type {number} */ x, /** @type {number} */ y) {
  const found = marks.reduce((/** @type {{ run?: string, far: number }} */ best, mark) => {
    const far = Math.hypot(mark.x - x, mark.y - y) - mark.reach;
    return far < best.far ? { run: mark.run, far } : best;
  }, { far: 0 });
  return found.run;
}

/** The run of the merged mark under a pointer. */
export function mergedRunAt(/** @type {SVGSVGElement} */ plot, /** @type {MouseEvent} */ event) {
  const marks = [...plot.querySelectorAll(".merged")].flatMap((group) => marksOf.get(group) ?? []);
  const toScreen = plot.getScreenCTM();
  if (marks.length === 0 || !toScreen) return undefined;
  const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(toScreen.inverse());
  return nearest(marks, x, y);
}
