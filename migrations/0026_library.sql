-- An effect that is a candidate of every later search. Its file is the last version in effects.
CREATE TABLE library (
    name        TEXT NOT NULL PRIMARY KEY,
    added_at_ms INTEGER NOT NULL,
    -- The name of the token, where one was sent.
    added_by    TEXT,
    -- The study whose search found the law, and whose evidence therefore does not count for it; NULL of one that was written.
    found_in    INTEGER
);
