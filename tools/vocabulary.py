"""Writes what docs/reference/vocabulary.md says of the kinds of rga anew, from their classes."""

from pathlib import Path

from rga.model.vocabulary import updated

PAGE = Path(__file__).parents[1] / "docs" / "reference" / "vocabulary.md"

if __name__ == "__main__":
    PAGE.write_text(updated(PAGE.read_text()))
