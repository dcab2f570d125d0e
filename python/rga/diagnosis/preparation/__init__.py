"""From a record to observations: broken channels out, zeros found, contexts believed."""
