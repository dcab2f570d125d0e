"""From numbers to findings: causes, gaps, groups and contexts as findings hold them."""
