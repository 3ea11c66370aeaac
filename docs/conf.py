"""Sphinx: the documents and the interface of the Python package."""

import os
import re
from importlib import metadata
from pathlib import Path

from docutils.nodes import SkipNode
from latex2mathml.converter import convert

DOCS = Path(__file__).parent

project = "asperity"
author = "the asperity founders"
copyright = "the asperity founders"
try:
    release = metadata.version("asperity")
except metadata.PackageNotFoundError:
    release = ""

extensions = ["sphinx.ext.autodoc", "sphinx.ext.autosummary", "numpydoc", "sphinx_design", "myst_nb"]
exclude_patterns = ["_build", "notebooks/_*"]
templates_path = ["_templates"]

html_theme = "pydata_sphinx_theme"
html_title = "asperity"
html_static_path = ["_static"]
html_css_files = ["asperity.css"]
html_show_sourcelink = False
html_theme_options = {
    "logo": {"text": "asperity"},
    "navbar_end": ["theme-switcher"],
    "navbar_persistent": ["search-button"],
    "header_links_before_dropdown": 7,
    "show_toc_level": 2,
    "secondary_sidebar_items": {"**": ["page-toc"], "index": []},
    "article_footer_items": ["prev-next"],
    "show_prev_next": False,
    "footer_start": ["copyright"],
    "footer_end": [],
    "pygments_light_style": "a11y-high-contrast-light",
    "pygments_dark_style": "a11y-high-contrast-dark",
}
html_sidebars = {"index": [], "start": [], "gallery": []}

# Formulas are MathML, which browsers draw themselves: no script is fetched.
html_math_renderer = "mathml"

# The documents are read on the pages of a repository too, which make anchors of headings in the same way.
myst_heading_anchors = 4
myst_enable_extensions = ["colon_fence", "dollarmath"]
myst_update_mathjax = False

# A notebook that fails fails the build; a cell may take as long as a slow machine needs.
nb_execution_mode = "cache"
nb_execution_raise_on_error = True
nb_execution_timeout = 180
nb_merge_streams = True

autodoc_typehints = "signature"
autodoc_member_order = "bysource"
autosummary_generate = True
numpydoc_show_class_members = False
numpydoc_xref_param_type = False


def links_out_of_the_documents(app, name, source):
    """Turns links to files outside the documents into the text of the link."""
    folder = (DOCS / name).parent

    def text_alone(link):
        target = Path(os.path.normpath(folder / link[2]))
        return link[0] if DOCS in target.parents or not target.exists() else link[1]

    source[0] = re.sub(r"(?<!!)\[([^\]\n]+)\]\((\.\./[^)#\s]+)(?:#[^)\s]*)?\)", text_alone, source[0])


def without_fetched_icons(app, page, template, context, doctree):
    """Takes the icons of an animation's buttons from the theme, not from the network."""
    context["body"] = re.sub(r'<link rel="stylesheet"\s+href="https://[^"]*font-awesome[^"]*">', "", context.get("body", ""))


def without_aliases(app, what, name, member, skip, options):
    """Skips the fields of named tuples, which their classes explain."""
    return True if (getattr(member, "__doc__", None) or "").startswith("Alias for field number") else None


def without_signature(app, what, name, member, options, signature, returned):
    """Hides the signatures of classes without documented parameters: users do not call them."""
    if what == "class" and signature and "Parameters\n" not in (member.__doc__ or ""):
        return "", returned
    return None


def inline_formula(self, node):
    self.body.append(convert(node.astext()))
    raise SkipNode


def displayed_formula(self, node):
    self.body.append(f'<div class="formula">{convert(node.astext(), display="block")}</div>')
    raise SkipNode


def setup(app):
    app.add_html_math_renderer("mathml", (inline_formula, None), (displayed_formula, None))
    app.connect("autodoc-skip-member", without_aliases)
    app.connect("autodoc-process-signature", without_signature)
    app.connect("source-read", links_out_of_the_documents)
    app.connect("html-page-context", without_fetched_icons)
    return {"parallel_read_safe": True}
