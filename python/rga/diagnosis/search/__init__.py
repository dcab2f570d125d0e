"""The search for causes: hypotheses, screening, evidence, change points."""
