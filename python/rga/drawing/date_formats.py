"""How ticks of an axis of time are written, the same in any language."""

#: of ticks that are years, months, days, hours, minutes, seconds
DATES = ["%Y", "%Y-%m", "%m-%d", "%H:%M", "%H:%M", "%H:%M:%S"]
#: of ticks where the next larger one begins
ROUND_DATES = ["", "%Y", "%Y-%m", "%m-%d", "%H:%M", "%H:%M"]
#: what ticks leave out, beside the axis
BESIDE_DATES = ["", "%Y", "%Y", "%Y-%m-%d", "%Y-%m-%d", "%Y-%m-%d %H:%M"]
