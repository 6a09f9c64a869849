-- As in SQLite.
ALTER TABLE calibrations ADD COLUMN role TEXT CHECK (role IN ('sample', 'fit', 'search'));
ALTER TABLE calibrations ADD COLUMN parent BIGINT REFERENCES calibrations (id);
ALTER TABLE calibrations ADD COLUMN change TEXT CHECK (is_json(change));
-- Empty once the rows are filled, so that every start sees at a glance that they are.
CREATE INDEX calibrations_without_role ON calibrations (id) WHERE role IS NULL;
