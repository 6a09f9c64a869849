-- The files of a measured data set, as text; everything else is derived from them.
CREATE TABLE experiments (
    id            INTEGER PRIMARY KEY,
    toml          TEXT    NOT NULL,
    files         TEXT    NOT NULL CHECK (json_valid(files)),   -- {name: text}
    created_at_ms INTEGER NOT NULL
);

-- A line of calibrations on one experiment, each adding or dropping an effect.
CREATE TABLE studies (
    id         INTEGER PRIMARY KEY,
    experiment INTEGER NOT NULL REFERENCES experiments (id)
);
