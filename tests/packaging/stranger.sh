#!/usr/bin/env bash
# The way of somebody who installs sinew and makes a figure of a robot of their own, with nothing but what is installed.
#
#   stranger.sh BUILD WORK COMPILER
set -euo pipefail
build=$1 work=$2 compiler=$3
prefix=$work/prefix
rm -rf -- "$work"
mkdir -p "$work/home" "$work/desk"
cmake --install "$build" --prefix "$prefix" >"$work/install.log"
cd -- "$work/desk"
export HOME=$work/home PATH=$prefix/bin:$PATH
unset CDPATH

fail() { printf 'FAILED: %s\n' "$*" >&2; exit 1; }
# says WHAT PATTERN COMMAND...: the command succeeds and prints a line that matches.
says() {
  local what=$1 pattern=$2 text
  shift 2
  text=$("$@" 2>&1) || fail "$what: '$*' ended with $?: $text"
  grep -qE -- "$pattern" <<<"$text" || fail "$what: '$*' does not print '$pattern' but: $text"
}
is_svg() { [[ $(head -c 300 "$1") == *"<svg"* ]] || fail "$1 is no SVG"; }

says "the version" '^sinew [0-9]+\.[0-9]+' sinew --version
says "help names its commands" 'inverse' sinew --help
says "what there is" '3-rfr' sinew list

# A robot of one's own of every kind: it reads, it is drawn.
kinds=$({ sinew new || true; } 2>&1 | sed -n 's/^\([0-9a-zA-Z-]\+\)  .*/\1/p' | grep -vxE 'kind|study|scene')
count=0
for kind in $kinds; do
  sinew new "$kind" >"$kind.yaml"
  says "check of $kind" 'inputs|sections' sinew check "$kind.yaml"
  sinew plot "$kind.yaml" -o "$kind.svg" -q
  is_svg "$kind.svg"
  count=$((count + 1))
done
((count >= 15)) || fail "only $count kinds: $kinds"

# One of them changed, checked, asked, drawn for a paper.
sed 's/name: .*/name: mine/; s/length: 200 mm/length: 180 mm/' 3-RFR.yaml >mine.yaml
cmp -s 3-RFR.yaml mine.yaml && fail "the file did not change"
says "own robot" '^mine: planar parallel robot, 3 legs, 3 inputs' sinew check mine.yaml
says "inverse" 'legs\[0\]\.tendon_1 +[0-9.]+' sinew inverse mine.yaml --pose "5 mm, -5 mm, 5 deg"
inputs=$(sinew inverse mine.yaml --pose "5 mm, -5 mm, 5 deg" | awk '/^legs.*\.tendon_1/ { printf "%s%s mm", sep, $2; sep = ", " }')
says "and back" '^ *(5\.000|4\.999)' sinew forward mine.yaml --inputs "$inputs" --start "4 mm, -4 mm, 4 deg"
sinew plot mine.yaml --pose "5 mm, -5 mm, 5 deg" --width 85mm --font Times -o mine.svg -q
is_svg mine.svg
sinew map mine.yaml --x "-50 mm:50 mm:21" --y "-50 mm:50 mm:21" --phi 0 -o map.csv -q
sinew plot map.csv --as contour --value inverse_condition --width 85mm -o map.svg -q
is_svg map.svg

# A study, its result, its figure.
sinew new study >study.yaml
says "check of a study" 'samples' sinew check study.yaml
sinew sweep study.yaml -o result.csv -q
[[ $(grep -vc '^#' result.csv) -gt 2 ]] || fail "the sweep wrote no samples"
sinew reproduce tdpcr/fig9 -o figures >reproduce.txt
is_svg "$(find figures -name '*.svg' | head -n 1)"

# The page's server: a robot's answer over HTTP, or how to get the page.
sinew serve mine.yaml --port 0 >serve.log 2>&1 &
server=$!
trap 'kill $server 2>/dev/null || true' EXIT
for _ in $(seq 100); do grep -q 'http://' serve.log && break; sleep 0.1; done
address=$(grep -oE 'http://[0-9.]+:[0-9]+' serve.log | head -n 1)
[[ -n $address ]] || fail "serve tells no address: $(cat serve.log)"
python3 - "$address" <<'P'
import sys, urllib.request
with urllib.request.urlopen(sys.argv[1] + "/") as page:
    text = page.read().decode()
assert page.status == 200 and "sinew" in text, text[:300]
P
kill -INT $server
wait $server || true

# Texts for the shell and for man.
bash -c ". '$prefix'/share/bash-completion/completions/sinew && complete -p sinew" >/dev/null || fail "no completion"
grep -q '^\.SH' "$prefix/share/man/man1/sinew.1" || fail "no man page"

# The README's lines of C++, with the installed package.
readme=$(find "$prefix/share/doc" -name README.md | head -n 1)
mkdir -p program
{
  printf '#include <sinew/sinew.hpp>\n#include <cstdio>\nint main() {\n'
  sed -n '/^```cpp$/,/^```$/{/^```/!p}' "$readme"
  printf '}\n'
} >program/main.cpp
cat >program/CMakeLists.txt <<'C'
cmake_minimum_required(VERSION 3.25)
project(mine CXX)
find_package(sinew REQUIRED)
add_executable(mine main.cpp)
target_link_libraries(mine PRIVATE sinew::sinew)
C
cmake -S program -B program/build -D CMAKE_CXX_COMPILER="$compiler" -D CMAKE_PREFIX_PATH="$prefix" >program/log 2>&1 || { cat program/log; fail "configure"; }
cmake --build program/build >>program/log 2>&1 || { cat program/log; fail "build"; }
says "the README's program" '^x 12\.079 mm' program/build/mine
says "the README's program" '^unreachable: ' program/build/mine
echo "$count kinds of robots, a figure of one's own, a map, a study, a reproduced figure, a page, ten lines of C++"
