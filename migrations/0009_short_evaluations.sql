-- Only what is needed again is kept of an evaluation from here on: `theta` as little-endian f64, in place of JSON; `fitted` of
-- draws from the prior and where an engine is told values, else empty. Rows stored before stay as they are, and are read.
CREATE INDEX evaluations_by_rejection ON evaluations (calibration, substr(rejection, 1, instr(rejection, ':') - 1))
    WHERE rejection IS NOT NULL;
