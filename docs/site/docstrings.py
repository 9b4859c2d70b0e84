"""An extension of Sphinx: docstrings of the module sinew, which are written for help(), as reStructuredText.

Paragraphs; indented lines `name (kind) [unit]: text` become lists of parameters; other indented lines are code. `Name` of a
class or a method is a link. Names are those of the package, wherever in it they are defined.
"""
import re
import textwrap

from docutils import nodes

ENTRY = re.compile(r"(?P<names>\w+(?:, \w+)*)(?P<kind>(?: \([^:]*?\))?(?: \[[^\]]*\])?): (?P<text>.*)", re.S)
LINK = re.compile(r"(?:[A-Z]\w*(?:\.\w+)?)(?:\(\))?$")


def inline(text):
    """Prose, where nothing but backticks has a meaning."""
    parts = re.split(r"(`+[^`]+`+)", text)
    for index, part in enumerate(parts):
        word = part.strip("`")
        is_code = index % 2 == 1
        parts[index] = (f":py:obj:`{word}`" if LINK.match(word) else f"``{word}``") if is_code else re.sub(r"([\\*_|])", r"\\\1", part)
    return "".join(parts)


def block(lines):
    """Indented lines: entries or code."""
    text = textwrap.dedent("\n".join(lines))
    entries = re.split(r"\n(?=\S)", text)
    found = [ENTRY.fullmatch(re.sub(r"\s+", " ", entry)) for entry in entries]
    if not all(found):
        return [".. code-block:: python", "", *("   " + line for line in text.splitlines()), ""]
    made = []
    for entry in found:
        names = ", ".join(f"**{name}**" for name in entry["names"].replace("_", r"\_").split(", "))
        kind = f" :entry-kind:`{entry['kind'].strip()}`" if entry["kind"] else ""
        made += [f"* {names}{kind}: {inline(entry['text'])}"]
    return [*made, ""]


def written(lines):
    made, inside = [], []
    for line in [*lines, ""]:
        if line.startswith("    "):
            inside.append(line)
            continue
        if not line and inside and made:  # a block may have empty lines in it
            inside.append(line)
            continue
        if inside:
            made += ["", *block(inside[:max(i for i, text in enumerate(inside) if text) + 1])]
            inside = []
        made.append(inline(line))
    return made + (["", *block([line for line in inside if line])] if inside else [])


def on_docstring(app, what, name, of, options, lines):
    lines[:] = written(lines)


def on_signature(app, what, name, of, options, signature, returned):
    """The fields of a question are listed below it; classes that users do not make have no arguments."""
    module = getattr(of, "__module__", "")
    if what == "class":
        return "", ""
    if what == "method" and module == "sinew" and hasattr(of, "__signature__"):
        first = list(of.__signature__.parameters)[1]
        return f"({first}=None, **fields)", "Answer" if name.endswith("describe") else "Answer | Columns"
    return signature, returned


def on_reference(app, env, node, content):
    """`sinew.robot.Robot`, where it is defined, is `sinew.Robot`, where users find it."""
    target = re.sub(r"^sinew\.\w+\.(?=[A-Z])", "sinew.", node.get("reftarget", ""))
    if node.get("refdomain") != "py" or target == node.get("reftarget"):
        return None
    return env.get_domain("py").resolve_xref(env, node["refdoc"], app.builder, "class", target, node, content)


def kind_role(name, raw, text, line, inliner, options=None, content=None):
    return [nodes.inline(raw, text, classes=["entry-kind"])], []


def setup(app):
    app.add_role("entry-kind", kind_role)
    app.connect("autodoc-process-docstring", on_docstring)
    app.connect("autodoc-process-signature", on_signature)
    app.connect("missing-reference", on_reference)
    return {"parallel_read_safe": True}
