"""The samples that `rga example` writes: structures of the generators, with files as loggers make.

`python -m rga_bench.samples DIR` makes them anew, one archive each; what is shipped lies beside
`rga.samples`. Their truth comes from the generators' own physics, which know nothing of rga's.
"""
