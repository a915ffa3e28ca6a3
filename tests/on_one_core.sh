#!/usr/bin/env bash
# on_one_core.sh PROGRAM [ARGUMENT...]: runs it on a core that no other test of this user has, if there is one. In the asan
# preset threads count the lines that run in the same memory: on two cores they take three times the processor time.
for ((core = 0; core < $(nproc --all); core++)); do
  exec 9> "${TMPDIR:-/tmp}/mmm_converter_test_core_${core}_$UID"
  if flock -n 9 && taskset -c -p "$core" $$ > /dev/null 2>&1; then exec "$@"; fi
done
exec 9>&- "$@"
