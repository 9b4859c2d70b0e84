"""What is to be drawn of a robot at a pose: the lines of the question `shape`."""
from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from ._errors import InputError
from ._fields import VERBS
from .answer import Answer

if TYPE_CHECKING:
    from .robot import Robot

_OF_ANSWERS = ("configuration", "inputs", "pose")


def _questions(answer: Answer) -> Iterator[dict[str, Any]]:
    """Questions that may have the answer's shape: as it was asked; as it was found."""
    asked = answer.question._plain()
    found = answer._plain()
    shared = {name: value for name, value in asked.items() if name in VERBS["shape"].fields}
    loads = {name: shared[name] for name in ("model", "law", "theta_is", "set", "wrench", "gravity") if name in shared}
    if "configuration" in found:
        yield {**loads, "configuration": found["configuration"]}
    inputs = found.get("inputs", asked.get("inputs"))
    if inputs and "pose" in found:
        yield {**loads, "inputs": inputs, "start": found["pose"]}
        yield {**loads, "inputs": inputs}
    if "pose" in found and all("angles" in leg for leg in found.get("legs") or [{}]):  # chains, as they are
        law = {"law": shared["law"]} if "law" in shared else {}
        yield {**law, "model": "prb", "pose": found["pose"], "angles": [leg["angles"] for leg in found["legs"]]}
    yield shared
    if "pose" in found:
        branch = {name: shared[name] for name in ("bending", "curvature", "elbow") if name in shared}
        yield {**loads, **branch, "pose": found["pose"]}


def _shape_of_arm(robot: Robot, answer: Answer) -> dict[str, Any] | None:
    """The same question, with its shape: what was sensed or aimed at is found again, the same."""
    asked = answer.question._plain()
    verb = asked.pop("query", "")
    if robot._about()._plain().get("kind") not in ("arm", "arm_legs") or verb not in VERBS:
        return None
    plain: dict[str, Any] = robot._ask(verb, {**asked, "want": ["shape"]})._plain()
    return plain if "backbones" in plain else None


def shape_of(robot: Robot, answer: Any) -> dict[str, Any]:
    """Fields of the shape at an answer's pose, or at home where there is none."""
    if answer is None:
        return shape_at_home(robot)
    plain: dict[str, Any]
    if hasattr(answer, "answer"):
        answer = answer.answer  # of a prepared question
    if not isinstance(answer, Answer) or type(answer) is not Answer:
        raise InputError(f"a picture is of one answer, not of {type(answer).__name__}: give answers[i]", "wrong_type", "answer")
    if "backbones" in answer:
        return answer._plain()
    of_arm = _shape_of_arm(robot, answer)
    if of_arm:
        return of_arm
    for fields in _questions(answer):
        try:
            plain = robot._ask("shape", fields)._plain()
        except InputError:
            continue
        if "backbones" in plain:
            return plain
    why = f"{answer.status}{': ' + answer.message if answer.message else ''}"
    if answer.ok:
        why = f"an answer to {answer['query']} has no pose; give one that has, or None for the robot at home"
    raise InputError(f"there is no shape to draw: {why}", "no_shape", "answer")


def shape_at_home(robot: Robot) -> dict[str, Any]:
    about = robot._about()._plain()
    candidates: list[dict[str, Any]] = [{"configuration": [[0.0, 0.0] for _ in about["sections"]]}] if "sections" in about else []
    home = about.get("home")
    if about.get("kind") in ("arm", "arm_legs"):
        candidates = [{"changes": []}]
    elif home:
        candidates.append({"pose": home})
        for limits in [entry.get("limits") for entry in about["inputs"]][:1]:
            if limits:
                candidates.append({"inputs": [sum(entry["limits"]) / 2 for entry in about["inputs"]]})
        if "position" in home:
            candidates.append({"independent": {"z": home["position"][2], "e1": 0.0, "e2": 0.0}})
    for fields in candidates:
        try:
            plain: dict[str, Any] = robot._ask("shape", fields)._plain()
        except InputError:
            continue
        if "backbones" in plain:
            return plain
    raise InputError("no shape of this robot at home: give an answer to draw", "no_shape", "answer")


PULLS = ("pull 1", "pull 2", "pull 3", "pull 4")  # quarters of the largest tension


def _kind_of(tension: float, most: float) -> str:
    """Of a tendon of an arm; next to nothing, beside what others pull, is slack."""
    return "slack" if tension <= 1e-6 * most else PULLS[min(int(len(PULLS) * tension / most * (1 - 1e-9)), len(PULLS) - 1)]


def _kinds_of_tendons(shape: dict[str, Any]) -> list[list[str]]:
    """By what they pull where the answer says it; else they are tendons, all alike."""
    groups = shape.get("tendons") or []
    tensions = shape.get("tensions") or []
    if "slack" not in shape or [len(group) for group in groups] != [len(of) for of in tensions]:
        return [["tendon"] * len(group) for group in groups]
    most = max((value for of in tensions for value in of), default=0.0)
    return [[_kind_of(value, most) for value in of] for of in tensions]


def pulls(shape: dict[str, Any]) -> list[tuple[str, str]]:
    """Kinds of tendons that are drawn by what they pull, and the words for them [N]."""
    kinds = {kind for of in _kinds_of_tendons(shape) for kind in of} - {"tendon"}
    most = max((value for of in shape.get("tensions") or [] for value in of), default=0.0) if kinds else 0.0
    words = {"slack": "slack", **{kind: f"up to {most * (i + 1) / len(PULLS):.3g} N" for i, kind in enumerate(PULLS)}}
    return [(kind, words[kind]) for kind in words if kind in kinds]


def polylines(shape: dict[str, Any]) -> list[tuple[str, list[list[float]]]]:
    """Kind and points [m] of each line: base, platform, tendon, backbone, strut; tendons of arms by what they pull."""
    lines: list[tuple[str, list[list[float]]]] = []
    for kind in ("base", "platform"):
        points = shape.get(kind) or []
        if len(points) > 1:
            lines.append((kind, [*points, points[0]]))
    for group, kinds in zip(shape.get("tendons") or [], _kinds_of_tendons(shape)):
        lines += [(kind, line) for kind, line in zip(kinds, group) if len(line) > 1]
    backbones = shape.get("backbones") or []
    lines += [("backbone", line) for line in backbones if len(line) > 1]
    ends = shape.get("platform") or []
    if len(ends) == len(backbones):  # a leg whose link ends before the platform has a rigid strut from there
        lines += [("strut", [line[-1], end]) for line, end in zip(backbones, ends) if math.dist(line[-1], end) > 1e-6]
    return lines
