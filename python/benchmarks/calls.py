#!/usr/bin/env python3
"""What a call from Python costs beyond the solve: beside the same questions in C, in the same run.

usage: PYTHONPATH=build/dev/python python3 python/benchmarks/calls.py [build/dev/bin/bench_python_calls]

Each figure is the smallest of several rounds, in which Python and C take turns: processor time, with two threads time.
"""
import json
import math
import subprocess
import sys
import time

import numpy

import sinew

ROUNDS = 7
LENGTHS = [0.44, 0.42, 0.41]
RODS, PLANAR = (0.42, 0.01), (0.19, 0.003)  # middle and radius of walks


def in_c(program, mode, robot, question, count, *more):
    done = subprocess.run([program, mode, robot, question, str(count), *map(str, more)], capture_output=True, text=True, check=True)
    return float(done.stdout)


def in_python(call, count, clock=time.process_time_ns):
    start = clock()
    for _ in range(count):
        call()
    return (clock() - start) / count


def walk(rows, middle, radius):
    """As in calls.c."""
    place = numpy.arange(3 * rows)
    return (middle + radius * numpy.sin(2 * math.pi * (place // 3) / rows + 2.0943951 * (place % 3))).reshape(rows, 3)


def least(one, other):
    """Smallest of both, measured by turns."""
    pairs = [(one(), other()) for _ in range(ROUNDS)]
    return min(pair[0] for pair in pairs), min(pair[1] for pair in pairs)


def line(what, ours, c, asked):
    print(f"{what:<66} {ours / 1e3:9.3f} us  C {c / 1e3:9.3f} us  over {(ours - c) / 1e3:7.3f} us  ratio {ours / c:5.2f}   {asked}")


def compare_rows(program, name, fields, count, walked, asked):
    question = json.dumps({"query": "forward", **fields})
    prepared = sinew.load(name).prepare("forward", **fields)
    rows = walk(count, *walked).tolist()
    at = iter(())

    def one():
        nonlocal at
        at = iter(rows)
        return in_python(lambda: prepared(next(at)), count)

    line(f"{name} forward, prepared, a row", *least(one, lambda: in_c(program, "one", name, question, count, *walked)), asked)


def compare_asked(program, name, what, fields, count, asked):
    robot = sinew.load(name)
    question = robot.forward(**fields)._question
    line(f"{name} forward, {what}", *least(lambda: in_python(lambda: robot.forward(**fields), count),
                                           lambda: in_c(program, "ask", name, question, count)), asked)


def compare_columns(program, robot, threads):
    rows = 10**6
    question = '{"query": "forward", "inputs": "$lengths", "path": "continue"}'
    prepared = robot.prepare("forward", inputs="$lengths", path="continue")
    inputs = walk(rows, *RODS)
    clock = time.process_time_ns if threads == 1 else time.perf_counter_ns
    out = {field["name"]: numpy.zeros((rows, *field["shape"])) for field in prepared.outputs}
    for what, more in (("", {}), (", into arrays that are there", {"out": out})):
        line(f"3pfs-g2 forward, a row of a million, {threads} thread{'s' * (threads > 1)}{what}",
             *least(lambda: in_python(lambda: prepared(inputs, threads=threads, **more), 1, clock) / rows,
                    lambda: in_c(program, "many", "3pfs-g2", question, rows, *RODS, threads)), "within 10 %")


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else "build/dev/bin/bench_python_calls"
    rods = sinew.load("3pfs-g2")
    compare_rows(program, "3pfs-g2", {"inputs": "$lengths", "path": "continue"}, 2000, RODS, "under 3 us over")
    compare_rows(program, "3-rfr", {"inputs": "$lengths"}, 5000, PLANAR, "under 3 us over")
    compare_asked(program, "3pfs-g2", "keywords", {"inputs": LENGTHS}, 1000, "under 8 us over")
    compare_asked(program, "3pfs-g2", "keywords, a load, a want",
                  {"inputs": LENGTHS, "wrench": [0.0, 0.0, -5.0, 0.1, 0.0, 0.0], "want": ["stiffness"]}, 1000, "under 8 us over")
    compare_asked(program, "3-rfr", "keywords", {"inputs": [0.19, 0.19, 0.188]}, 5000, "under 8 us over")
    answer = sinew.load("3-rfr").forward([0.19, 0.19, 0.188])
    one = min(in_python(lambda: sinew.Answer(answer.robot, "", answer.to_json()).pose.x, 2000) for _ in range(ROUNDS))
    print(f"{'3-rfr forward, first look at a field: the answer is read':<66} {one / 1e3:9.3f} us")
    for threads in (1, 2):
        compare_columns(program, rods, threads)


main()
