"""How many values a file may hold by its size: measurements are noise, which hardly compresses."""

#: values that any file may hold, and how many more a byte of a larger one
MOST_VALUES, MOST_A_BYTE = 10_000_000, 100


def most_values(size: int) -> int:
    """Values beyond which a file holds no measurements.

    Args:
        size: of the file [bytes].

    >>> most_values(1000), most_values(1_000_000)
    (10000000, 100000000)
    """
    return max(MOST_VALUES, MOST_A_BYTE * size)
