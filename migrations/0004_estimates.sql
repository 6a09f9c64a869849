-- The most probable parameters of a calibration that is a fit. NULL in `sd`: at a bound, or not fixed by anything.
CREATE TABLE estimates (
    calibration    INTEGER NOT NULL PRIMARY KEY REFERENCES calibrations (id),
    theta          TEXT    NOT NULL,
    log_likelihood REAL    NOT NULL,
    log_prior      REAL    NOT NULL,
    sd             TEXT    NOT NULL CHECK (json_valid(sd)),
    at_bound       TEXT    NOT NULL CHECK (json_valid(at_bound)),
    stop           TEXT    NOT NULL CHECK (stop IN ('decrease', 'step', 'budget'))
);
