-- The place of a calibration in its study. Rows of earlier versions are filled by the program when it opens the store to write.
ALTER TABLE calibrations ADD COLUMN role TEXT CHECK (role IN ('sample', 'fit', 'search')); -- what it computes
ALTER TABLE calibrations ADD COLUMN parent INTEGER REFERENCES calibrations (id); -- whose model it changes, or searches; NULL of the first
ALTER TABLE calibrations ADD COLUMN change TEXT CHECK (json_valid(change)); -- how its job differs from its parent's; NULL of a search
-- Empty once the rows are filled, so that every start sees at a glance that they are.
CREATE INDEX calibrations_without_role ON calibrations (id) WHERE role IS NULL;
