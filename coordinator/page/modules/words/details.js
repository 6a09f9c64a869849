// What people type about a study.

/** The tags of a text, which commas or semicolons separate; each once. */
export const tagsOf = (/** @type {string} */ text) => [
  ...new Set(
    text
      .split(/[,;]/)
      .map((tag) => tag.trim())
      .filter(Boolean),
  ),
];
