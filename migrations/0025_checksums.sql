-- CRC-32 of the other columns but confirmed_by, which reading verifies; NULL in rows of before.
ALTER TABLE evaluations ADD COLUMN checksum INTEGER;
ALTER TABLE samples ADD COLUMN checksum INTEGER;
ALTER TABLE stages ADD COLUMN checksum INTEGER;
