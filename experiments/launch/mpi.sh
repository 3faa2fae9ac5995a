#!/usr/bin/env bash
# A rank of mpirun, which does every shard that its number gives:
#   mpirun -n 128 experiments/launch/mpi.sh EXPERIMENT SHARDS DIR
# A rank that dies ends the whole job; the same command again does what is missing.
set -euo pipefail
rank=${OMPI_COMM_WORLD_RANK:-${PMI_RANK:-${SLURM_PROCID:?is set by no launcher of MPI: start this by mpirun or srun}}}
ranks=${OMPI_COMM_WORLD_SIZE:-${PMI_SIZE:-$SLURM_NTASKS}}
for ((shard = rank + 1; shard <= $2; shard += ranks)); do
  raytruth run "$1" -j 1 --shard "$shard/$2" -o "$3"
done
