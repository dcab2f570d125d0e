"""Commands before a diagnosis: samples, imports, checks, drawings."""
