"""Columns of a modal record, beside those of points and contexts."""

TIME, DURATION, FREQUENCY, DEVIATION, DAMPING, HINT = (
    "time", "duration", "f", "f_sd", "zeta", "mode",
)  # fmt: skip
COLUMNS = (TIME, DURATION, FREQUENCY, DEVIATION, DAMPING, HINT)
#: ending of a column with the imaginary part of a shape at a point
IMAGINARY = "_im"
