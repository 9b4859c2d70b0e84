"""Answers in HTML: in a notebook a picture and a table, and one file of a pose that can be turned."""
from __future__ import annotations

import html
import json
import math
import os
from typing import TYPE_CHECKING, Any

from ._drawing import polylines, pulls, shape_of
from ._errors import InputError
from ._text import rows_of

if TYPE_CHECKING:
    from .answer import Answer
    from .robot import Robot

COLORS = {"base": "#999999", "platform": "#1f5fa8", "tendon": "#c8642c", "backbone": "#222222", "strut": "#7a7a7a",
          "slack": "#7c7b78", "pull 1": "#7c7b78", "pull 2": "#4f6f9f", "pull 3": "#1f55a5", "pull 4": "#00224e"}
WIDTHS = {"base": 1.0, "platform": 2.0, "tendon": 0.8, "backbone": 2.2, "strut": 2.2,
          "slack": 0.8, "pull 1": 1.0, "pull 2": 1.3, "pull 3": 1.6, "pull 4": 2.0}
_AZIMUTH, _HEIGHT = math.radians(35), math.radians(20)


def _seen(point: list[float]) -> tuple[float, float]:
    """On paper, to the right and down: from above x as it is; a point in space from the front, a little from above."""
    if len(point) == 2:
        return point[0], -point[1]
    x = point[0] * math.cos(_AZIMUTH) - point[1] * math.sin(_AZIMUTH)
    depth = point[0] * math.sin(_AZIMUTH) + point[1] * math.cos(_AZIMUTH)
    return x, -(point[2] * math.cos(_HEIGHT) + depth * math.sin(_HEIGHT))


def svg(lines: list[tuple[str, list[list[float]]]], size: int = 280) -> str:
    """A drawing of the lines, to scale."""
    drawn = [(kind, [_seen(point) for point in line]) for kind, line in lines]
    xs = [x for _, line in drawn for x, _ in line] or [0.0]
    ys = [y for _, line in drawn for _, y in line] or [0.0]
    scale = 0.9 * size / (max(max(xs) - min(xs), max(ys) - min(ys)) or 1.0)
    left, top = (max(xs) + min(xs)) / 2, (max(ys) + min(ys)) / 2
    paths = []
    for kind, line in drawn:
        points = " ".join(f"{size / 2 + scale * (x - left):.1f},{size / 2 + scale * (y - top):.1f}" for x, y in line)
        dashes = 'stroke-dasharray="3 3" ' if kind == "slack" else ""
        paths.append(f'<polyline points="{points}" fill="none" stroke="{COLORS[kind]}" stroke-width="{WIDTHS[kind]}" {dashes}'
                     'stroke-linejoin="round" stroke-linecap="round"/>')
    return (f'<svg xmlns="http://www.w3.org/2000/svg" role="img" width="{size}" height="{size}" viewBox="0 0 {size} {size}" '
            f'style="background:#ffffff">{"".join(paths)}</svg>')


def legend(words: list[tuple[str, str]]) -> str:
    """What tendons pull, by their looks."""
    if not words:
        return ""
    entries = []
    for kind, word in words:
        border = f"{max(1, round(WIDTHS[kind]))}px {'dashed' if kind == 'slack' else 'solid'} {COLORS[kind]}"
        entries.append(f'<span style="display:inline-block;width:2em;border-top:{border};vertical-align:middle;margin:0 .5em"></span>{html.escape(word)}')
    return f'<div style="font-size:small">tension{"".join(entries)}</div>'


def table(caption: str, rows: list[tuple[str, str, str]]) -> str:
    cells = "".join(f"<tr><td>{html.escape(name)}</td><td>{html.escape(value)}</td><td>{html.escape(unit)}</td></tr>"
                    for name, value, unit in rows)
    return f"<table><caption>{html.escape(caption)}</caption><thead><tr><th>field</th><th>value</th><th>unit</th></tr></thead>" \
           f"<tbody>{cells}</tbody></table>"


def _caption(answer: Answer) -> str:
    plain = answer._plain()
    return f"{plain.get('query')} of {plain.get('robot')}: {answer.status}{': ' + answer.message if answer.message else ''}"


