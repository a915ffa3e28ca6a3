#!/bin/sh
# gnu_parallel.sh MANIFEST OUT SHARDS [PARALLEL OPTIONS]: the shards of a batch by GNU parallel, one at a
# time a host, each with all its cores; then the merge. The same command again does what is missing.
set -eu
manifest=$1 out=$2 shards=$3
shift 3
program=${PROGRAM:-MMMConverterS2KF}

# A shard of a lost host runs again, on another one. The merge says what failed or is missing.
seq "$shards" | parallel --jobs 1 --retries 3 "$@" --quote \
  "$program" batch "$manifest" -o "$out" --resume --shard "{}/$shards" || true
exec "$program" batch "$manifest" -o "$out" --merge
