-- New rows describe their observables (coordinator/store/src/blob.rs); older programs would misread them, and this number keeps these
-- programs out. No table changes: rows of before are read as they are.
SELECT 1;
