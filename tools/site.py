#!/usr/bin/env python3
"""Makes the site: all pages by Sphinx and MyST, and under api/ the C++ and C reference by Doxygen.

    tools/site.py FOLDER [NOTEBOOKS]        writes FOLDER/html/index.html

NOTEBOOKS has the pages that tools/notebook.py wrote of those of examples/notebooks. The reference of the Python module is of
the one that Python finds (PYTHONPATH); where it finds none, its page says so.

Nothing may be warned of: links and anchors between pages hold, and every page is in the table of contents. Pages stay readable
on their own; here they are copied, with what they link to. Without these programs the exit status is 77.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PYTHON = "/usr/bin/python3" if os.access("/usr/bin/python3", os.X_OK) else sys.executable  # Debian's own has Debian's Sphinx
PAGES = ["README.md", "CHANGELOG.md", "CONTRIBUTING.md", "CITATION.cff", "LICENSE", "docs", "examples", "robots", "studies",
         *(str(page.relative_to(ROOT)) for page in ROOT.glob("firmware/**/*.md"))]
PACKAGES = "doxygen python3-sphinx python3-myst-parser"


def is_there():
    modules = [PYTHON, "-c", "import sphinx, myst_parser"]
    return shutil.which("doxygen") and subprocess.run(modules, capture_output=True, check=False).returncode == 0


NO_MODULE = "The module was not built where this site was made: `cmake --build --preset dev` builds it.\n"


def has_module():
    return subprocess.run([PYTHON, "-c", "import sinew"], capture_output=True, check=False).returncode == 0


def lay_out(source, notebooks):
    shutil.rmtree(source, ignore_errors=True)
    source.mkdir(parents=True)
    for name in PAGES:
        (source / name).parent.mkdir(parents=True, exist_ok=True)
        (shutil.copytree if (ROOT / name).is_dir() else shutil.copy)(ROOT / name, source / name)
    shutil.copy(ROOT / "docs/site/index.md", source)
    readme = source / "README.md"
    readme.write_text(re.sub(r"\]\((docs/theory|docs/adr)\)", r"](\1/README.md)", readme.read_text()))
    if not has_module():
        page = source / "docs/python-reference.md"
        page.write_text(page.read_text().partition("<!-- reference")[0] + NO_MODULE)
    pages = source / "examples/notebooks"
    if notebooks and notebooks.is_dir():
        shutil.copytree(notebooks, pages, dirs_exist_ok=True)
    for page in pages.glob("*.md"):  # links from notebook to notebook lead to what they showed, where they were run
        page.write_text(re.sub(r"\((\w+)\.ipynb\)", lambda link: f"({link[1]}.md)" if (pages / f"{link[1]}.md").exists() else link[0],
                               page.read_text()))
    if not (source / "docs/adr/README.md").exists():
        (source / "docs/adr/README.md").write_text("# Decisions\n\n```{toctree}\n:glob:\n\n0*\n```\n")


def main():
    if not is_there():
        print(f"skipped: one of these Debian packages is not installed: {PACKAGES}")
        return 77
    folder = pathlib.Path(sys.argv[1]).resolve()
    lay_out(folder / "source", pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else None)
    (folder / "reference").mkdir(exist_ok=True)
    shutil.rmtree(folder / "html", ignore_errors=True)
    sphinx = [PYTHON, "-m", "sphinx", "-q", "-W", "--keep-going", "-c", ROOT / "docs/site", "-d", folder / "doctrees",
              folder / "source", folder / "html"]
    done = subprocess.run(sphinx, check=False)
    subprocess.run(["doxygen", "docs/api/Doxyfile"], cwd=ROOT, env={**os.environ, "SINEW_API_FOLDER": str(folder / "reference")}, check=True)
    shutil.copytree(folder / "reference/html", folder / "html/api")
    print(f"{folder}/html/index.html")
    return done.returncode


if __name__ == "__main__":
    sys.exit(main())
