"""Points at which mode shapes are measured: what sensors there do, and what no structure makes."""
