-- What a search for a missing effect found; the search is a calibration whose algorithm is discovery.
CREATE TABLE discoveries (
    calibration INTEGER NOT NULL PRIMARY KEY REFERENCES calibrations (id),
    record      TEXT    NOT NULL CHECK (json_valid(record))
);
