#!/usr/bin/env python3
"""Asks two builds the same random questions about loaded robots and tells where their answers differ.

usage: same_answers.py [--questions 2000] [--seed 1] [--tolerance 1e-8] OLD NEW

OLD and NEW are `sinew` commands. Questions are statics, forward and inverse of rods and of pseudo-rigid chains under
random forces and moments, most of what their robots bear, some of far more. Told are: another status, and numbers that
differ by more than the tolerance of the largest in their list, or are gone; fields that only the new build has,
iteration counts and residuals are not compared.
"""
import argparse
import collections
import json
import random
import subprocess
import sys

ROBOTS = {  # largest force [N] and moment [N m]
    "3pfs-g1": (60, 3), "3pfs-g2": (60, 3), "hexapod": (8, 0.5), "hexapod-torsion": (4, 0.3), "2prs-1pfs": (30, 2),
    "6pfs": (20, 1), "3-rfr": (0.6, 0.02), "3-frr": (0.6, 0.02), "6-ufs": (0.6, 0.03),
}
LENGTHS = {"3pfs-g1": [0.43] * 3, "3pfs-g2": [0.44] * 3, "hexapod": [0.41] * 6, "hexapod-torsion": [0.41] * 6,
           "2prs-1pfs": [0.17, 0.17, 0.52], "6pfs": [0.44] * 6}
PLANAR, CHAINS, SLOW = {"3-rfr", "3-frr"}, {"3-rfr", "3-frr", "6-ufs"}, {"hexapod-torsion"}
IGNORED = {"iterations", "residual", "message", "time"}


def described(program, robot):
    question = json.dumps({"query": "describe"})
    done = subprocess.run([program, "query", robot], input=question, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def wrench_of(rng, robot):
    force, moment = ROBOTS[robot]
    size = rng.choice([0.05, 0.3, 1, 1, 3])
    part = lambda most: round(most * size * rng.uniform(-1, 1), 6)
    return [part(force), part(force), part(moment)] if robot in PLANAR else \
        [part(force) for _ in range(3)] + [part(moment) for _ in range(3)]


def pose_near(rng, home):
    if "phi" in home:
        return {"x": home["x"] + rng.uniform(-0.02, 0.02), "y": home["y"] + rng.uniform(-0.02, 0.02),
                "phi": home["phi"] + rng.uniform(-0.3, 0.5)}
    turned = [1] + [rng.uniform(-0.06, 0.06) for _ in range(3)]
    size = sum(x * x for x in turned) ** 0.5
    return {"position": [x + rng.uniform(-0.03, 0.03) for x in home["position"]], "quaternion": [x / size for x in turned]}


def question(rng, robot, told):
    wrench = wrench_of(rng, robot)
    if robot in CHAINS:
        one = {"query": "statics", "wrench": wrench, "law": rng.choice(["M0w", "M0", "M1"])}
        pose = pose_near(rng, told["home"])
        return {**one, "pose": pose, "inverse": True} if rng.random() < 0.3 else \
            {**one, "set_at": pose, "hold": rng.choice(["tension", "length"])}
    kind = rng.random()
    one = {"query": "forward", "wrench": wrench, "inputs": [round(a * (1 + 0.03 * rng.uniform(-1, 1)), 9) for a in LENGTHS[robot]]}
    if kind < 0.25 and robot.startswith("hexapod"):
        return {"query": "inverse", "wrench": wrench, "pose": pose_near(rng, told["home"])}
    if kind > 0.85 and robot not in SLOW:
        one["until"] = {"wrench": wrench_of(rng, robot), "limit": 20}
    return one


def answers(program, robot, questions):
    text = "".join(json.dumps(one) + "\n" for one in questions)
    done = subprocess.run([program, "query", robot], input=text, capture_output=True, text=True)
    return [json.loads(line) for line in done.stdout.splitlines()]


def numbers(value, path=""):
    """(path, list of numbers) of all that an answer says in numbers, words as they are."""
    if isinstance(value, dict):
        for key, inner in value.items():
            if key not in IGNORED:
                yield from numbers(inner, f"{path}.{key}" if path else key)
    elif isinstance(value, list) and value and any(isinstance(one, (dict, list)) for one in value):
        for k, inner in enumerate(value):
            yield from numbers(inner, f"{path}[{k}]")
    else:
        yield path, value


def difference(old, new, tolerance):
    if old.get("status") != new.get("status"):
        return f"status {old.get('status')} -> {new.get('status')}: {new.get('message', '')}"
    a, b = dict(numbers(old)), dict(numbers(new))
    if gone := a.keys() - b.keys():
        return "without " + ", ".join(sorted(gone))
    worst = ("", 0.0)
    for path in a:
        one, other = a[path], b[path]
        if isinstance(one, (int, float)) and not isinstance(one, bool):
            one, other = [one], [other]
        if isinstance(one, list) and isinstance(other, list):
            if len(one) != len(other):
                return f"{path}: {len(one)} -> {len(other)} numbers"
            plain = [(x, y) for x, y in zip(one, other) if isinstance(x, (int, float)) and isinstance(y, (int, float))]
            scale = max([abs(x) for x, _ in plain] + [1e-6])
            gap = max([abs(x - y) for x, y in plain] + [0]) / scale
            worst = max(worst, (path, gap), key=lambda one: one[1])
        elif one != other:
            return f"{path}: {one} -> {other}"
    return f"{worst[0]} by {worst[1]:.1e}" if worst[1] > tolerance else ""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--questions", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--tolerance", type=float, default=1e-8)
    parser.add_argument("old")
    parser.add_argument("new")
    given = parser.parse_args()
    rng, differ, asked = random.Random(given.seed), 0, 0
    weight = {robot: 0.1 if robot in SLOW else 1 for robot in ROBOTS}
    for robot in ROBOTS:
        told = described(given.new, robot)
        count = max(1, round(given.questions * weight[robot] / sum(weight.values())))
        questions = [question(rng, robot, told) for _ in range(count)]
        old, new = answers(given.old, robot, questions), answers(given.new, robot, questions)
        states = collections.Counter(one.get("status", "error") for one in new)
        print(f"{robot}: {count} questions, " + ", ".join(f"{n} {s}" for s, n in states.most_common()), flush=True)
        if len(old) != count or len(new) != count:
            sys.exit(f"{robot}: {len(old)} and {len(new)} answers to {count} questions")
        if states["error"]:
            sys.exit(f"{robot}: {states['error']} questions are none: {next(one for one in new if 'error' in one)}")
        asked += count
        for one, before, after in zip(questions, old, new):
            if what := difference(before, after, given.tolerance):
                differ += 1
                print(f"  {what}\n    {json.dumps(one)}")
    print(f"{differ} of {asked} answers differ")


if __name__ == "__main__":
    main()
