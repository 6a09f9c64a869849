-- A study that is put away: not in lists, and deleted after a time where the operator says so.
ALTER TABLE studies ADD COLUMN archived_at_ms INTEGER;

-- A study that was deleted, with its last calibration and experiment: no number is given out again.
CREATE TABLE deletions (
    study            INTEGER PRIMARY KEY,
    last_calibration INTEGER NOT NULL,
    last_experiment  INTEGER NOT NULL,
    deleted_at_ms    INTEGER NOT NULL
);
