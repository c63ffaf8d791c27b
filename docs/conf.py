"""Settings of the site; ``make docs`` builds it (tools/make_site.py)."""

from fdvv._version import __version__

project = "fdvv"
author = "The fdvv authors"
copyright = author
release = version = __version__
extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx_click",
    "tools.site_api",
    "tools.site_navigation",
]
root_doc = "index"
html_theme = "furo"
html_title = f"fdvv {version}"
html_copy_source = False
html_show_sourcelink = False
html_static_path = ["_static"]
html_css_files = ["site.css"]
myst_heading_anchors = 6
highlight_language = "text"
autodoc_default_options = {"members": True}
autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
python_maximum_signature_line_length = 100
# a name of a paper in a code block is no Python, and shortened JSON is no JSON;
# a record and its file's record share field names
suppress_warnings = ["misc.highlighting_failure", "ref.python"]
