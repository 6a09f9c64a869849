-- Two different answers to one evaluation, of which the first is stored. The same worker may have given both.
CREATE TABLE disputes (
    calibration INTEGER NOT NULL REFERENCES calibrations (id),
    evaluation  INTEGER NOT NULL,
    first       TEXT    NOT NULL, -- the worker whose answer is stored
    second      TEXT    NOT NULL, -- the worker whose answer differs
    at_ms       INTEGER NOT NULL,
    PRIMARY KEY (calibration, evaluation, second)
) WITHOUT ROWID;
