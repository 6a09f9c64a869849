-- A metamodel takes moves between evaluations. `subchain` says where they ended: JSON of its parameters, the gain of the
-- metamodel's log-likelihood and the counts of moves; the row's theta is that end, and `fitted` is empty where no move was
-- accepted and nothing had to be evaluated. `coarse`: the quasi-static model's values of the fitted measurements.
ALTER TABLE evaluations ADD COLUMN subchain TEXT CHECK (subchain IS NULL OR json_valid(subchain));
ALTER TABLE evaluations ADD COLUMN coarse BLOB;
