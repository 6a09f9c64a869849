-- Further runs join a study: a calibration may be about an enlarged experiment. NULL: the experiment of its study.
ALTER TABLE calibrations ADD COLUMN experiment INTEGER REFERENCES experiments (id);
