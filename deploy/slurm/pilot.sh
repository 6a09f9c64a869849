#!/bin/sh
# A worker as a job of Slurm: sbatch --array=0-9 --cpus-per-task=4 deploy/slurm/pilot.sh
# `coordinator scale slurm` submits it by itself. What it reads from the environment stands in site.env.
#
# A job that a failing node or a more urgent job has ended begins anew. A killed worker loses nothing but its last seconds.
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=grouser-%A_%a.log
# One task: it is bound to the cores that it has asked for, where the site binds tasks.
#SBATCH --ntasks=1
# USR1 comes 30 s before the time limit: the worker gives back what it has not finished, and ends with 0.
#SBATCH --signal=B:USR1@30

if [ -n "${GROUSER_MODULES:-}" ]; then
    # shellcheck disable=SC2086 # several names between spaces
    module load $GROUSER_MODULES
fi
# One thread on each core of the job; nine tenths of its memory, where the site limits it.
export GROUSER_THREADS="${SLURM_CPUS_PER_TASK:-1}"
memory_mb="${SLURM_MEM_PER_NODE:-$((${SLURM_MEM_PER_CPU:-0} * GROUSER_THREADS))}"
if [ "$memory_mb" -gt 0 ]; then
    export GROUSER_MAX_MEMORY_MB="${GROUSER_MAX_MEMORY_MB:-$((memory_mb * 9 / 10))}"
fi
# The shell gives way to the worker, which then gets the signals.
# shellcheck disable=SC2086 # a command with its arguments
exec ${GROUSER_CONTAINER:-} "${GROUSER_WORKER:-worker}"
