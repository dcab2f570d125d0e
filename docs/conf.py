"""How Sphinx makes a site of these pages, that needs no network: `make docs`."""

import importlib.metadata
from typing import Any

from pydantic import BaseModel

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
napoleon_use_ivar = True
napoleon_use_rtype = False
napoleon_attr_annotations = False
autodoc_default_options = {"exclude-members": "model_config, model_post_init"}
autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
autodoc_preserve_defaults = True
python_use_unqualified_type_names = True
python_maximum_signature_line_length = 88


def signature(
    app: Any, what: str, name: str, of: Any, options: Any, signature: str, returned: str
) -> tuple[str, str] | None:
    """Leaves out the signatures of what is read from files: their keys stand in the text."""
    if what == "class" and issubclass(of, BaseModel):
        return "", ""
    return None


def setup(app: Any) -> None:
    """Called by Sphinx."""
    app.connect("autodoc-process-signature", signature)
