-- What people say of a study, as JSON: its name in the lists, its author, tags, a note; NULL: nothing.
ALTER TABLE studies ADD COLUMN details TEXT CHECK (details IS NULL OR json_valid(details));
-- When a calibration was taken out of its study, whose results are computed without it; NULL: it is part of it.
ALTER TABLE calibrations ADD COLUMN withdrawn_at_ms INTEGER;
