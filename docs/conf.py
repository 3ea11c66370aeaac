"""Sphinx: the documents and the interface of the Python package."""

import os
import re
from importlib import metadata
from pathlib import Path

DOCS = Path(__file__).parent
REPOSITORY = "https://github.com/asperity-contact/asperity/blob/main"

project = "asperity"
author = "the asperity founders"
copyright = "the asperity founders"
try:
    release = metadata.version("asperity")
except metadata.PackageNotFoundError:
    release = ""

extensions = ["sphinx.ext.autodoc", "sphinx.ext.autosummary", "numpydoc", "myst_nb"]
exclude_patterns = ["_build", "notebooks/_*"]
templates_path = ["_templates"]
html_title = "asperity"
html_theme_options = {"description": "Contact of two rough surfaces that press together and move", "page_width": "1100px"}

# The documents are read on GitHub, too, which makes anchors of headings in the same way.
myst_heading_anchors = 4
myst_enable_extensions = ["dollarmath"]

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
    """Links to files of the repository that are no documents lead to the repository."""
    folder = (DOCS / name).parent

    def leads(link):
        target = Path(os.path.normpath(folder / link[1]))
        if DOCS in target.parents or not target.exists():
            return link[0]
        return f"]({REPOSITORY}/{target.relative_to(DOCS.parent).as_posix()}{link[2]})"

    source[0] = re.sub(r"\]\((\.\./[^)#\s]+)(#[^)\s]*)?\)", lambda link: leads([link[0], link[1], link[2] or ""]), source[0])


def without_aliases(app, what, name, member, skip, options):
    """The fields of named tuples are told by their classes."""
    return True if (getattr(member, "__doc__", None) or "").startswith("Alias for field number") else None


def setup(app):
    app.connect("autodoc-skip-member", without_aliases)
    app.connect("source-read", links_out_of_the_documents)
    return {"parallel_read_safe": True}
