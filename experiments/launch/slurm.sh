#!/usr/bin/env bash
# A task of a Slurm array, which does one shard. Nodes should have one kind of processor (--constraint):
#   sbatch --array=1-512 experiments/launch/slurm.sh EXPERIMENT 512 DIR
# The same command again does what is missing, as does --array=3,17 of these shards alone.
#SBATCH --job-name=raytruth --requeue
set -euo pipefail
raytruth run "$1" -j "${SLURM_CPUS_PER_TASK:-1}" --shard "$SLURM_ARRAY_TASK_ID/$2" -o "$3"
