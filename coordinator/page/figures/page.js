// Puts the pictures into the page: every element with `data-figure` gets the figure of that name and number.

import { search, stages } from "./convergence.js";
import { errorDensity } from "./error_density.js";
import { history } from "./history.js";
import { populations } from "./populations.js";
import { posterior } from "./posterior.js";

/** The picture of a name and number, as markup. */
export function picture(figures, name, index) {
  switch (name) {
    case "search": return search(figures.searches[index]);
    case "stages": return stages(figures.stages);
    case "populations": return populations(figures.populations);
    case "posterior": return posterior(figures.posteriors[index]);
    case "history": return history(figures.histories[index]);
    case "error": return errorDensity(figures.errors[index]);
    default: throw new Error(`there is no figure ${name}`);
  }
}

/** Draws every figure of a document; the numbers stand in its element `figures`. */
export function draw(document) {
  const figures = JSON.parse(document.getElementById("figures-data").textContent);
  for (const place of document.querySelectorAll("[data-figure]")) {
    const { figure, index } = place.dataset;
    place.insertAdjacentHTML("afterbegin", picture(figures, figure, Number(index)));
  }
}
