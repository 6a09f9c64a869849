-- As in SQLite.
SELECT 1;
