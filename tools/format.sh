#!/usr/bin/env bash
# Formats the C++ sources, or with --check prints what would change and fails.
# (clang-format --dry-run is of no use here: version 14 reports every `namespace a::inline b` as a change.)
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
format=$(command -v clang-format-14 || command -v clang-format)

sources() {
  git -c safe.directory="$PWD" ls-files -z --cached --others --exclude-standard -- '*.hpp' '*.h' '*.cpp' 2>/dev/null ||
    find include src kernel firmware cli tests benchmarks examples \( -name '*.[hc]pp' -o -name '*.h' \) -print0
}

if [[ ${1-} == --check ]]; then
  # shellcheck disable=SC2016
  changes=$(sources | xargs -0r -n 1 bash -c '"$0" "$1" | diff -u --label "$1" --label formatted "$1" -' "$format" || true)
  [[ -z $changes ]] && exit 0
  head -n 60 <<<"$changes"
  echo "$(grep -c '^--- ' <<<"$changes") files are not formatted: run tools/format.sh"
  exit 1
fi
sources | xargs -0r "$format" -i
