"""The pages of the reports: what stands on them, and their writing."""
