"""How samples become the rows of a twin: one for each cell of a grid in time."""
