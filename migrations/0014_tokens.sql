-- Who may use the service. A revoked token stays: a store that has had one never becomes open to everybody again.
CREATE TABLE tokens (
    id INTEGER PRIMARY KEY,
    name TEXT NOT NULL,
    role TEXT NOT NULL CHECK (role IN ('read', 'submit', 'work')),
    -- SHA-256 of the token, which is kept nowhere.
    hash BLOB NOT NULL CHECK (length(hash) = 32),
    created_at_ms INTEGER NOT NULL,
    revoked_at_ms INTEGER
);
CREATE UNIQUE INDEX tokens_in_use ON tokens (name) WHERE revoked_at_ms IS NULL;
