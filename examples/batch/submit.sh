#!/bin/sh
# submit.sh MANIFEST OUT SHARDS [SBATCH OPTIONS]: a batch as a Slurm job array, and a job that merges
# its shards once all have ended. Prints both job numbers. The same command again does what is missing.
set -eu
manifest=$1 out=$2 shards=$3
shift 3
program=${PROGRAM:-MMMConverterS2KF}

array=$(sbatch --parsable --array="1-$shards" "$@" \
  "$(dirname "$0")/slurm_array.sbatch" "$program" "$manifest" "$out" "$shards")
array=${array%%;*} # without the cluster's name
merge=$(sbatch --parsable --dependency="afterany:$array" "$@" --job-name=mmm_merge \
  --output=mmm_merge_%j.log --wrap="exec '$program' batch '$manifest' -o '$out' --merge")
echo "$array ${merge%%;*}"
