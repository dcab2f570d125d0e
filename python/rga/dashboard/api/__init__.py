"""The HTTP API of a service, under /api/v1: one file an idea, each with its router."""
