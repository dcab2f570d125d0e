"""The pages of a service, one a file: plain data for their templates."""
