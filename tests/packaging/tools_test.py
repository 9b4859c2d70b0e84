"""Deliberate violations in a small tree: what tools/layers.py and tools/equations.py must and must not say."""
import argparse
import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as tree

TOOLS = pathlib.Path(__file__).resolve().parents[2] / "tools"
sys.path.append(str(TOOLS))
import python_reference  # noqa: E402
import readme  # noqa: E402
import reference  # noqa: E402


class Tree(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)

    def write(self, path, text):
        (self.root / path).parent.mkdir(parents=True, exist_ok=True)
        (self.root / path).write_text(text, encoding="utf-8")

    def run_tool(self, tool, *arguments):
        done = subprocess.run([sys.executable, str(TOOLS / tool), "--root", str(self.root), *arguments],
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.stderr, "")
        return done.returncode, done.stdout


class Reference(unittest.TestCase):
    """What a comment of a public header must say."""

    def lacks(self, kind, type_, said, where="sinew/robot/robot.hpp", around=""):
        member = tree.fromstring(f'<memberdef kind="{kind}" static="no"><type>{type_}</type><name>x</name><argsstring>()</argsstring>'
                                 f"<briefdescription>{said}</briefdescription></memberdef>")
        return reference.wants(member, around, where, "sinew::A")

    def test_functions_and_numbers_need_a_sentence(self):
        self.assertEqual(self.lacks("function", "bool", ""), "has no sentence")
        self.assertEqual(self.lacks("variable", "double", ""), "has no sentence")
        self.assertIsNone(self.lacks("variable", "std::string", ""))

    def test_numbers_need_a_unit(self):
        self.assertEqual(self.lacks("function", "double", "Length of it."), "has numbers without a unit")
        self.assertIsNone(self.lacks("function", "double", "Length of it [m]."))
        self.assertIsNone(self.lacks("variable", "Vec3&lt;double&gt;", "Where it is.", around="Base frame [m]."))
        self.assertIsNone(self.lacks("function", "double", "sin(x)/x", where="sinew/math/entire.hpp"))


class Readme(Tree):
    """Programs of a page of which each prints the same."""

    def wrong(self, *programs):
        self.write("page.md", "## One\n\n" + "".join(f"```python\n{program}\n```\n\n" for program in programs) + "Each prints\n\n```\n3\n```\n")
        options = argparse.Namespace(update=False, command=".", examples=None, programs=None, python=sys.executable, octave=None)
        return len(readme.Page(self.root / "page.md", options).check())

    def test_each_has_to_print_what_is_shown(self):
        self.assertEqual(self.wrong("print(3)", "print(1 + 2)"), 0)
        self.assertEqual(self.wrong("print(3)", "print(4)"), 1)
        self.assertEqual(self.wrong("print(3)", "print(3); raise ValueError"), 1)


class Layers(Tree):
    def says(self, path, include, status, text=""):
        self.write(path, f"// first line\n#include {include}\n")
        code, out = self.run_tool("layers.py")
        self.assertEqual(code, status, out)
        self.assertIn(f"{path}:2" if status else "0 violations", out)
        self.assertIn(text, out)
        (self.root / path).unlink()

    def test_downwards_is_allowed(self):
        for path, include in [("include/sinew/robot/robot.hpp", '"sinew/leg/leg.hpp"'),
                              ("src/robot/robot.cpp", '"robot/private.hpp"'),
                              ("src/study/run.cpp", '"sinew/io/results.hpp"'),
                              ("src/solve/newton.cpp", '"sinew/math/vec.hpp"'),
                              ("cli/main.cpp", '"sinew/sinew.hpp"'),
                              ("include/sinew/sinew.hpp", '"sinew/query/query.hpp"'),
                              ("include/sinew/math/vec.hpp", "<Eigen/Core>"),
                              ("src/io/robots/robot_file.cpp", "<yaml-cpp/yaml.h>"),
                              ("kernel/include/sinew/kernel/arc.h", '"sinew/kernel/real.h"'),
                              ("src/link/arc.cpp", "<sinew/kernel/arc.h>")]:
            with self.subTest(path=path):
                self.says(path, include, 0)

    def test_upwards_and_sideways_are_not(self):
        for path, include, text in [("include/sinew/leg/leg.hpp", '"sinew/robot/robot.hpp"', "leg is below robot"),
                                    ("src/link/arc.cpp", '"sinew/tendon/pair.hpp"', "siblings"),
                                    ("src/math/vec.cpp", "<sinew/solve/newton.hpp>", "siblings"),
                                    ("src/query/answer.cpp", '"sinew/study/sweep.hpp"', "query is below study"),
                                    ("src/query/answer.cpp", '"cli/verbs.hpp"', "application"),
                                    ("src/io/x.cpp", '"query/private.hpp"', "io is below query"),
                                    ("src/robot/x.cpp", '"sinew/sinew.hpp"', "above all layers"),
                                    ("src/robot/x.cpp", '"sinew/robots/x.hpp"', "not a layer"),
                                    ("include/sinew/io/x.hpp", "<yaml-cpp/yaml.h>", "public header"),
                                    ("include/sinew/io/x.hpp", '"io/private.hpp"', "private"),
                                    ("kernel/include/sinew/kernel/arc.h", "<math.h>", "freestanding"),
                                    ("kernel/include/sinew/kernel/arc.h", '"sinew/base/units.hpp"', "freestanding")]:
            with self.subTest(path=path, include=include):
                self.says(path, include, 1, text)

    def test_sizes_only_warn(self):
        self.write("include/sinew/math/long.hpp", "\n" * 301)
        for i in range(16):
            self.write(f"src/math/file_{i}.cpp", "")
        code, out = self.run_tool("layers.py")
        self.assertEqual(code, 0)
        self.assertIn("warning: include/sinew/math/long.hpp: 301 lines", out)
        self.assertIn("warning: src/math: 16 .cpp files", out)


