#!/usr/bin/env bash
# Installs what is missing, builds the library and the command, and runs them.
#
#   ./run.sh                 inverse kinematics of a robot and a figure of a paper, into out/
#   ./run.sh ARGUMENTS...    the sinew command, e.g. ./run.sh forward ROBOT --json
#   ./run.sh serve ROBOT     the viewer in a browser; installs Node where it is missing
#   ./run.sh octave          the module of Octave, into build/octave; installs Octave where it is missing
#   ./run.sh wheel           the Python module with the command, a wheel in build/wheel: pip install build/wheel/*.whl
#   ./run.sh --yes ...       the same, and installs packages without asking
set -euo pipefail
caller=$PWD
root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
cd -- "$root"
# shellcheck source=tools/packages.sh
source tools/packages.sh

yes=0
if [[ ${1-} == --yes ]]; then
  yes=1
  shift
fi

with_page=0
with_octave=0
sinew=build/release/bin/sinew
stamp=build/release/.built  # as old as the start of the last build that succeeded

up_to_date() {
  local -a inputs=()
  local input
  [[ -x $sinew && -e $stamp ]] || return 1
  ((!with_page)) || grep -q '^SINEW_WEB:BOOL=ON' build/release/CMakeCache.txt || return 1
  ((!with_octave)) || grep -q '^SINEW_OCTAVE:STRING=ON' build/release/CMakeCache.txt || return 1
  for input in CMakeLists.txt CMakePresets.json cmake kernel include src server cli robots studies octave \
    web/src web/index.html web/build.mjs web/package-lock.json; do
    if [[ -e $input ]]; then inputs+=("$input"); fi
  done
  [[ -z $(find "${inputs[@]}" -newer "$stamp" -print -quit) ]]
}

need_packages "$yes" "${build_packages[@]}"
if [[ ${1-} == serve ]]; then  # the page needs more to be built; once built it stays
  need_packages "$yes" "${web_packages[@]}"
  with_page=1
fi
if [[ ${1-} == octave ]]; then
  need_packages "$yes" "${octave_packages[@]}"
  with_octave=1
fi
if [[ ${1-} == wheel ]]; then
  need_packages "$yes" "${python_packages[@]}"
  page=ON
  if [[ ! -e web/node_modules/.package-lock.json ]] || ! command -v node >/dev/null; then
    page=OFF
    say "The wheel's command is without the viewer's page; for it, run ./run.sh serve once before."
  fi
  build_preset wheel -D SINEW_WEB=$page
  python3 tools/wheel.py build/wheel build/wheel
  exit
fi
if ! up_to_date; then
  mkdir -p build/release
  exec 9>build/release/.lock
  flock 9
  if ! up_to_date; then  # another run may just have built it
    touch build/release/.started
    # shellcheck disable=SC2086
    build_preset release ${SINEW_CMAKE_ARGUMENTS-} $( ((with_page)) && echo -D SINEW_WEB=ON) \
      $( ((with_octave)) && echo -D SINEW_OCTAVE=ON)
    mv build/release/.started "$stamp"
  fi
  exec 9>&-
fi

if ((with_octave)); then
  mkdir -p build/octave
  cp build/release/octave/*.m build/release/octave/sinew_mex.mex build/octave/
  echo "In Octave, or in ~/.octaverc for every session:"
  echo "  addpath (\"$root/build/octave\")"
  echo "Then for example:"
  echo "  r = sinew (\"3pfs-g2\"); a = r.forward ([0.44 0.42 0.41]); a.pose.position"
  exit
fi
if (($#)); then
  cd -- "$caller"
  exec "$root/$sinew" "$@"
fi

pose="10 mm, -5 mm, 10 deg"
echo "Inverse kinematics of the planar robot 3-RFR, platform at ($pose):"
"$sinew" inverse robots/3-rfr.yaml --pose "$pose"
echo
echo "Figure 9 of [TDPCR], computed again:"
mkdir -p out
touch -d '1 second ago' build/release/.job
"$sinew" reproduce tdpcr/fig9 -o out
echo
echo "Its workspace, a sweep over 88 837 poses:"
"$sinew" sweep 3-rfr-workspace --force -o out/3-rfr-workspace.h5
"$sinew" plot out/3-rfr-workspace.h5 --as contour --value reached -o out/3-rfr-workspace.svg
echo
echo "Figures:"
find "$root/out" -type f \( -name '*.svg' -o -name '*.png' -o -name '*.pdf' \) -newer build/release/.job |
  LC_ALL=C sort | sed 's/^/  /'
cat <<'TEXT'
Try next:
  ./run.sh analyse robots/3-rfr.yaml --pose "10 mm, -5 mm, 10 deg"
  ./run.sh reproduce tdpcr -o out
  ./run.sh sweep --list
  ./run.sh --help
TEXT
