"""Area and second moments of what an outline with rounded corners encloses."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray
from rga.errors import InputError

#: y, z and the radius of a corner [m]
Corner = tuple[float, float, float]
#: chords of an arc: a quarter of a circle is then 0.01 % too small
CHORDS = 64


@dataclass(frozen=True)
class Enclosed:
    """What an outline encloses.

    Attributes:
        area: [m2].
        y, z: the centroid [m].
        about_y, about_z, product: integrals of z^2, y^2 and y z about the centroid [m4].
    """

    area: float
    y: float
    z: float
    about_y: float
    about_z: float
    product: float


def enclosed(corners: Sequence[Corner]) -> Enclosed:
    """What an outline encloses: integrals over a polygon by Green's theorem.

    Args:
        corners: in order, in either sense of turning.

    >>> whole = enclosed([(0.0, 0.0, 0.0), (0.3, 0.0, 0.0), (0.3, 0.6, 0.0), (0.0, 0.6, 0.0)])
    >>> round(whole.area, 12), round(whole.z, 12), round(whole.about_y, 12)
    (0.18, 0.3, 0.0054)
    """
    y, z = rounded(corners).T
    next_y, next_z = np.roll(y, -1), np.roll(z, -1)
    cross = y * next_z - next_y * z
    area = cross.sum() / 2
    centre_y = ((y + next_y) @ cross) / (6 * area)
    centre_z = ((z + next_z) @ cross) / (6 * area)
    about_y = ((z**2 + z * next_z + next_z**2) @ cross) / 12
    about_z = ((y**2 + y * next_y + next_y**2) @ cross) / 12
    product = ((2 * y * z + y * next_z + next_y * z + 2 * next_y * next_z) @ cross) / 24
    turning = np.sign(area)
    return Enclosed(
        float(abs(area)),
        float(centre_y),
        float(centre_z),
        float(turning * about_y - abs(area) * centre_z**2),
        float(turning * about_z - abs(area) * centre_y**2),
        float(turning * product - abs(area) * centre_y * centre_z),
    )


def rounded(corners: Sequence[Corner]) -> FloatArray:
    """The outline as a polygon, float[points, 2] [m]; a round corner is an arc of chords.

    Raises:
        InputError: a radius is larger than the sides beside the corner allow.
    """
    points = np.array([corner[:2] for corner in corners])
    radii = np.array([corner[2] for corner in corners])
    to, on = np.roll(points, 1, axis=0) - points, np.roll(points, -1, axis=0) - points
    sides = np.linalg.norm(on, axis=1)
    to, on = to / np.linalg.norm(to, axis=1)[:, None], on / sides[:, None]
    half = np.arccos(np.clip((to * on).sum(axis=1), -1, 1)) / 2
    # From the corner to where its arc begins.
    cut = radii / np.tan(half)
    tight = cut + np.roll(cut, -1) > sides * (1 + 1e-9)
    if tight.any():
        worst = radii[tight | np.roll(tight, 1)].max()
        raise InputError(f"a radius of {worst:g} m does not fit", "section", "give a smaller one")
    pieces = []
    for point, radius, ways, angle in zip(
        points, radii, np.stack([to, on], axis=1), half, strict=True
    ):
        if radius == 0:
            pieces.append(point[None])
            continue
        middle = ways.sum(axis=0)
        centre = point + middle / np.linalg.norm(middle) * radius / np.sin(angle)
        first, last = point + ways * radius / np.tan(angle) - centre
        # An arc seen from its centre: what is left of a half turn.
        whole = np.pi - 2 * angle
        turn = np.linspace(0, whole, CHORDS + 1)[:, None]
        arc = (np.sin(whole - turn) * first + np.sin(turn) * last) / np.sin(whole)
        pieces.append(centre + arc)
    return np.concatenate(pieces)
