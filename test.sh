#!/usr/bin/env bash
# Installs what is missing, builds everything with warnings as errors, and runs the tests.
#
#   ./test.sh                all tests
#   ./test.sh -R kinematics  arguments go to ctest
#   GTEST_FILTER='Arc*' ./test.sh -R link    some tests of a layer
#   ./test.sh --yes ...      installs packages without asking
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")"
# shellcheck source=tools/packages.sh
source tools/packages.sh

yes=0
if [[ ${1-} == --yes ]]; then
  yes=1
  shift
fi

need_packages "$yes" "${build_packages[@]}" "${test_packages[@]}"
build_preset dev
exec ctest --preset dev -j4 --no-label-summary "$@"
