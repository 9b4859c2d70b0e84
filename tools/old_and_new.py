#!/usr/bin/env python3
"""Times the operations of two builds against each other, in turn, and optionally counts their instructions.

usage: old_and_new.py [--pairs 15] [--instructions] [--only REGEX] [--seconds 0.2] OLD NEW

OLD and NEW are the `bin` folders of two Release builds that have the benchmarks (-D SINEW_BUILD_BENCHMARKS=ON), of which
bench_operations is run: old, new, old, new, ..., each for about the same time. A ratio above 1 says that the new one is
faster. With --instructions callgrind counts those of one operation, from the difference of two runs; its processor has
no AVX-512. Machines are noisy: the median of the pairs' ratios is what to read, beside the least and the greatest.
"""
import argparse
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

def program(folder):
    return str(folder / "bench_operations")


def names(folder):
    return subprocess.run([program(folder)], capture_output=True, text=True, check=True).stdout.split()


def nanoseconds(folder, name, count):
    """The processor's time of one operation, of `count` of them."""
    done = subprocess.run([program(folder), name, str(count)], capture_output=True, text=True, check=True)
    return float(done.stdout)


def calibrated(folder, name, seconds):
    count = 1
    while True:
        took = nanoseconds(folder, name, count) * count * 1e-9
        if took > seconds / 10:
            return max(1, round(count * seconds / took))
        count *= 10


def instructions(folder, name, count):
    """Of one operation: those of 2 * count less those of count, so that what goes before does not matter."""
    def total(times):
        with tempfile.TemporaryDirectory() as here:
            out = pathlib.Path(here) / "callgrind.out"
            subprocess.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", program(folder), name,
                            str(times)], capture_output=True, check=True)
            return int(re.search(r"^(?:summary|totals): (\d+)", out.read_text(), re.MULTILINE)[1])
    return (total(2 * count) - total(count)) / count


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pairs", type=int, default=15)
    parser.add_argument("--instructions", action="store_true")
    parser.add_argument("--only", default="", help="operations whose name matches this expression")
    parser.add_argument("--seconds", type=float, default=0.2, help="of one run")
    parser.add_argument("old", type=pathlib.Path)
    parser.add_argument("new", type=pathlib.Path)
    given = parser.parse_args()
    old, new = names(given.old), names(given.new)
    for name in sorted(set(old) ^ set(new)):
        print(f"{name}: only in the {'old' if name in old else 'new'} one", file=sys.stderr)
    print(f"{'operation':28s} {'old [ns]':>12s} {'new [ns]':>12s} {'old/new':>8s} {'least':>6s} {'most':>6s}  instructions")
    slower = 0
    for name in (name for name in old if name in new and re.search(given.only, name)):
        count = calibrated(given.old, name, given.seconds)
        pairs = [(nanoseconds(given.old, name, count), nanoseconds(given.new, name, count)) for _ in range(given.pairs)]
        ratios = sorted(a / b for a, b in pairs)
        ratio = statistics.median(ratios)
        counted = ""
        if given.instructions:
            few = max(1, count // 20)
            before, after = (instructions(folder, name, few) for folder in (given.old, given.new))
            counted = f"{before:.0f} -> {after:.0f} ({100 * (after / before - 1):+.1f} %)"
        slower += ratio < 0.95
        print(f"{name:28s} {statistics.median(a for a, _ in pairs):12.0f} {statistics.median(b for _, b in pairs):12.0f} "
              f"{ratio:8.3f} {ratios[0]:6.2f} {ratios[-1]:6.2f}  {counted}", flush=True)
    print(f"{slower} of them slower by more than 5 %")


if __name__ == "__main__":
    main()
