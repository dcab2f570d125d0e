"""Findings: what a diagnosis says, as pure data; its words, its file."""
