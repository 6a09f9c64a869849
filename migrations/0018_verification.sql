-- The second worker that has reproduced the result; NULL: nobody has.
ALTER TABLE evaluations ADD COLUMN confirmed_by TEXT;
-- The fingerprint of a subchain's end covers more from here on: earlier ones cannot be compared.
UPDATE evaluations SET confirmed_by = '' WHERE subchain IS NOT NULL;

-- Workers that compute wrongly: two others agree on another answer, or the worker has answered in two ways.
CREATE TABLE quarantine (
    worker      TEXT    NOT NULL PRIMARY KEY,
    calibration INTEGER NOT NULL, -- with the evaluation, what shows it
    evaluation  INTEGER NOT NULL,
    at_ms       INTEGER NOT NULL
) WITHOUT ROWID;

-- Results that were dropped and computed again because their worker computes wrongly.
CREATE TABLE rewinds (
    calibration INTEGER NOT NULL REFERENCES calibrations (id),
    worker      TEXT    NOT NULL,
    results     INTEGER NOT NULL, -- of this worker, dropped
    at_ms       INTEGER NOT NULL,
    PRIMARY KEY (calibration, worker)
) WITHOUT ROWID;
