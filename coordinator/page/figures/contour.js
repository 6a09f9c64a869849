// Contours of a function on a grid: marching squares, with straight lines between the crossings of cell edges.

/** The rings around everything above a level; points are in the units of the grid. The function is 0 beyond the grid. */
export function rings([xs, ys], values, level) {
  const padded = (list) => [list[0], ...list, list[list.length - 1]];
  const [x, y] = [padded(xs), padded(ys)];
  const value = (i, j) => values[j - 1]?.[i - 1] ?? 0;
  const crossings = new Map();
  const next = new Map();
  // Ids of the edges of a cell, in order around it: below, right, above, left.
  const edges = (i, j) => [`h${i},${j}`, `v${i + 1},${j}`, `h${i},${j + 1}`, `v${i},${j}`];
  const cross = (id, [i, j], [k, l]) => {
    const [a, b] = [value(i, j), value(k, l)];
    const share = (level - a) / (b - a);
    crossings.set(id, [x[i] + share * (x[k] - x[i]), y[j] + share * (y[l] - y[j])]);
  };
  const link = (from, to) => {
    for (const [a, b] of [[from, to], [to, from]]) {
      next.set(a, [...(next.get(a) ?? []), b]);
    }
  };
  for (let j = 0; j + 1 < y.length; j += 1) {
    for (let i = 0; i + 1 < x.length; i += 1) {
      const corners = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
      const above = corners.map(([a, b]) => value(a, b) >= level);
      const ids = edges(i, j);
      const crossed = [0, 1, 2, 3].filter((k) => above[k] !== above[(k + 1) % 4]);
      for (const k of crossed) cross(ids[k], corners[k], corners[(k + 1) % 4]);
      if (crossed.length === 2) link(ids[crossed[0]], ids[crossed[1]]);
      if (crossed.length === 4) {
        // A saddle: the middle decides which corners hang together.
        const middle = corners.reduce((sum, [a, b]) => sum + value(a, b), 0) / 4;
        const together = (middle >= level) === above[0];
        link(ids[0], ids[together ? 1 : 3]);
        link(ids[2], ids[together ? 3 : 1]);
      }
    }
  }
  return follow(crossings, next);
}

/** Joins linked crossings to closed rings. */
function follow(crossings, next) {
  const found = [];
  const seen = new Set();
  for (const start of next.keys()) {
    if (seen.has(start)) continue;
    const ring = [];
    let at = start;
    while (at !== undefined) {
      seen.add(at);
      ring.push(crossings.get(at));
      at = next.get(at).find((id) => !seen.has(id));
    }
    found.push(ring);
  }
  return found;
}
