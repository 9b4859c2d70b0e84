"""schema/query.schema.json and the handlers of queries judge alike which fields there are, and of which kind.

usage: query_schema_test.py SINEW_COMMAND

The queries are those that the fuzz target begins with (tests/fuzz/corpus/session). One that is answered must be good for the
schema. Each is then broken: an unknown key, a value of a wrong kind, a word that is none. Both must refuse it.
"""
import copy
import json
import pathlib
import subprocess
import sys
import unittest
import warnings

with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    import jsonschema

ROOT = pathlib.Path(__file__).resolve().parents[2]
COMMAND = ""
VALIDATOR = jsonschema.Draft7Validator(json.loads((ROOT / "schema/query.schema.json").read_text(encoding="utf-8")))


def ask(robot, queries):
    text = "".join(json.dumps(query) + "\n" for query in queries)
    done = subprocess.run([COMMAND, "query", robot], input=text, capture_output=True, text=True, check=True)
    return [json.loads(line) for line in done.stdout.splitlines()]


def corpus():
    for path in sorted((ROOT / "tests/fuzz/corpus/session").iterdir()):
        robot, *lines = path.read_text(encoding="utf-8").splitlines()
        queries = [json.loads(line) for line in lines if line.strip()]
        yield robot, [query for query in queries if isinstance(query, dict)]


def broken(query):
    yield {**query, "nothing": 1}
    for key, value in query.items():
        if key in ("id", "set"):
            continue
        wrong = copy.deepcopy(query)
        wrong[key] = "nonsense" if not isinstance(value, bool) else 3
        yield wrong


class QuerySchema(unittest.TestCase):
    def test_is_a_schema(self):
        jsonschema.Draft7Validator.check_schema(VALIDATOR.schema)

    def test_takes_what_is_answered(self):
        count = 0
        for robot, queries in corpus():
            for query, answer in zip(queries, ask(robot, queries)):
                if "error" in answer:
                    continue
                count += 1
                errors = [error.message for error in VALIDATOR.iter_errors(query)]
                self.assertEqual(errors, [], f"{robot}: {query}")
        self.assertGreater(count, 100)

    def test_refuses_what_is_refused(self):
        for robot, queries in corpus():
            good = [query for query, answer in zip(queries, ask(robot, queries)) if "error" not in answer]
            wrong = [one for query in good for one in broken(query)]
            for query, answer in zip(wrong, ask(robot, wrong)):
                self.assertEqual(VALIDATOR.is_valid(query), "error" not in answer, f"{robot}: {query}\n{answer}")


if __name__ == "__main__":
    COMMAND = sys.argv.pop(1)
    unittest.main()
