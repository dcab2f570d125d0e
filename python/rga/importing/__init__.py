"""Models of other programs, read into model files, and all that is said about them."""

from rga.importing.imported import ImportedModel
from rga.importing.importer import import_model
from rga.importing.notes import ImportNote, ImportRefused

__all__ = ["ImportNote", "ImportRefused", "ImportedModel", "import_model"]
