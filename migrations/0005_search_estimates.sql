-- A search by generations has an estimate, too: it ends for other reasons, knows no standard deviations (NULL in
-- place of the array), and keeps how it came there: [[evaluations, best, mean], ...], log-posteriors in nats, null
-- where the model took nobody. A search by steps has an empty history.
CREATE TABLE estimates_with_history (
    calibration    INTEGER NOT NULL PRIMARY KEY REFERENCES calibrations (id),
    theta          TEXT    NOT NULL,
    log_likelihood REAL    NOT NULL,
    log_prior      REAL    NOT NULL,
    sd             TEXT             CHECK (sd IS NULL OR json_valid(sd)),
    at_bound       TEXT    NOT NULL CHECK (json_valid(at_bound)),
    stop           TEXT    NOT NULL CHECK (stop IN ('decrease', 'step', 'budget', 'stagnation', 'generations')),
    history        TEXT    NOT NULL CHECK (json_valid(history))
);
INSERT INTO estimates_with_history
    SELECT calibration, theta, log_likelihood, log_prior, sd, at_bound, stop, '[]' FROM estimates;
DROP TABLE estimates;
ALTER TABLE estimates_with_history RENAME TO estimates;
