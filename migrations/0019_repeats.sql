-- How a model that is not ours answered what it was asked twice: the largest differences between two answers.
CREATE TABLE repeats (
    calibration     INTEGER NOT NULL PRIMARY KEY REFERENCES calibrations (id),
    evaluations     INTEGER NOT NULL, -- asked for twice
    differing       INTEGER NOT NULL, -- of these, answered in two ways
    refused         INTEGER NOT NULL, -- 1: an answer was a refusal the second time
    drawbar_pull_n  REAL    NOT NULL,
    torque_n_m      REAL    NOT NULL,
    sinkage_m       REAL    NOT NULL,
    lateral_force_n REAL    NOT NULL
);