def fragment(answer: Answer) -> str:
    """For a notebook."""
    try:
        shape = shape_of(answer.robot, answer)
        picture = f"<div>{svg(polylines(shape))}{legend(pulls(shape))}</div>"
    except InputError:  # nothing to be drawn
        picture = ""
    return f'<div style="display:flex;flex-wrap:wrap;gap:1em">{picture}<div>{table(_caption(answer), list(rows_of(answer)))}</div></div>'


_PAGE = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>@title@</title>
<style>body{font:14px/1.4 sans-serif;color:#222;background:#fff;margin:1em;display:flex;flex-wrap:wrap;gap:2em}
canvas{touch-action:none;cursor:grab;border:1px solid #ddd}td,th{text-align:left;padding:0 1em 0 0;vertical-align:top}
caption{text-align:left;font-weight:bold;padding-bottom:.5em}</style></head>
<body><div><canvas id="view" width="640" height="640" role="img" aria-label="@title@"></canvas>@legend@<p>@help@</p></div>@table@
<script>
const lines = @lines@, colors = @colors@, widths = @widths@, planar = @planar@;
const canvas = document.getElementById("view"), pen = canvas.getContext("2d");
const all = lines.flatMap(line => line[1]), size = planar ? 2 : 3;
const range = [...Array(size).keys()].map(a => [Math.min(...all.map(p => p[a])), Math.max(...all.map(p => p[a]))]);
const middle = range.map(r => (r[0] + r[1]) / 2);
const reach = Math.max(1e-9, ...all.map(p => Math.hypot(...p.map((v, a) => v - middle[a]))));
let azimuth = 35 * Math.PI / 180, height = 20 * Math.PI / 180, zoom = 1;
function seen(p) {
  const [x, y, z] = p.map((v, a) => v - middle[a]);
  if (planar) return [x, -y];
  const depth = x * Math.sin(azimuth) + y * Math.cos(azimuth);
  return [x * Math.cos(azimuth) - y * Math.sin(azimuth), -(z * Math.cos(height) + depth * Math.sin(height))];
}
function draw() {
  const scale = zoom * 300 / reach;
  pen.clearRect(0, 0, 640, 640);
  pen.lineJoin = pen.lineCap = "round";
  for (const [kind, points] of lines) {
    pen.beginPath();
    points.forEach((p, i) => { const [x, y] = seen(p); pen[i ? "lineTo" : "moveTo"](320 + scale * x, 320 + scale * y); });
    pen.strokeStyle = colors[kind]; pen.lineWidth = 2 * widths[kind]; pen.setLineDash(kind === "slack" ? [6, 6] : []); pen.stroke();
  }
}
canvas.addEventListener("pointermove", e => {
  if (!e.buttons || planar) return;
  azimuth += e.movementX / 100;
  height = Math.max(-1.57, Math.min(1.57, height + e.movementY / 100));
  draw();
});
canvas.addEventListener("wheel", e => { e.preventDefault(); zoom *= Math.exp(-e.deltaY / 500); draw(); }, {passive: false});
draw();
</script></body></html>
"""


def page(robot: Robot, answer: Any) -> str:
    shape = shape_of(robot, answer)
    lines = polylines(shape)
    is_planar = all(len(point) == 2 for _, line in lines for point in line)
    if hasattr(answer, "answer"):
        answer = answer.answer
    values = {
        "title": html.escape(robot.name),
        "legend": legend(pulls(shape)),
        "help": "The wheel zooms." if is_planar else "Drag to turn, the wheel zooms.",
        "table": table(_caption(answer), list(rows_of(answer))) if answer is not None else "",
        "lines": json.dumps(lines), "colors": json.dumps(COLORS), "widths": json.dumps(WIDTHS), "planar": json.dumps(is_planar),
    }
    text = _PAGE
    for name, value in values.items():
        text = text.replace(f"@{name}@", value.replace("</", "<\\/") if name == "lines" else value)
    return text


def save(robot: Robot, answer: Any, path: str | os.PathLike[str]) -> None:
    text = page(robot, answer)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
