"""How Sphinx makes a site of these pages, that needs no network: `make docs`."""

import importlib.metadata
import inspect
from typing import Any

from numpy.typing import ArrayLike
from pydantic import BaseModel
from sphinx.util.typing import stringify_annotation

from rga.arrays import FloatArray

project = "rga"
copyright = "the rga authors"
release = importlib.metadata.version("rga")

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx_copybutton"]

# Pages are read on a forge too: its anchors, and no more of MyST than lists of pages.
myst_heading_anchors = 3

html_theme = "furo"
html_title = "rga"
html_copy_source = False
html_show_sourcelink = False
copybutton_prompt_text = r"\$ |>>> |\.\.\. "
copybutton_prompt_is_regexp = True

# Docstrings are in Google's style, with names of code between single backticks.
default_role = "literal"
# One line of attributes may tell of several.
napoleon_custom_sections = [("Attributes", "params_style")]
napoleon_use_rtype = False
autodoc_default_options = {"exclude-members": "model_config, model_post_init"}
autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
autodoc_preserve_defaults = True
python_use_unqualified_type_names = True
python_maximum_signature_line_length = 88


#: what Sphinx writes in signatures -> how the sources call it
CALLED = {
    stringify_annotation(ArrayLike, "smart"): "ArrayLike",
    stringify_annotation(FloatArray, "smart"): "FloatArray",
    "<factory>": "...",
}


def signature(
    app: Any, what: str, name: str, of: Any, options: Any, given: str | None, returned: str | None
) -> tuple[str | None, str | None]:
    """The signature of an entry; none of what is read from files, whose keys stand in its text."""
    if what == "class" and issubclass(of, BaseModel):
        return "", ""
    for written, called in CALLED.items():
        given = given and given.replace(written, called)
        returned = returned and returned.replace(written, called)
    return given, returned


def text(app: Any, what: str, name: str, of: Any, options: Any, lines: list[str]) -> None:
    """The text of a property as it is: what stands before its first colon is no type."""
    if what == "property":
        lines[:] = [*(inspect.getdoc(of) or "").splitlines(), ""]


def setup(app: Any) -> None:
    """Called by Sphinx."""
    app.connect("autodoc-process-signature", signature)
    app.connect("autodoc-process-docstring", text, priority=600)  # after napoleon
