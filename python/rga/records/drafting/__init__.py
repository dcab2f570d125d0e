"""A first `import.toml` from the files of loggers: what is guessed of them, and what is doubted."""

from rga.records.drafting.draft import MappingDraft, draft_mapping

__all__ = ["MappingDraft", "draft_mapping"]
