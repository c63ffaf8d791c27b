"""Settings of the site; ``python -m tools.make_site`` builds it."""

from fdvv import __version__

project = "fdvv"
author = "The fdvv authors"
copyright = author
release = version = __version__
extensions = ["myst_parser"]
root_doc = "index"
html_theme = "furo"
html_title = f"fdvv {version}"
html_copy_source = False
html_show_sourcelink = False
html_static_path = ["_static"]
html_css_files = ["site.css"]
myst_heading_anchors = 6
highlight_language = "text"
# a word of a paper in a code block is no Python, and shortened JSON is no JSON
suppress_warnings = ["misc.highlighting_failure"]
