-- As in SQLite.
CREATE TABLE emulators (
    calibration BIGINT NOT NULL PRIMARY KEY REFERENCES calibrations (id),
    record      TEXT   NOT NULL CHECK (is_json(record))
);
