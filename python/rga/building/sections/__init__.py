"""Sections: of bars, hollow, open and rolled ones, with the points whose stresses matter.

Everywhere the local axes are those of the model file: x along the member, y level unless the member
says otherwise, z upright. So Iy, about the level axis, resists vertical load. Depth lies along z,
width along y. A column in the plane xz bends about y as well; one in the plane yz bends about z
unless its `local_y` is [1, 0, 0].
"""
