// Why a model refuses a condition, as words.

/** Kind and place of a reason, as the program counts them: `no_support: condition 3: `. */
const HEAD = /^[a-z_]+: (?:condition \d+: )?/;

/** The reason itself: `the soil carries at most 80 N of the 140 N wheel load`. */
export const reasonWords = (/** @type {string} */ reason) => reason.replace(HEAD, "");
