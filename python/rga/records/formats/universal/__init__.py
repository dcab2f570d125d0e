"""Universal files (UFF, UNV) of modal testing: datasets of text between lines of -1."""
