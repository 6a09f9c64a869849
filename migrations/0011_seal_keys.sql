-- A random number of each calibration, drawn when it is stored. It seals the leases of this calibration; a later calibration that gets
-- the same id, in a copy or after a backup was put back, has another.
ALTER TABLE calibrations ADD COLUMN seal_key BLOB;

UPDATE calibrations SET seal_key = randomblob(16);
