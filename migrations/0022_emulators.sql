-- What a sampler on an emulator found about it: its batches, its final draws, the scatter of the model.
CREATE TABLE emulators (
    calibration INTEGER NOT NULL PRIMARY KEY REFERENCES calibrations (id),
    record      TEXT    NOT NULL CHECK (json_valid(record))
);
