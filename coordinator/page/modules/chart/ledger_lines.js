// The lines of a study's error ledger with the names and colours that pictures and tables give them.

import { t } from "../language/language.js";
import { modelName } from "../words/model.js";
import { colour } from "./colour.js";

/**
 * The lines of the ledger with their names and colours.
 * @returns {(import("../words/ledger.js").LedgerLine & { colour: string })[]}
 */
export function ledgerLines(/** @type {Study} */ study) {
  return study.ledger.map((line, k) => {
    const member = study.members.find((m) => m.id === line.calibration);
    return {
      id: line.calibration,
      name: member ? modelName(study, member) : t`calibration ${line.calibration}`,
      effects: member?.effects ?? line.effects,
      colour: colour(k),
      line,
    };
  });
}
