#!/usr/bin/env bash
# What the cores of `sinew export ROBOT --to verilog` take of an FPGA, as Yosys says: of a Spartan-6 and of an ECP5.
#
#     tools/fpga_cells.sh [SINEW [ROBOT...]]      default: the command of ./run.sh, and the serial robots of the papers
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."
sinew=${1-build/release/bin/sinew}
shift $(($# > 0))
(($#)) || set -- nottingham-tpcj nottingham-neutral four-tendon-tpcj four-tendon-neutral \
                 tests/data/fpga/unlike-sections.yaml

work=$(mktemp -d)
trap 'rm -rf -- "$work"' EXIT

# cells CORE COMMAND: Yosys' table of cells. Its pads of inputs and outputs are left out: a core is inside a design.
cells() {
  yosys -q -p "read_verilog $1; $2 -top $(basename "$1" .v); tee -o $work/stat stat" >"$work/log" 2>&1 || {
    cat "$work/log" >&2
    return 1
  }
  awk '
    $2 ~ /^[0-9]+$/ && NF == 2 {
      if ($1 ~ /^(LUT[1-6]|SRL16E)$/) luts += $2
      if ($1 ~ /^(FD[A-Z]+|TRELLIS_FF)$/) flip_flops += $2
      if ($1 ~ /^(CARRY4|CCU2C)$/) carries += $2
      if ($1 ~ /^(DSP48A1|MULT18X18D)$/) multipliers += $2
    }
    /Number of cells:/ { all = $NF }
    END { printf "%6d %6d %10d %7d %11d\n", all, luts, flip_flops, carries, multipliers }' "$work/stat"
}

printf '%-20s %-9s %6s %6s %10s %7s %11s\n' robot family cells LUTs flip-flops carries multipliers
for robot; do
  rm -f "$work"/*.v
  "$sinew" export "$robot" --to verilog -o "$work" --quiet
  core=$(ls "$work"/*_core.v)
  name=$(basename "$robot" .yaml)
  printf '%-20s %-9s %s\n' "$name" Spartan-6 "$(cells "$core" 'synth_xilinx -flatten -noiopad -family xc6s')"
  printf '%-20s %-9s %s\n' "$name" ECP5 "$(cells "$core" synth_ecp5)"
done
