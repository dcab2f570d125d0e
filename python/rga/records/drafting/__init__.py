"""A first `import.toml` from the files of loggers: what is guessed of them, and what is doubted."""

from rga.records.drafting.draft import Draft, draft_mapping

__all__ = ["Draft", "draft_mapping"]
