#!/usr/bin/env python3
"""Runs a notebook as Jupyter does, and writes what it shows as a page of Markdown with pictures beside it.

usage: notebook.py FOLDER NOTEBOOK...        writes FOLDER/NAME.md and FOLDER/NAME_files/

An exception ends it, and so does anything written to standard error: a picture that cannot be drawn, a warning. Notebooks
are kept without outputs. Without Jupyter the exit status is 77.
"""
import pathlib
import re
import sys

PACKAGES = "python3-nbconvert python3-ipykernel python3-matplotlib"


def alone(cell):
    """Whether a cell is kept as it was written, without what it once showed."""
    return cell.cell_type != "code" or not (cell.outputs or cell.execution_count)


def complaints(notebook):
    for cell in notebook.cells:
        for output in cell.get("outputs", []):
            if output.output_type == "error" or output.get("name") == "stderr":
                yield f"the cell\n{cell.source}\nsays\n{output.get('text') or output.get('evalue')}"


def described(page):
    """Pictures are told by the heading above them."""
    heading, lines = "", []
    for line in page.splitlines():
        heading = line.lstrip("# ") if re.match("#+ ", line) else heading
        lines.append(re.sub(r"^!\[\w+\]", lambda _: f"![{heading}]", line))
    return re.sub(r"\n{3,}", "\n\n", "\n".join(lines)) + "\n"


def convert(path, folder):
    import nbformat
    from nbconvert.exporters import MarkdownExporter
    from nbconvert.preprocessors import ExecutePreprocessor
    from nbconvert.writers import FilesWriter
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    if not all(map(alone, notebook.cells)):
        return [f"{path} has outputs: clear them before it is kept"]
    ExecutePreprocessor(timeout=60, kernel_name="python3").preprocess(notebook, {"metadata": {"path": str(folder)}})
    resources = {"output_files_dir": f"{path.stem}_files", "unique_key": path.stem}
    page, resources = MarkdownExporter().from_notebook_node(notebook, resources)
    FilesWriter(build_directory=str(folder)).write(described(page), resources, notebook_name=path.stem)
    return [f"{path}: {text}" for text in complaints(notebook)]


def main():
    try:
        import ipykernel  # noqa: F401
        import matplotlib  # noqa: F401
        import nbconvert  # noqa: F401
    except ImportError:
        print(f"skipped: one of these Debian packages is not installed: {PACKAGES}")
        return 77
    folder = pathlib.Path(sys.argv[1]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    wrong = [line for path in sys.argv[2:] for line in convert(pathlib.Path(path), folder)]
    print("\n".join(wrong) or f"{folder}: {len(sys.argv) - 2} notebooks run")
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main())
