-- The metamodel is gone: nothing reads or writes where its subchains ended, and what the quasi-static model gave. Finished
-- calibrations keep their evaluations, stages and samples.
ALTER TABLE evaluations DROP COLUMN subchain;
ALTER TABLE evaluations DROP COLUMN coarse;
