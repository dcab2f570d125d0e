"""Live operation, measured: what is lost, what a packet costs, how soon a row is seen."""
