"""The site of all pages. tools/site.py lays its sources out and runs Sphinx."""
project = "sinew"
extensions = ["myst_parser"]
root_doc = "index"
exclude_patterns = ["docs/site", "docs/api"]
myst_heading_anchors = 4
highlight_language = "text"
html_theme = "alabaster"
html_theme_options = {"description": "Mechanics of continuum robots", "fixed_sidebar": True, "page_width": "72em", "body_max_width": "58em"}
html_show_sphinx = html_show_copyright = False
html_copy_source = False
