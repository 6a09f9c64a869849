-- As in SQLite.
ALTER TABLE calibrations ADD COLUMN role TEXT CHECK (role IN ('sample', 'fit', 'search'));
ALTER TABLE calibrations ADD COLUMN parent BIGINT REFERENCES calibrations (id);
ALTER TABLE calibrations ADD COLUMN change TEXT CHECK (is_json(change));
