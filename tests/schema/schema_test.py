"""schema/robot.schema.json and the reader must judge robot files alike.

usage: schema_test.py SINEW_COMMAND JUDGE

Every robot file of the tree is good for both. Each is then broken in every way that a schema can see: a key left out,
an unknown key, a value of another kind, sign or unit, a list of another length. Both must judge the broken file alike.
JUDGE reads as the command does, thousands of files in one process; some are given to the command as well.
"""
import copy
import json
import pathlib
import re
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
SCHEMA = json.loads((ROOT / "schema/robot.schema.json").read_text(encoding="utf-8"))

# What a schema cannot say: relations between values. The reader alone refuses these.
READER_ALONE = {"coincident_base_points", "collapsed_platform", "loose_platform", "out_of_plane", "no_direction", "no_rotation", "longer_than_section",
                "guide_beyond_tip", "missing_guide", "wrong_tendon_count"}

VALUES = ["nonsense", "-1 mm", "0 mm", "1 kg", -1, [1]]


def files():
    folders = ["robots", "examples/robots"]
    found = sorted(file for folder in folders for file in ROOT.glob(f"{folder}/*.yaml"))
    assert len(found) >= 12, found
    return found


def places(node, path=()):
    """Paths of all values below a node. Of a list the ends are enough: what is between is alike."""
    if isinstance(node, dict):
        for key, value in node.items():
            yield (*path, key)
            yield from places(value, (*path, key))
    elif isinstance(node, list):
        for i in sorted({0, len(node) - 1}):
            yield (*path, i)
            yield from places(node[i], (*path, i))


def at(root, path):
    for key in path:
        root = root[key]
    return root


def changed(root, path, change):
    """A copy in which `change(parent, key)` was made."""
    root = copy.deepcopy(root)
    change(at(root, path[:-1]), path[-1])
    return root


def put(value):
    def change(parent, key):
        parent[key] = value
    return change


def leave_out(parent, key):
    del parent[key]


def is_replaced(root, path):
    """A default that every leg replaces, so that the reader never comes by it."""
    return path[0] == "defaults" and len(path) == 2 and "legs" in root and all(path[1] in leg for leg in root["legs"])


def mutations(root):
    """(what was done, the broken file), each file once."""
    yield "unknown key", {**root, "surprise": 1}
    for path in places(root):
        name = ".".join(map(str, path))
        value = at(root, path)
        yield f"without {name}", changed(root, path, leave_out)
        for other in VALUES if not is_replaced(root, path) else []:
            yield f"{name}: {other!r}", changed(root, path, put(other))
        if isinstance(value, dict):
            yield f"{name}: unknown key", changed(root, path, put({**value, "surprise": 1}))
        if isinstance(value, list):
            yield f"{name}: one more", changed(root, path, put([*value, value[-1]]))


def judge_by_reader(text):
    """The codes of what is wrong; none of a good file."""
    with tempfile.NamedTemporaryFile("w", suffix=".yaml", encoding="utf-8") as file:
        file.write(text)
        file.flush()
        done = subprocess.run([COMMAND, "check", "--quiet", file.name], capture_output=True, text=True, check=False,
                              timeout=60)
    if done.returncode == 0:
        return set()
    if done.returncode != 2:
        return {f"exit code {done.returncode}: {done.stderr}"}
    return set(re.findall(r" \[(\w+)\]$", done.stderr, flags=re.M)) or {done.stderr}


def judge_all(texts):
    """The codes of each file. Every hundredth is judged by the command, too."""
    done = subprocess.run([JUDGE], input="".join(text + "\n" for text in texts), capture_output=True, text=True,
                          check=True, timeout=240)
    codes = [set(line.split()) for line in done.stdout.splitlines()]
    assert len(codes) == len(texts), f"{len(texts)} files, {len(codes)} verdicts"
    for text, found in list(zip(texts, codes))[::100]:
        assert judge_by_reader(text) == found, f"the command says otherwise than {found} of {text}"
    return codes


