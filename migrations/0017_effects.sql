-- An effect that a user has added to the catalogue. A version is never changed: another text under the name is the next one.
CREATE TABLE effects (
    name          TEXT NOT NULL,
    version       INTEGER NOT NULL,
    text          TEXT NOT NULL,
    -- SHA-256 of the text, in hexadecimal digits.
    digest        TEXT NOT NULL,
    created_at_ms INTEGER NOT NULL,
    -- The name of the token, where one was sent.
    created_by    TEXT,
    PRIMARY KEY (name, version),
    UNIQUE (name, digest)
);
