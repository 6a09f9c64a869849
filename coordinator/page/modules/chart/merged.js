// Marks of many runs as one path for each colour: a picture of thousands of elements is slow to draw and to light up.

/** A picture of more marks is drawn with merged ones. */
export const MANY = 300;
/** Smallest distance from the middle of a mark at which a pointer selects it [px]. */
const LEAST_REACH = 6;
const SVG = "http://www.w3.org/2000/svg";

/**
 * @typedef {{ run: string, x: number, y: number, reach: number, d: string, fill?: string | null, stroke?: string | null
 *   }} Mark its middle, its outline in the picture, and its colours where the group has none
 */
/** @type {WeakMap<Element, Mark[]>} */
const marksOf = new WeakMap();

/** The outline of an element at its place, with its middle. @returns {Omit<Mark, "run">} */
export function outline(/** @type {{ tagName: string, getAttribute: (name: string) => string | null }} */ element) {
  const number = (/** @type {string} */ name) => Number(element.getAttribute(name) ?? 0);
  switch (element.tagName) {
    case "circle": {
      const [x, y, r] = [number("cx"), number("cy"), number("r")];
      return {
        x,
        y,
        reach: Math.max(r, LEAST_REACH),
        d: `M${x - r},${y}a${r},${r} 0 1,0 ${2 * r},0a${r},${r} 0 1,0 ${-2 * r},0`,
      };
    }
    case "rect": {
      const [x, y, width, height] = [number("x"), number("y"), number("width"), number("height")];
      return {
        x: x + width / 2,
        y: y + height / 2,
        reach: Math.max(width, height) / 2,
        d: `M${x},${y}h${width}v${height}h${-width}Z`,
      };
    }
    case "line": {
      const [x1, y1, x2, y2] = [number("x1"), number("y1"), number("x2"), number("y2")];
      return { x: (x1 + x2) / 2, y: (y1 + y2) / 2, reach: LEAST_REACH, d: `M${x1},${y1}L${x2},${y2}` };
    }
    default: {
      const [left, top] = numbersOf(element.getAttribute("transform") ?? "");
      return {
        x: left ?? 0,
        y: top ?? 0,
        reach: LEAST_REACH,
        d: moved(element.getAttribute("d") ?? "", left ?? 0, top ?? 0),
      };
    }
  }
}

const numbersOf = (/** @type {string} */ text) => text.match(/-?[\d.]+(?:e-?\d+)?/g)?.map(Number) ?? [];

/**
 * @type {{ d: string, parts: { head: string, x: number, y: number }[] }} the symbol that was moved last: most marks of
 *   a group have one
 */
let last = { d: "", parts: [] };

/** The data of a symbol elsewhere: its absolute ends move, what follows them is relative. */
export function moved(/** @type {string} */ d, /** @type {number} */ left, /** @type {number} */ top) {
  if (d !== last.d) last = { d, parts: partsOf(d) };
  return last.parts
    .map(({ head, x, y }) => (Number.isNaN(x) ? head : `${head}${rounded(x + left)},${rounded(y + top)}`))
    .join("");
}

/** A place in the picture to a thousandth of a pixel, which keeps paths short. */
const rounded = (/** @type {number} */ value) => Math.round(1000 * value) / 1000;

/** The commands of a symbol: of each the text before its end point, and the end point; NaN where that is relative. */
function partsOf(/** @type {string} */ d) {
  return [...d.matchAll(/([MLHVCSQTAZ])([^MLHVCSQTAZ]*)/gi)].map(([text, command, values]) => {
    const numbers = numbersOf(values);
    if (!"MLA".includes(command)) return { head: text, x: NaN, y: NaN };
    const [x, y] = numbers.slice(-2);
    return {
      head:
        command +
        numbers
          .slice(0, -2)
          .map((value) => `${value},`)
          .join(""),
      x,
      y,
    };
  });
}

