"""Shear moduli of files, as the ratio of Poisson that model files have."""


def poisson(E: float, G: float | None) -> tuple[float, float]:
    """Poisson's ratio that gives G, and what torsion and shear constants are to be scaled by.

    A ratio is 0.3, and the scale not 1, where G is none that an isotropic material has.
    """
    if not G:
        return 0.3, 1.0
    nu = E / (2 * G) - 1
    return (nu, 1.0) if -0.99 < nu < 0.499 else (0.3, G * 2.6 / E)
