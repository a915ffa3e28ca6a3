#!/bin/sh
# SPDX-License-Identifier: MIT
# install_packages.sh run|test|full|ci: Debian 12's packages, each level with those before it.
#   run    what builds the program, and what its pages contain
#   test   what the preset dev needs
#   full   what the preset full needs: Python, browser, clusters, packaging, benchmarks
#   ci     what .ci/run needs besides
# As root or with sudo; where all are there already, neither is needed.
set -eu

run='cmake ninja-build g++ libassimp-dev libeigen3-dev libboost-filesystem-dev libboost-program-options-dev libfmt-dev libspdlog-dev
  libtbb-dev libtinyxml2-dev liburdfdom-dev libxxhash-dev nlohmann-json3-dev libzmq3-dev cppzmq-dev zlib1g-dev libjs-dygraphs
  libjs-three'
test='libgtest-dev libgmock-dev libsimbody-dev libxml2-utils liburdfdom-tools gnuplot-nox groff-base'
full='pybind11-dev python3-dev python3-numpy python3-matplotlib libbenchmark-dev libmujoco-dev chromium chromium-driver python3-selenium
  poppler-utils pkg-config dpkg-dev python3-venv python3-pip python3-setuptools python3-wheel slurm-wlm munge parallel snakemake'
ci='git mypy clang-14 clang-format-14 clang-tidy-14 doxygen python3-sphinx'

case "${1-}" in
  run) packages=$run ;;
  test) packages="$run $test" ;;
  full) packages="$run $test $full" ;;
  ci) packages="$run $test $full $ci" ;;
  *) sed -n 's/^# //p' "$0" >&2; exit 2 ;;
esac

missing=
for package in $packages; do
  case "$(dpkg-query -W -f '${Status}' "$package" 2> /dev/null)" in
    *' installed') ;;
    *) missing="$missing $package" ;;
  esac
done
[ -n "$missing" ] || exit 0
if [ "$(id -u)" = 0 ]; then
  sudo=
elif command -v sudo > /dev/null; then
  sudo=sudo
else
  echo "install_packages.sh: neither root nor sudo; ask for$missing" >&2
  exit 1
fi
# shellcheck disable=SC2086
$sudo apt-get update -q && $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends $missing
