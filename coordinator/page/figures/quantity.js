// Units as people read them: lengths of a wheel's sinkage in millimetres, everything else in SI.

/** How values of a unit are shown: the unit, and shown value over SI value. */
export function shown(unit) {
  return unit === "m" ? { unit: "mm", scale: 1000 } : { unit, scale: 1 };
}
