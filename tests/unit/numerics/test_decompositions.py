"""Decompositions come to an end, whatever the library does."""

from typing import Any

import numpy as np
import pytest

from rga.numerics.decompositions import thin_svd


@pytest.mark.parametrize("shape", [(7, 3), (3, 7), (4, 4)])
def test_where_divide_and_conquer_gives_up(
    shape: tuple[int, int], monkeypatch: pytest.MonkeyPatch
) -> None:
    matrix = np.random.default_rng(1).standard_normal(shape)
    usual = thin_svd(matrix)

    def gives_up(*_: Any, **__: Any) -> Any:
        raise np.linalg.LinAlgError("SVD did not converge")

    monkeypatch.setattr(np.linalg, "svd", gives_up)
    u, size, across = thin_svd(matrix)
    assert u.shape == usual[0].shape
    assert across.shape == usual[2].shape
    np.testing.assert_allclose(size, usual[1], rtol=1e-12)
    np.testing.assert_allclose(u * size @ across, matrix, atol=1e-12)
