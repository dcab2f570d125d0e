"""Zeros of a logger: nobody declared, set over some rows only, or set again in mid-record."""
