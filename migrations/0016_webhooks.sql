-- Where the pauses and ends of a study's calibrations are posted to; NULL: nowhere.
ALTER TABLE studies ADD COLUMN webhook TEXT;
