"""Packets that have arrived: kept on the disk, known from each other, and accounted for."""