class Equations(Tree):
    header = """struct Arc {
  double length;

  /// Tip.  @implements TDPCR (25)
  template <Real S>
  Vec2<S> tip(S curvature) const;

  /// Rates.
  /// What follows is broken badly.  @implements
  /// TDPCR (26)-(27), LSK (1),
  ///   (3)
  double rate(double curvature) const {
    const double t = 0;  // @implements 3PFS (2)
    return t;
  }
};
"""
    test = """TEST(Arc, Straight) {  // @verifies TDPCR (25)–(27), where it is straight
}

// @verifies LSK (1), (3)
RC_GTEST_PROP(Arc, Rate, ()) {
  if (true) {
    check();  // @verifies 3PFS (2)
  }
}
"""

    def setUp(self):
        super().setUp()
        self.write("include/sinew/link/arc.hpp", self.header)
        self.write("tests/link/arc_test.cpp", self.test)

    def problems(self, *arguments):
        code, out = self.run_tool("equations.py", *arguments)
        lines = out.splitlines()[:-1]
        self.assertEqual(code, 1 if lines else 0)
        return lines

    def test_page_names_function_and_test(self):
        self.assertEqual(self.problems(), [])
        page = (self.root / "docs/equations.md").read_text(encoding="utf-8")
        header, test = "include/sinew/link/arc.hpp", "tests/link/arc_test.cpp"
        for row in [f"| TDPCR | (25) | {header}: `Arc::tip` | {test}: `Arc.Straight` |",
                    f"| TDPCR | (26) | {header}: `Arc::rate` | {test}: `Arc.Straight` |",
                    f"| LSK | (3) | {header}: `Arc::rate` | {test}: `Arc.Rate` |",
                    f"| 3PFS | (2) | {header}: `Arc::rate` | {test}: `Arc.Rate` |"]:
            self.assertIn(row, page.splitlines())
        self.assertEqual(self.problems("--check"), [])

    def test_stale_page(self):
        self.assertIn("docs/equations.md is stale; run tools/equations.py", self.problems("--check"))
        self.assertEqual(self.problems(), [])
        self.write("tests/link/arc_test.cpp", self.test.replace("Rate,", "RateIsExact,"))
        self.assertEqual(len(self.problems("--check")), 1)
        self.assertEqual(self.problems(), [])

    def test_two_places(self):
        self.write("src/link/arc.cpp", "// @implements TDPCR (27)\ndouble again() { return 0; }\n")
        self.assertEqual(self.problems(), ["src/link/arc.cpp:1: TDPCR (27) is already implemented at "
                                           "include/sinew/link/arc.hpp:9; an equation lives in one place"])

    def test_untested_and_unimplemented(self):
        self.write("src/link/arc.cpp", "// @implements TDPCR (30)\ndouble more() { return 0; }\n")
        self.write("tests/link/more_test.cpp", "TEST(A, B) {}  // @verifies LSK (9)\n")
        self.assertEqual(self.problems(), ["src/link/arc.cpp:1: no test says @verifies TDPCR (30)",
                                           "tests/link/more_test.cpp:1: nothing says @implements LSK (9)"])

    def test_malformed_tags(self):
        for tag, text in [("TDPCR 25", "expected a paper and equations"), ("(25)", "expected a paper"),
                          ("TDPRC (25)", "is not a paper"), ("TDPCR (99)", "has equations (1) to (70)"),
                          ("LSK (5)-(4)", "has equations")]:
            with self.subTest(tag=tag):
                self.write("src/link/arc.cpp", f"// @implements {tag}\n")
                self.assertIn(text, "\n".join(self.problems()))


class PythonReference(unittest.TestCase):
    def lacking(self, said, types="", parameters=(), source=""):
        return list(python_reference.lacking(said, "", types, parameters, source))

    def test_finds_what_a_docstring_lacks(self):
        self.assertEqual(self.lacking(""), ["has no sentence"])
        self.assertEqual(self.lacking("Where the tip is.", "float"), ["has numbers without a shape", "has numbers without a unit"])
        self.assertEqual(self.lacking("Draws.", parameters=["ax"]), ["does not say what ax is"])
        self.assertEqual(self.lacking("Opens.", source="raise InputError(text)"), ["raises InputError and does not say so"])
        self.assertEqual(self.lacking("Where the tip is, (3,) [m].", "float"), [])

    def test_finds_fields_without_shape_or_unit(self):
        said = "Fields:\n    inputs (numbers): in leg order\n    wrench (numbers) [N, N m]: on the platform; (6,)\n"
        self.assertEqual(list(python_reference.lacking_of_fields(said)), ["inputs has no shape", "inputs has no unit"])


if __name__ == "__main__":
    unittest.main()
