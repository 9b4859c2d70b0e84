"""The site of all pages. tools/site.py lays its sources out and runs Sphinx."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))  # docstrings.py
project = "sinew"
extensions = ["myst_parser", "sphinx.ext.autodoc", "docstrings"]
root_doc = "index"
exclude_patterns = ["docs/site", "docs/api"]
myst_heading_anchors = 4
highlight_language = "text"
html_theme = "alabaster"
html_theme_options = {"description": "Mechanics of continuum robots", "fixed_sidebar": True, "page_width": "72em", "body_max_width": "58em"}
html_show_sphinx = html_show_copyright = False
html_copy_source = False
autodoc_default_options = {"members": True, "inherited-members": "Mapping, ValueError, IntEnum", "undoc-members": False,
                           "exclude-members": "layout, run, with_traceback, add_note"}
autodoc_member_order = "bysource"
python_use_unqualified_type_names = True
html_static_path = [str(pathlib.Path(__file__).parent / "site.css")]
html_css_files = ["site.css"]
