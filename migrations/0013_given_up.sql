-- Evaluations that were given up after faults have no worker; they are counted.
CREATE INDEX evaluations_given_up ON evaluations (calibration) WHERE worker = '';