/**
 * The marks of a group by the element of the first one: their places and colours are those that the scales give.
 * @param {{ tagName: string, getAttribute: (name: string) => string | null }} first
 * @param {ArrayLike<number>} index of the data
 * @param {Partial<Record<"x" | "y" | "y1" | "y2", number[]> & Record<"fill" | "stroke", string[]>>} values
 * @param {(place: number) => string} runOf
 * @returns {Mark[]}
 */
export function marksLike(first, index, { x = [], y, y1, y2, fill, stroke }, runOf) {
  const pattern = outline(first);
  const colours = (/** @type {number} */ k) => ({
    run: runOf(k),
    fill: fill?.[k] ?? null,
    stroke: stroke?.[k] ?? null,
  });
  return Array.from(index, (k) => {
    const left = x[k] - x[index[0]];
    // The ends of a line differ from mark to mark.
    if (y1 && y2) {
      const line = { x: pattern.x + left, y: (y1[k] + y2[k]) / 2, reach: pattern.reach };
      return { ...line, d: `M${rounded(line.x)},${rounded(y1[k])}V${rounded(y2[k])}`, ...colours(k) };
    }
    const top = y === undefined ? 0 : y[k] - y[index[0]];
    return {
      x: pattern.x + left,
      y: pattern.y + top,
      reach: pattern.reach,
      d: moved(pattern.d, left, top),
      ...colours(k),
    };
  });
}

/**
 * Replaces the elements of a group by one path for each colour of its marks; on an event `light` with runs, those stand
 * out.
 * @param {SVGElement} group
 * @param {Mark[]} marks
 */
export function merge(group, marks) {
  /** @type {Map<string, { fill: string | null, stroke: string | null, d: string[] }>} */
  const paths = new Map();
  for (const mark of marks) {
    const { fill = null, stroke = null } = mark;
    const path = paths.get(`${fill} ${stroke}`) ?? { fill, stroke, d: [] };
    path.d.push(mark.d);
    paths.set(`${fill} ${stroke}`, path);
  }
  group.replaceChildren(...[...paths.values()].map(({ fill, stroke, d }) => pathElement(d, { fill, stroke })));
  group.classList.add("merged");
  marksOf.set(group, marks);
  group.addEventListener("light", (event) => {
    group.querySelector(".lit")?.remove();
    const runs = /** @type {CustomEvent<Set<string> | null>} */ (event).detail;
    const d = runs === null ? [] : marks.filter((mark) => runs.has(mark.run)).map((mark) => mark.d);
    if (d.length > 0) group.append(pathElement(d, { class: "lit" }));
  });
}

function pathElement(/** @type {string[]} */ d, /** @type {Record<string, string | null>} */ attributes) {
  const element = document.createElementNS(SVG, "path");
  element.setAttribute("d", d.join(""));
  for (const [name, value] of Object.entries(attributes)) if (value !== null) element.setAttribute(name, value);
  return element;
}

/** The run of the mark nearest to a place; undefined where none reaches it. */
export function nearest(/** @type {Mark[]} */ marks, /** @type {number} */ x, /** @type {number} */ y) {
  const closest = marks.reduce(
    (/** @type {{ run?: string, distance: number }} */ best, mark) => {
      const distance = Math.hypot(mark.x - x, mark.y - y) - mark.reach;
      return distance < best.distance ? { run: mark.run, distance } : best;
    },
    { distance: 0 },
  );
  return closest.run;
}

/** The run of the merged mark under a pointer. */
export function mergedRunAt(/** @type {SVGSVGElement} */ plot, /** @type {MouseEvent} */ event) {
  const marks = [...plot.querySelectorAll(".merged")].flatMap((group) => marksOf.get(group) ?? []);
  const toScreen = plot.getScreenCTM();
  if (marks.length === 0 || !toScreen) return undefined;
  const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(toScreen.inverse());
  return nearest(marks, x, y);
}
