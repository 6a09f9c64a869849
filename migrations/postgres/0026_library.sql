CREATE TABLE library (
    name        TEXT   NOT NULL PRIMARY KEY,
    added_at_ms BIGINT NOT NULL,
    added_by    TEXT,
    found_in    BIGINT
);
