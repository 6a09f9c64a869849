-- The files that a finished study ends with, computed once. `stamp`: the build of the program and the members of the study; under
-- any other one they are computed again.
CREATE TABLE results (
    study INTEGER NOT NULL REFERENCES studies (id),
    name  TEXT    NOT NULL,
    stamp TEXT    NOT NULL,
    body  TEXT    NOT NULL,
    PRIMARY KEY (study, name)
);
