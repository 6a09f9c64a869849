#!/bin/sh
# Makes runs.csv: the runs of plan.csv by the model of truth.toml, with the noise that experiment.toml declares. The rig has no cell for
# the lateral force: its column, the twelfth, stays empty.
set -e
cd "$(dirname "$0")"
sed 's/runs.csv/plan.csv/' experiment.toml > plan.toml
trap 'rm -f plan.toml' EXIT
"${WORKER:-worker}" simulate plan.toml --model truth.toml --parameters truth-parameters.toml --noise-seed 7 --out runs.csv
awk -F, -v OFS=, 'NR > 1 { $12 = "" } { print }' runs.csv > plan.toml
cat plan.toml > runs.csv
