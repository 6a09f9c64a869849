-- A job and where it stands. The evidence columns are filled when the sampler ends.
CREATE TABLE calibrations (
    id              INTEGER PRIMARY KEY,
    study           INTEGER NOT NULL REFERENCES studies (id),
    name            TEXT    NOT NULL,
    toml            TEXT    NOT NULL,                            -- job.toml
    files           TEXT    NOT NULL CHECK (json_valid(files)),  -- {name: text}
    state           TEXT    NOT NULL CHECK (state IN
                    ('queued', 'running', 'paused', 'waiting', 'finished', 'failed', 'cancelled')),
    message         TEXT,                                        -- why paused or failed
    model_version   TEXT,                                        -- pinned by the first lease
    created_at_ms   INTEGER NOT NULL,
    busy_ms         INTEGER NOT NULL DEFAULT 0,                  -- wall time spent, restarts left out
    log_evidence    REAL,
    log_evidence_se REAL,
    equilibrated    INTEGER CHECK (equilibrated IN (0, 1)),
    evaluations     INTEGER,
    rejected        INTEGER
);

CREATE INDEX calibrations_by_state ON calibrations (state);

-- A finished stage: the passage to a tempering exponent and the moves made there.
CREATE TABLE stages (
    calibration            INTEGER NOT NULL REFERENCES calibrations (id),
    stage                  INTEGER NOT NULL,
    tempering_exponent     REAL    NOT NULL CHECK (tempering_exponent BETWEEN 0 AND 1),
    acceptance             REAL    NOT NULL,
    drift_z                REAL    NOT NULL,
    correlation            REAL    NOT NULL,
    steps                  INTEGER NOT NULL,
    log_evidence_increment REAL    NOT NULL,
    weight_cov             REAL    NOT NULL,
    ess                    REAL    NOT NULL,
    scale                  REAL    NOT NULL,
    evaluations            INTEGER NOT NULL,
    equilibrated           INTEGER NOT NULL CHECK (equilibrated IN (0, 1)),
    PRIMARY KEY (calibration, stage)
) WITHOUT ROWID;

-- The population at the end of each stage. NULL log-likelihood = refused by the model.
CREATE TABLE samples (
    calibration    INTEGER NOT NULL REFERENCES calibrations (id),
    stage          INTEGER NOT NULL,
    particle       INTEGER NOT NULL,
    theta          TEXT    NOT NULL,
    log_likelihood REAL,
    log_prior      REAL    NOT NULL,
    PRIMARY KEY (calibration, stage, particle)
) WITHOUT ROWID;
