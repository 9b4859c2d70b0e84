#!/usr/bin/env bash
# Draws the pictures of the README, docs/images/gallery-*.png, of docs/tour.md and docs/scenes.md, with the command and gnuplot: one row for each family of
# robots, one with what is computed of them. The page's picture is docs/images/page.png.
#
#   tools/gallery.sh [FOLDER OF THE COMMAND, default build/dev/bin] [OUTPUT FOLDER, default docs/images]
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
sinew=$(realpath "${1:-build/dev/bin}/sinew")
out=$(realpath "${2:-docs/images}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd -- "$work"

# A figure as wide as WIDTH on paper.
tile() {  # NAME WIDTH ARGUMENTS...
  local name=$1 width=$2
  shift 2
  "$sinew" "$@" --width "$width" -q -o "$name.png" >/dev/null
}

size_of() { python3 -c 'import struct, sys; print(*struct.unpack(">II", open(sys.argv[1], "rb").read(24)[16:]))' "$1"; }

row() {  # NAME TILE...: tiles side by side, their tops on one line
  local name=$1 tile wide high width=0 height=0 x=0
  shift
  for tile; do
    read -r wide high < <(size_of "$tile.png")
    width=$((width + wide)) height=$((high > height ? high : height))
  done
  {
    echo "set terminal pngcairo size $width,$height background '#ffffff'"
    echo "set output '$out/gallery-$name.png'"
    echo "unset border; unset tics; unset key; set lmargin 0; set rmargin 0; set tmargin 0; set bmargin 0"
    echo "set xrange [0:$width]; set yrange [0:$height]"
    printf 'plot '
    for tile; do
      read -r wide high < <(size_of "$tile.png")
      printf "'%s.png' binary filetype=png origin=(%d,%d) with rgbimage, " "$tile" "$x" "$((height - high))"
      x=$((x + wide))
    done
    echo 'NaN'
  } >row.gp
  gnuplot row.gp
}

tile serial-bent 120mm plot --title "five sections, fifteen tendons" nottingham-tpcj \
  --configuration "12 deg, 5 deg; 0, -14 deg; -10 deg, 4 deg" --view "70 deg, 20 deg"
tile serial-section 120mm plot nottingham-tpcj --section 0 --changes "-1.1 mm, 2 mm, -0.5 mm" --title "the bends that three tendons allow"
row serial serial-bent serial-section

tile arm 240mm plot two-segment --tensions "4 N, 0, 0; 0, 2 N, 0" --wrench "0.1 N, 0, 0, 0, 0, 0" \
  --title "two sections, six tendons, a force of 0.1 N at the tip"
row arms arm

tile planar 120mm plot 3-rfr --pose "10 mm, -5 mm, 10 deg" --title "3-RFR"
tile spatial 120mm plot 6-ufs --as 3d --title "6-UFS"
row tendons planar spatial

tile tripod 120mm plot 3pfs-g2 --as 3d --independent "0.4 m, 0.12, 0.05" --title "flexible tripod 3PFS"
tile hexapod 120mm plot hexapod --as 3d --pose "20 mm, 0, 450 mm, 0, 20 deg, 0" --title "six clamped rods"
row rods tripod hexapod

tile map 120mm map 3-rfr --x "-60 mm : 60 mm : 61" --phi "0 deg : 90 deg : 91"
tile branches 220mm branches 3pfs-g2 --independent "400 mm, 0.05, 0" \
  --to-wrench "0, 0, -100 N, 0, 0, 0" --range "0, 2"
row map map
row branches branches

# docs/arm-models.md: with the times of the run
"$sinew" reproduce truth/models -o . -q >/dev/null && cp truth/models.png "$out/arm-models.png"

# docs/tour.md: a tendon that rubs, pulled and let go
printf '%s\n' 'sections[1].tendons[0].tension[N]' 3 0.5 3 >pulls.csv
"$sinew" track two-segment --points pulls.csv --steps 50 --set 'sections.tendons[0].friction=0.3' -q -o loop.csv
tile loop 120mm plot loop.csv --x "sections[1].tendons[0].tension" --y y --title "one tendon of two-segment, friction 0.3"
cp loop.png "$out/tendon-loop.png"

# docs/scenes.md: where planning is built
if "$sinew" reproduce lsk/fig12 -o . -q >/dev/null; then cp lsk/fig12.png "$out/way-in.png"; fi
