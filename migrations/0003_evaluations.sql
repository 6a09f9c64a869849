-- Every simulated parameter vector. Sampling counts from 0; the final draws, simulated on all runs with
-- the holdout, count from 2^40.
CREATE TABLE evaluations (
    calibration    INTEGER NOT NULL REFERENCES calibrations (id),
    evaluation     INTEGER NOT NULL,
    theta          TEXT    NOT NULL,
    log_likelihood REAL,             -- NULL: refused, or not scored (final draws)
    rejection      TEXT,             -- why the model refused
    fitted         BLOB,             -- sampling: the model's values of the fitted measurements
    observables    BLOB,             -- final draws: everything
    fingerprint    INTEGER NOT NULL, -- of the whole result; a second computation must agree
    worker         TEXT    NOT NULL,
    PRIMARY KEY (calibration, evaluation),
    CHECK ((rejection IS NOT NULL) + (fitted IS NOT NULL) + (observables IS NOT NULL) = 1)
) WITHOUT ROWID;

-- A failed attempt: a machine's fault, never a fact about the parameters.
CREATE TABLE faults (
    id          INTEGER PRIMARY KEY,
    calibration INTEGER NOT NULL REFERENCES calibrations (id),
    evaluation  INTEGER NOT NULL,
    attempt     INTEGER NOT NULL,
    worker      TEXT    NOT NULL,
    message     TEXT    NOT NULL,
    at_ms       INTEGER NOT NULL
);

CREATE INDEX faults_by_evaluation ON faults (calibration, evaluation);

-- Starts of the coordinator: by the clock [s since 2026], but growing in any case; the upper part of every lease
-- number given out since.
CREATE TABLE epochs (
    epoch         INTEGER PRIMARY KEY,
    started_at_ms INTEGER NOT NULL
);
