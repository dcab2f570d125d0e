"""Names from a file, fit for a figure."""


def label(name: str, longest: int = 24) -> str:
    """A name from a file, fit for a figure: one line of printable text, not too long."""
    text = "".join(c if c.isprintable() else " " for c in name)
    return text if len(text) <= longest else text[: longest - 1] + "…"
