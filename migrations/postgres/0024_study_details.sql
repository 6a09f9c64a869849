-- As in SQLite.
ALTER TABLE studies ADD COLUMN details TEXT CHECK (details IS NULL OR is_json(details));
ALTER TABLE calibrations ADD COLUMN withdrawn_at_ms BIGINT;
