"""The blind challenge: effects hidden by seed, each beside its null twin, diagnosed and scored.

The cases come from `rga_bench.synthetic`, which shares no code with the simulator: reality is a
truss or a frame with scatter in every member, gains in every channel and coloured noise.
"""
