"""Models of other programs, read into model files, and all that is said about them."""

from rga.importing.imported import ImportedModel
from rga.importing.importer import import_model
from rga.importing.notes import ImportRefused, Note

__all__ = ["ImportRefused", "ImportedModel", "Note", "import_model"]
