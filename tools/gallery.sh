#!/usr/bin/env bash
# Draws the pictures of the README, docs/images/gallery-*.png, with the command and gnuplot: one row for each family of
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

# A figure and, in its script, the size of a picture in a row and a title for a reader.
tile() {  # NAME SIZE TITLE ARGUMENTS...
  local name=$1 size=$2 title=$3
  shift 3
  "$sinew" "$@" -q -o "$name.svg" >/dev/null
  sed -E -e "s/set terminal svg noenhanced size [0-9]+,[0-9]+ dynamic font '[^']*'/set terminal pngcairo noenhanced size $size font 'sans,10'/" \
    -e "s/^( *set output ').*/\1$name.png'/" -e '$d' \
    -e "s/set multiplot layout ([0-9]+,[0-9]+) title '[^']*'/set multiplot layout \1 title '$title'/" "$name.gp" >tile.gp
  gnuplot tile.gp
}

row() {  # NAME WIDTH HEIGHT TILE...: tiles side by side
  local name=$1 width=$2 height=$3 x=0
  shift 3
  {
    echo "set terminal pngcairo size $((width * $#)),$height background '#ffffff'"
    echo "set output '$out/gallery-$name.png'"
    echo "unset border; unset tics; unset key; set margins 0,0,0,0; set size ratio -1; set lmargin 0"
    echo "set xrange [0:$((width * $#))]; set yrange [0:$height]"
    printf 'plot '
    for tile; do
      printf "'%s.png' binary filetype=png origin=(%d,0) with rgbimage, " "$tile" "$x"
      x=$((x + width))
    done
    echo 'NaN'
  } >row.gp
  gnuplot row.gp
}

tile serial-bent 480,480 "five sections, fifteen tendons" plot nottingham-tpcj \
  --configuration "12 deg, 5 deg; 0, -14 deg; -10 deg, 4 deg" --view "70 deg, 20 deg"
tile serial-section 480,480 "the bends that three tendons allow" plot nottingham-tpcj --section 0 --changes "-1.1 mm, 2 mm, -0.5 mm"
row serial 480 480 serial-bent serial-section

tile planar 480,480 "3-RFR" plot 3-rfr --pose "10 mm, -5 mm, 10 deg"
tile spatial 480,480 "6-UFS" plot 6-ufs --as 3d
row tendons 480 480 planar spatial

tile tripod 480,480 "flexible tripod 3PFS" plot 3pfs-g2 --as 3d --independent "0.4 m, 0.12, 0.05"
tile hexapod 480,480 "six clamped rods" plot hexapod --as 3d --pose "20 mm, 0, 450 mm, 0, 20 deg, 0"
row rods 480 480 tripod hexapod

tile map 480,480 "3-RFR: inverse condition, red: singular" map 3-rfr --x "-60 mm : 60 mm : 61" --phi "0 deg : 90 deg : 91"
tile branches 960,480 "equilibria of a tripod pressed down" branches 3pfs-g2 --independent "400 mm, 0.05, 0" \
  --to-wrench "0, 0, -100 N, 0, 0, 0" --range "0, 2"
row map 480 480 map
row branches 960 480 branches