class Schema(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        jsonschema.Draft7Validator.check_schema(SCHEMA)
        cls.schema = jsonschema.Draft7Validator(SCHEMA)

    def complaint(self, root):
        error = jsonschema.exceptions.best_match(self.schema.iter_errors(root))
        return error and f"{error.json_path}: {error.message}"

    def agree(self, cases):
        """Both judge every (what, file) alike."""
        texts = [json.dumps(root) for _, root in cases]  # JSON is YAML
        codes = judge_all(texts)
        differences = []
        for (what, root), found in zip(cases, codes):
            if bool(found) == self.schema.is_valid(root) and not (found and found <= READER_ALONE):
                differences.append(f"{what}: schema: {self.complaint(root) or 'good'}; reader: {found or 'good'}")
        self.assertEqual(differences, [], "\n" + "\n".join(differences))

    def test_every_robot_file_is_good(self):
        for file in files():
            with self.subTest(file=file.name):
                text = file.read_text(encoding="utf-8")
                self.assertIsNone(self.complaint(yaml.safe_load(text)))
                self.assertEqual(judge_by_reader(text), set())

    def test_broken_files_are_judged_alike(self):
        cases = {}
        for file in files():
            root = yaml.safe_load(file.read_text(encoding="utf-8"))
            for what, broken in mutations(root):
                if file.name == "2prs-1pfs.yaml" and re.fullmatch(r"without legs\.\d+|legs: one more", what):
                    continue  # its platform needs its three points, a leg is tied: relations, told by the reader
                cases.setdefault(json.dumps(broken), (f"{file.parent.name}/{file.name}: {what}", broken))
        self.agree(list(cases.values()))

    def test_measured_arms_are_judged_alike(self):
        root = yaml.safe_load((ROOT / "robots/ftdcr-v4.yaml").read_text(encoding="utf-8"))
        root["measurement"] = {"drive": {"gain": [1, 1, "1.1", 1, 1, 1, 1, 1, 1], "offset": ["-1 mm"] * 9,
                                         "toe": [[0, "1 mm", 0]] * 3, "lag": "50 ms", "play": 0},
                               "marker": {"place": [0, 0, "8 mm"], "base": ["-1 cm", 0, 0], "tilt": [0, 0, "5 deg"]}}
        root["sections"][0]["backbone"] = {
            "bending": "0.002 N m^2", "torsion": "0.001 N m^2", "stretch": "30 kN", "shear": 1, "mass": 0, "taper": "round",
            "end": {"bending": ["0.002 N m^2", 0.001], "torsion": "0.001 N m^2", "stretch": "30 kN", "shear": 1, "mass": 0}}
        self.agree(list(mutations(root)))

    def test_other_ways_to_write_are_judged_alike(self):
        head = {"sinew": 1, "name": "mine"}
        link = {"length": "200 mm", "tendon_offset": "5 mm"}
        circle = {"radius": "190 mm", "angle": "90 deg"}
        triangle = [["190 mm", 0], [0, "190 mm"], ["-190 mm", 0]]
        rfr = {**head, "architecture": "3-RFR", "base": circle, "platform": {"radius": "50 mm", "angle": "30 deg"},
               "defaults": {"link": link}}
        frr = {**rfr, "architecture": "3-FRR", "base": {**circle, "direction": "320 deg"},
               "defaults": {"link": link, "closure": {"length": "100 mm"}}}
        ufs = {**rfr, "architecture": "6-UFS", "base": {**circle, "spread": "12 deg"},
               "platform": {"radius": "70 mm", "angle": 0, "spread": "48 deg", "home": {"position": [0, 0, "180 mm"]}}}
        hexagon = [{"radius": "100 mm", "angle": f"{60 * i + 10 * (i % 2)} deg"} for i in range(6)]
        self.agree([
            ("points", {**rfr, "base": {"points": triangle}}),
            ("two points", {**rfr, "base": {"points": triangle[:2]}}),
            ("points and a circle", {**rfr, "base": {**circle, "points": triangle}}),
            ("points of the platform and a size", {**rfr, "platform": {"points": triangle, "radius": "50 mm"}}),
            ("points and an angle", {**rfr, "platform": {"points": triangle, "angle": "50 deg"}}),
            ("points in space", {**ufs, "base": {"points": hexagon}}),
            ("five points in space", {**ufs, "base": {"points": hexagon[:5]}}),
            ("points and a height", {**ufs, "base": {"points": hexagon, "height": 0}}),
            ("points in the plane for a robot in space", {**ufs, "base": {"points": triangle * 2}}),
            ("angles", {**rfr, "base": {"radius": "190 mm", "angles": [0, 2, 4]}}),
            ("two angles", {**rfr, "base": {"radius": "190 mm", "angles": [0, 2]}}),
            ("six angles", {**ufs, "base": {"radius": "120 mm", "angles": [0, 0.4, 2, 2.4, 4, 4.4]}}),
            ("angle and angles", {**rfr, "base": {**circle, "angles": [0, 2, 4]}}),
            ("angles and a spread", {**ufs, "base": {"radius": 1, "angles": [0, 1, 2, 3, 4, 5], "spread": 1}}),
            ("no spread", {**ufs, "base": circle}),
            ("a spread in the plane", {**rfr, "base": {**circle, "spread": "12 deg"}}),
            ("a height", {**ufs, "base": {**circle, "spread": "12 deg", "height": "-10 mm"}}),
            ("a height in the plane", {**rfr, "base": {**circle, "height": "10 mm"}}),
            ("a direction that nothing holds", {**rfr, "base": {**circle, "direction": "320 deg"}}),
            ("a direction in space", {**ufs, "base": {**ufs["base"], "direction": "320 deg"}}),
            ("directions", {**frr, "base": {**circle, "directions": [1, 2, 3]}}),
            ("direction and directions", {**frr, "base": {**circle, "direction": 1, "directions": [1, 2, 3]}}),
            ("four directions", {**frr, "base": {**circle, "directions": [1, 2, 3, 4]}}),
            ("first axis", {**ufs, "base": {**ufs["base"], "first_axis": "90 deg"}}),
            ("first axes", {**ufs, "base": {**ufs["base"], "first_axes": [0, 1, 2, 3, 4, 5]}}),
            ("five first axes", {**ufs, "base": {**ufs["base"], "first_axes": [0, 1, 2, 3, 4]}}),
            ("first axis and axes", {**ufs, "base": {**ufs["base"], "first_axis": 0, "first_axes": [0] * 6}}),
            ("first axis in the plane", {**rfr, "base": {**circle, "first_axis": "90 deg"}}),
            ("planar", {**rfr, "space": "planar"}),
            ("a planar 6-UFS", {**ufs, "space": "planar"}),
            ("a spatial 6-UFS", {**ufs, "space": "spatial"}),
            ("a spatial 3-RFR", {**rfr, "space": "spatial"}),
            ("legs, too", {**rfr, "legs": [{}]}),
            ("theta_is of no motor", {**rfr, "defaults": {"link": {**link, "theta_is": "chord"}}}),
            ("theta_is", {**frr, "architecture": "3-RFRR", "base": circle,
                          "defaults": {"link": {**link, "theta_is": "chord"}, "closure": {"length": "80 mm"}}}),
        ])

    link = {"type": "arc", "length": "200 mm", "tendon_offset": "5 mm"}
    feet = [["-120 mm", 0], ["120 mm", 0], [0, "-120 mm"], [0, "120 mm"]]
    heads = [["-40 mm", 0], ["40 mm", 0], [0, "-40 mm"], [0, "40 mm"]]

    def listed(self, defaults, *legs, **more):
        """A robot whose leg i stands at feet[i] unless it says otherwise."""
        whole = []
        for i, leg in enumerate(legs):
            base = {"point": self.feet[i % 4], **leg.get("base", {})}
            whole.append({"platform_point": self.heads[i % 4], **leg, "base": base})
        return {"sinew": 1, "name": "mine", "defaults": defaults, "legs": whole, **more}

    def test_defaults_and_legs_together_are_judged_alike(self):
        link, listed = self.link, self.listed
        chord, strut, pin = {"type": "chord"}, {"type": "strut", "length": "100 mm"}, {"type": "pin"}
        swivel = {**link, "type": "swivel"}
        clamped = {"base": {"direction": "90 deg"}}
        self.agree([
            ("one leg", listed({"link": link, "closure": chord}, {})),
            ("no leg", listed({"link": link, "closure": chord})),
            ("types in the legs", listed({}, {"link": link, "closure": chord}, {"link": swivel, "closure": pin})),
            ("a type is missing", listed({}, {"link": link, "closure": chord}, {"link": link})),
            ("a chord among struts with a length", listed({"link": link, "closure": strut},
                                                          clamped, {"closure": chord})),
            ("a chord among struts", listed({"link": link, "closure": {"type": "strut"}},
                                            {**clamped, "closure": {"length": 1}}, {"closure": chord})),
            ("a strut without a length", listed({"link": link, "closure": {"type": "strut"}},
                                                clamped, {"closure": chord})),
            ("a strut among chords", listed({"link": link, "closure": chord}, {}, {**clamped, "closure": strut})),
            ("a strut without a direction", listed({"link": link, "closure": chord}, {}, {"closure": strut})),
            ("a chord with a direction", listed({"link": link, "closure": chord}, {}, clamped)),
            ("a swivel with a direction", listed({"link": swivel, "closure": strut}, {}, clamped)),
            ("an arc among swivels", listed({"link": swivel, "closure": strut},
                                            {}, {**clamped, "link": {"type": "arc"}})),
            ("a swivel with a chord", listed({"link": swivel}, {"closure": chord})),
            ("an arc with a pin", listed({"link": link}, {"closure": pin})),
            ("inputs of a swivel", listed({"link": swivel, "closure": pin}, {"actuated": ["theta", "tendon_1"]})),
            ("inputs in another order", listed({"link": swivel, "closure": pin}, {"actuated": ["tendon_1", "theta"]})),
            ("inputs of an arc", listed({"link": link, "closure": chord}, {"actuated": ["theta", "tendon_1"]})),
            ("tied", listed({"link": link, "closure": chord}, {}, {"tied": 0})),
            ("the first one tied", listed({"link": link, "closure": chord}, {"tied": 0}, {})),
            ("tied to -1", listed({"link": link, "closure": chord}, {}, {"tied": -1})),
            ("a default taken away", listed({"link": {**link, "joints": 6}, "closure": chord},
                                            {"link": {"joints": None}})),
            ("33 joints", listed({"link": {**link, "joints": 33}, "closure": chord}, {})),
            ("no modulus", listed({"link": {**link, "material": {}}, "closure": chord}, {})),
            ("serial", listed({"link": link, "closure": chord}, {}, kind="serial")),
            ("version 2", listed({"link": link, "closure": chord}, {}, sinew=2)),
            ("a planar robot in space", listed({"link": link, "closure": chord}, {}, space="spatial")),
            ("an unknown default", listed({"link": link, "closure": chord, "colour": "red"}, {})),
        ])

    def test_rods_are_judged_alike(self):
        rod, ball, axis = {"type": "rod", "diameter": "3 mm", "material": {"E": "83 GPa"}}, {"type": "ball"}, [1, 0, 0]
        arc = {"link": self.link, "closure": {"type": "chord"}, "base": {"first_axis": axis}}
        hinged = {"closure": {"type": "hinged_strut", "length": "350 mm"}, "base": {"hinge_axis": axis}}
        in_space = {"space": "spatial", "platform": {"home": {"position": [0, 0, "300 mm"]}}}

        def standing(defaults, *legs, **more):
            """Legs evenly around a circle, in space."""
            whole = []
            for i, leg in enumerate(legs):
                point = {"radius": "200 mm", "angle": f"{120 * i} deg"}
                whole.append({"platform_point": {**point, "radius": "100 mm"}, **leg,
                              "base": {"point": point, **leg.get("base", {})}})
            return {"sinew": 1, "name": "mine", "defaults": defaults, "legs": whole, **in_space, **more}

        three, rods = [{}, {}, {}], {"link": rod, "closure": ball}
        self.agree([
            ("rods", standing(rods, *three)),
            ("rods in their legs", standing({}, *[rods] * 3)),
            ("a guide along a vector", standing({**rods, "base": {"direction": [0, 1, 1]}}, *three)),
            ("a guide along an angle", standing({**rods, "base": {"direction": "30 deg"}}, *three)),
            ("guides of their own", standing(rods, {}, {"base": {"direction": [0, 0.1, 1]}}, {})),
            ("no guide direction", standing({**rods, "base": {"direction": None}}, *three)),
            ("a direction of two numbers", standing({**rods, "base": {"direction": [0, 1]}}, *three)),
            ("a first axis", standing({**rods, "base": {"first_axis": axis}}, *three)),
            ("a hinge axis", standing(rods, {"base": {"hinge_axis": axis}}, {}, {})),
            ("a length", standing({**rods, "link": {**rod, "length": "1 m"}}, *three)),
            ("a tendon", standing({**rods, "link": {**rod, "tendon_offset": "5 mm"}}, *three)),
            ("joints", standing({**rods, "link": {**rod, "joints": 6}}, *three)),
            ("a closure with a length", standing({**rods, "closure": {**ball, "length": "1 m"}}, *three)),
            ("a chord", standing({**rods, "closure": {"type": "chord"}}, *three)),
            ("an arc with a ball", standing({**arc, "closure": ball}, *three)),
            ("no material", standing({**rods, "link": {"type": "rod", "diameter": 1}}, *three)),
            ("an empty material", standing({**rods, "link": {**rod, "material": None}}, *three)),
            ("a material without a modulus", standing({**rods, "link": {**rod, "material": {}}}, *three)),
            ("no diameter", standing({**rods, "link": {**rod, "diameter": None}}, *three)),
            ("diameters of their own", standing({**rods, "link": {"type": "rod", "material": {"E": 1e9}}},
                                                *[{"link": {"diameter": 1e-3}}] * 3)),
            ("one diameter", standing({**rods, "link": {"type": "rod", "material": {"E": 1e9}}},
                                      {}, {"link": {"diameter": 1e-3}}, {})),
            ("a negative diameter", standing(rods, {}, {"link": {"diameter": -1e-3}}, {})),
            *[(f"a rod with {link}, base {base}, closure {end}",
               standing({"link": {"type": "rod", "material": {"E": 1e9}, **link}, "base": base, "closure": end}, *three))
              for link in [{"diameter": 1e-3}, {"diameter": 1e-3, "material": {"E": 1e9, "poisson": 0.3}}]
              for base in [{}, {"spin": "held"}, {"spin": "free", "section_x": [1, 0, 0]}, {"spin": "loose"}]
              for end in [ball, {"type": "clamp"}, {"type": "clamp", "spin": "free"}, {**ball, "spin": "free"},
                          {"type": "clamp", "spin": "held", "section_x": [0, 1, 0]}, {**ball, "section_x": axis}]],
            *[(f"a rod with {link}",
               standing({"link": {"type": "rod", "material": {"E": 1e9, **shear}, **link}, "closure": ball}, *three))
              for shear in [{}, {"G": 1e8}]
              for strip in [{"width": "4 mm", "height": "1 mm"}, {"width": "4 mm"}, {"width": "4 mm", "height": 0},
                            {"width": "4 mm", "height": "1 mm", "depth": 1}, None, [1, 2]]
              for link in [{"section": strip}, {"section": strip, "diameter": 1e-3},
                           {"section": strip, "diameter": None}]],
            *[(f"a rod with {key}: {value} of {material}",
               standing({**rods, "link": {**rod, "material": material, key: value}}, *three))
              for material in [{"E": 1e9}, {"E": 1e9, "G": 1e8}]
              for key in ["precurvature", "load"]
              for value in [None, [0, 0, 1], [0, 0], [0, 0, "1 N"], [0, 0, "1 N/m"], [0, 0, "2 1/m"], [0, 0, "2 /mm"],
                            [0, 0, "-0.5 mN/m"], [0, 0, 1e7], 1, "1 1/m"]],
            ("a section of an arc",
             standing({**arc, "link": {**self.link, "section": {"width": 1, "height": 1}}}, *three)),
            ("the spin of an arc", standing({**arc, "base": {"first_axis": axis, "spin": "held"}}, *three)),
            ("an arc among rods", standing(rods, {}, arc, {})),
            ("a rod among arcs", standing({}, arc, rods, arc)),
            ("a strut beside rods", standing({}, rods, {**hinged, "link": {"type": "rail"}}, rods)),
            ("an arc among rods that is none", standing(rods, {}, {**arc, "link": {**self.link, "length": "-1 mm"}}, {})),
            ("the input of a rod", standing({**rods, "actuated": ["length"]}, *three)),
            ("the input of an arc", standing({**rods, "actuated": ["tendon_1"]}, *three)),
            ("tied rods", standing(rods, {}, {"tied": 0}, {"tied": 0})),
            *[(f"a home with {turn}", standing(rods, *three, platform={"home": {"position": [0, 0, 1], **turn}}))
              for turn in [{"tilt": "10 deg"}, {"azimuth": 1, "torsion": "-0.5 rad"}, {"tilt": "10 mm"}, {"tilt": None},
                           {"tilt": 0.1, "quaternion": [1, 0, 0, 0]}, {"torsion": 0, "quaternion": None},
                           {"azimuth": None, "quaternion": [1, 0, 0, 0]}, {"tilt": [0.1]}]],
            ("rods in the plane", standing(rods, *three, space="planar", platform={})),
            ("no home", standing(rods, *three, platform={})),
        ])

    def test_arms_are_judged_alike(self):
        wire = {"diameter": "1 mm", "material": {"E": "50 GPa", "poisson": 0.3}}
        section = {"type": "elastic", "length": "100 mm", "backbone": wire, "discs": {"count": 5},
                   "tendons": {"radius": "5 mm", "angle": "90 deg"}}
        bare = {key: value for key, value in section.items() if key != "tendons"}
        tendon = {"radius": "5 mm", "angle": 0}

        def arm(*sections, **more):
            return {"sinew": 1, "name": "mine", "kind": "serial", "sections": list(sections), **more}

        def repeated(**more):
            return {**arm(), "sections": {"count": 2, **section, "tendons": {"radius": 1e-3, "angle": [0, 1]}, **more}}

        self.agree([
            ("an arm", arm(section)),
            ("no sections", arm()),
            ("no tendons", arm(bare)),
            ("tendons of the second section", arm(bare, section)),
            ("tendons that are null", arm({**section, "tendons": None})),
            ("a kinematic section", arm(section, {"type": "neutral", "segments": 3, "joint": 1,
                                                  "tendons": {"radius": 1, "angle": 0}})),
            ("two sections", repeated()),
            ("two sections turned", repeated(tendons={"radius": 1e-3, "angle": "60 deg each"})),
            ("two sections with one angle", repeated(tendons={"radius": 1e-3, "angle": 0})),
            ("two sections with listed tendons", repeated(tendons=[tendon, tendon])),
            ("two sections without tendons", repeated(tendons=None)),
            *[(f"a backbone {backbone}", arm({**section, "backbone": backbone}))
              for backbone in [
                  {"diameter": "1 mm"}, {"material": wire["material"]}, {**wire, "hole": "0.5 mm"}, {**wire, "hole": -1},
                  {**wire, "end_diameter": "0.5 mm"}, {**wire, "end_diameter": 0}, {**wire, "width": "1 mm"},
                  {"width": "1 mm", "height": "2 mm", "material": wire["material"]},
                  {"width": "1 mm", "material": wire["material"]},
                  {"width": "1 mm", "height": "2 mm", "hole": 0, "material": wire["material"]},
                  {**wire, "law": "kirchhoff"}, {**wire, "law": "hooke"}, {**wire, "bending": 1, "torsion": 1},
                  {"bending": 1, "torsion": "0.5 N m^2"}, {"bending": [1, "20 N mm^2"], "torsion": 1},
                  {"bending": [1], "torsion": 1}, {"bending": 1}, {"torsion": 1}, {"bending": "1 N m", "torsion": 1},
                  {"bending": 1, "torsion": 1, "stretch": "2 kN", "shear": 5, "mass": "3 g/m"},
                  {"bending": 1, "torsion": 1, "stretch": 0}, {"bending": 1, "torsion": 1, "mass": -1},
                  {"bending": 1, "torsion": 1, "diameter": 1}, {**wire, "stretch": 1}, [1], "1 mm"]],
            *[(f"a material {material}", arm({**section, "backbone": {"diameter": "1 mm", "material": material}}))
              for material in [{"E": 1e9}, {"E": 1e9, "G": 1e9}, {"E": 1e9, "G": 1e9, "poisson": 0.1}, {"G": 1e9},
                               {"E": 1e9, "poisson": 0.6}, {"E": 1e9, "poisson": 0.5, "density": "6 g/cm^3"},
                               {"E": 1e9, "poisson": 0.3, "end_E": "2 GPa"}, {"E": 1e9, "poisson": 0.3, "end_E": 0}]],
            *[(f"guides {guides}", arm({**bare, "discs": None, **guides, "tendons": tendon}))
              for guides in [{}, {"guides": "channel"}, {"guides": "tube"}, {"discs": {}}, {"discs": {"count": 0}},
                             {"guides": "channel", "discs": {"count": 3}}, {"discs": {"count": 3, "mass": "-1 g"}},
                             {"discs": {"count": 3, "mass": "1 g", "radius": "9 mm"}},
                             {"discs": {"count": 3, "radius": 0}}, {"discs": {"count": 1001}}]],
            *[(f"a tendon with {more}", arm(section, {**bare, "tendons": tendons}))
              for more in [{}, {"end_radius": "4 mm"}, {"end_radius": "-4 mm"}, {"turn": "-90 deg"}, {"turn": "1 m"},
                           {"through": [tendon]}, {"through": [{"radius": 1e-3}]}, {"through": [{"angle": 1}]},
                           {"through": [{**tendon, "friction": 1}]}, {"through": [3]}, {"through": 3},
                           {"through": []}, {"through": [tendon, tendon]},
                           {"compliance": "0.1 mm/N"}, {"compliance": "1 mm"}, {"compliance": -1e-4},
                           {"stretch": {"stiffness": "1 kN", "outside": "1 m"}}, {"stretch": {"outside": 1}},
                           {"stretch": {"stiffness": 1}, "compliance": 1}, {"friction": 0.2}, {"friction": "0.2 N"},
                           {"friction": -1}, {"pretension": "2 N"}, {"pretension": "-2 N"}, {"count": 2}, {"count": 25},
                           {"colour": "red"}]
              for tendons in [{**tendon, **more}, [{**tendon, **more}]]],
            *[(f"the head {head}", arm(section, **head))
              for head in [{"gravity": [0, 0, "-9.81 m/s^2"]}, {"gravity": [0, 0]}, {"tip": {"mass": "1 g"}},
                           {"tip": {"place": [0, 0, 0]}}, {"tip": {"mass": 1, "place": ["1 mm", 0, 0]}},
                           {"tip": {"mass": None}}, {"tip": 3}, {"tolerance": "1 mm"}, {"geometry": "inferred"},
                           {"stretch": {"stiffness": "1 kN"}}, {"motor": {"lead": 1, "counts": 2}}, {"space": "spatial"},
                           {"platform": {}}]],
            *[(f"precurvature: {bent}", arm({**section, "precurvature": bent}))
              for bent in [None, [0, 0, 1], [0, 0], [0, "1 /mm", "2 1/m"], [0, 0, "1 N"], 3]],
        ])

    def test_relations_between_values_are_told_by_the_reader_alone(self):
        link, listed, chord = self.link, self.listed, {"type": "chord"}
        swivel = {**link, "type": "swivel"}
        axis = {"point": [0, 0, 0], "first_axis": [0, 0, 1]}
        for code, root in [
                ("coincident_base_points", listed({"link": link, "closure": chord},
                                                  {}, {"base": {"point": self.feet[0]}})),
                ("collapsed_platform", listed({"link": link, "closure": chord, "platform_point": [0, 0]},
                                              {"platform_point": [0, 0]})),
                ("out_of_range", listed({"link": link, "closure": chord}, {}, {"tied": 1})),
                ("too_many_legs", listed({"link": swivel, "closure": {"type": "pin"}},
                                         *({"base": {"point": [i, 0]}} for i in range(13)))),
                ("no_such_leg", listed({"link": swivel, "closure": chord}, {})),
                ("no_effect", listed({"link": link, "closure": chord, "base": {"direction": 1}}, {})),
                ("wrong_actuators", listed({"link": link, "closure": chord, "actuated": ["theta", "tendon_1"]}, {})),
                ("no_direction", listed({"link": link, "closure": chord}, {"base": axis, "platform_point": [1, 0, 0]},
                                        space="spatial", platform={"home": {"position": [0, 0, 1]}})),
        ]:
            with self.subTest(code=code):
                self.assertIsNone(self.complaint(root))
                self.assertIn(code, judge_by_reader(json.dumps(root)))


if __name__ == "__main__":
    COMMAND, JUDGE = sys.argv.pop(1), sys.argv.pop(1)
    unittest.main()
