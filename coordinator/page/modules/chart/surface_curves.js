// The curves of a response surface in several pictures, which move together.

import { movingCurves } from "./moving_curves.js";
import { key, meanSetting, predict, ranges } from "../response_surface.js";

/** @typedef {import("../response_surface.js").ResponseSurface} ResponseSurface */
/** @typedef {import("../response_surface.js").Prediction} Prediction */

export class SurfaceCurves {
  /** @type {Set<(prediction: Prediction) => void>} */
  #pictures = new Set();

  constructor(/** @type {ResponseSurface} */ surface) {
    this.ranges = ranges(surface);
    this.prediction = predict(surface, meanSetting(surface));
  }

  /** The ends between which the value of a row moves; none without a surface. */
  rangeOf(/** @type {MeasuredRow} */ row) {
    return this.ranges.get(key(row)) ?? [];
  }

  /**
   * Adds curves to a picture.
   * @param {Parameters<typeof movingCurves>[0]} plot
   * @param {Parameters<typeof movingCurves>[1]} groups
   * @param {Parameters<typeof movingCurves>[2]} x
   * @param {number} scale from SI to the unit of the picture
   * @returns {() => void} removes them
   */
  attach(plot, groups, x, scale) {
    const draw = movingCurves(plot, groups, x);
    const picture = (/** @type {Prediction} */ { outputs, isBeyond }) =>
      draw((row) => {
        const output = outputs.get(key(row));
        return output === undefined ? undefined : output * scale;
      }, isBeyond);
    this.#pictures.add(picture);
    picture(this.prediction);
    return () => this.#pictures.delete(picture);
  }

  /** Moves the curves of all pictures. */
  move(/** @type {Prediction} */ prediction) {
    this.prediction = prediction;
    for (const picture of this.#pictures) picture(prediction);
  }
}
