#!/usr/bin/env bash
# All shards by GNU parallel, on the cores of this machine or those of --sshlogin:
#   experiments/launch/parallel.sh EXPERIMENT SHARDS DIR [OPTION OF PARALLEL...]
# The same command again does what failed or is missing; DIR/joblog says which shard ran when, and for how long.
set -euo pipefail
experiment=$1 shards=$2 folder=$3
shift 3
mkdir -p "$folder"
seq "$shards" | parallel --joblog "$folder/joblog" --resume-failed "$@" \
  raytruth run "$experiment" -j 1 --shard "{}/$shards" -o "$folder"
