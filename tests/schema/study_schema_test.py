"""schema/study.schema.json and the reader must judge study files alike.

usage: study_schema_test.py SINEW_COMMAND JUDGE

Studies that use every key are good for both. Each is then broken in every way that a schema can see: a key left out,
an unknown key, a value of another kind. Both must judge the broken study alike.
JUDGE reads as the command does, hundreds of files in one process; some are given to the command as well.
"""
import copy
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest
import warnings

import yaml

with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    import jsonschema

ROOT = pathlib.Path(__file__).resolve().parents[2]
COMMAND = JUDGE = ""
SCHEMA = json.loads((ROOT / "schema/study.schema.json").read_text(encoding="utf-8"))
VALIDATOR = jsonschema.Draft7Validator(SCHEMA)

RANDOM = yaml.safe_load("""
sinew: 1
robot: 3-rfr
random: {count: 10, seed: 3}
path: anew
axes: {x: {from: -1 mm, to: 1 mm}, y: {mean: 0, deviation: 0.001, unit: m}}
query: {query: inverse, pose: {x: $x, y: $y, phi: 0}}
""")
JOINT = yaml.safe_load("""
sinew: 1
robot: 3-rfr
axes: {x: {from: -1 mm, to: 1 mm, count: 3}}
derived: {y: 2 x, phi: {is: 10 x, unit: rad, from: -0.5 rad, to: 0.6}}
query: {query: inverse, pose: {x: $x, y: $y, phi: $phi}}
outputs: {l: "inputs[0]", m: "inputs[1]"}
fits: {f: {coefficients: [a, b], of: {l: a*x + b*x^2, m: a*x}}, g: {known: {c: 0.1}, of: {l: c*phi}}}
""")
GRID = yaml.safe_load("""
sinew: 1
title: t
robot: 3-rfr
set: {platform.radius: 45 mm}
axes: {x: {from: -1 mm, to: 1 mm, count: 3}, y: [0 mm, 1 mm]}
query: {query: inverse, pose: {x: $x, y: $y, phi: 0}}
outputs: {l: {path: "inputs[0]", unit: m, sometimes: false}, m: "inputs[1]"}
fits: {l: {terms: [1, x, x*y]}, f: {of: m, terms: [x^2]}}
""")
VALUES = ["nonsense", -1, 0, 1.5, [1], {}, True]
# Places whose values only the reader knows: robots, queries, terms, units, values of axes.
BELOW = {"query", "set", "terms", "items"}


def places(node, path=()):
    if isinstance(node, dict):
        for key, value in node.items():
            yield (*path, key)
            if key not in BELOW:
                yield from places(value, (*path, key))


def at(root, path):
    for key in path:
        root = root[key]
    return root


def broken(study):
    for path in places(study):
        without = copy.deepcopy(study)
        del at(without, path[:-1])[path[-1]]
        yield f"without {path}", without
        if isinstance(at(study, path), dict) and path[-1] not in BELOW and path not in {("axes",), ("derived",), ("outputs",), ("fits",)}:
            more = copy.deepcopy(study)
            at(more, path)["unheard_of"] = 1
            yield f"more in {path}", more
        for value in VALUES:
            other = copy.deepcopy(study)
            at(other, path[:-1])[path[-1]] = value
            yield f"{path} = {value!r}", other


# What a schema cannot say: relations between values, files, numbers in texts. The reader alone refuses these.
READER_ALONE = {"unknown_axis", "unused_axis", "unknown_column", "wrong_dimension", "file_missing", "bad_term", "unknown_unit",
                "not_a_number", "unknown_path", "unknown_output", "missing_key", "out_of_range", "file_unreadable", "unknown_choice",
                "no_outputs", "duplicate_column", "not_whole", "too_large", "later_column", "unused_coefficient", "all_left_out"}


class StudySchema(unittest.TestCase):
    def by_command(self, file):
        """Whether the command takes it, and the codes of what is wrong with it."""
        run = subprocess.run([COMMAND, "sweep", file, "--list"], capture_output=True, text=True, check=False, timeout=60)
        self.assertIn(run.returncode, (0, 2), run.stderr)
        codes = {line.rsplit("[", 1)[1].rstrip("]") for line in run.stderr.splitlines() if line.endswith("]")}
        self.assertEqual(run.returncode == 0, not codes, run.stderr)
        return codes

    def verdicts(self, studies, folder):
        """The codes of each study. Every twentieth is judged by the command, too."""
        files = []
        for count, study in enumerate(studies):
            files.append(pathlib.Path(folder) / f"study{count}.yaml")
            files[-1].write_text(json.dumps(study), encoding="utf-8")  # JSON is YAML
        done = subprocess.run([JUDGE], input="".join(f"{file}\n" for file in files), capture_output=True, text=True,
                              check=True, timeout=240)
        codes = [set(line.split()) for line in done.stdout.splitlines()]
        self.assertEqual(len(codes), len(files))
        for file, found in list(zip(files, codes))[::20]:
            self.assertEqual(self.by_command(file), found, file.read_text(encoding="utf-8"))
        return codes

    def test_the_studies_of_the_tree_are_good(self):
        for file in sorted(ROOT.glob("studies/*.yaml")):
            jsonschema.validate(yaml.safe_load(file.read_text(encoding="utf-8")), SCHEMA)
            self.assertEqual(subprocess.run([COMMAND, "sweep", file, "--list"], capture_output=True, check=False).returncode, 0, file)

    def test_both_judge_alike(self):
        cases = []
        for study in (RANDOM, GRID, JOINT):
            jsonschema.validate(study, SCHEMA)
            cases += [("as it is", study), *broken(study)]
        with tempfile.TemporaryDirectory() as folder:
            codes = self.verdicts([study for _, study in cases], folder)
        for (what, study), found in zip(cases, codes):
            by_schema = VALIDATOR.is_valid(study)
            with self.subTest(what=what):
                if what == "as it is":
                    self.assertEqual(found, set())
                if by_schema and found:
                    self.assertTrue(found <= READER_ALONE, f"the reader alone refuses it: {found}")
                else:
                    self.assertEqual(by_schema, not found, f"{found}: {study}")
        self.assertGreater(len(cases), 150)


if __name__ == "__main__":
    COMMAND, JUDGE = sys.argv.pop(1), sys.argv.pop(1)
    unittest.main()
