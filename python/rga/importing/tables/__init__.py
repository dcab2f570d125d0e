"""Plain tables of nodes, members, sections, materials, supports and loads."""

from rga.importing.tables.read import is_tables, read_tables

__all__ = ["is_tables", "read_tables"]
