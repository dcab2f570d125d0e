"""Files that are no models end in one clear error, whatever is in them."""

from pathlib import Path

import numpy as np
import pytest

from rga.errors import InputError
from rga.importing import import_model

SUFFIXES = (".tcl", ".py", ".s2k", ".dxf", ".xlsx", ".csv")
CONTENTS = {
    "empty": b"",
    "blank": b" \n\n",
    "binary": bytes(range(256)) * 20,
    "zeros": b"\0" * 4000,
    "latin": "Größe der Stütze §\n".encode("cp1252") * 3,
    "noise": np.random.default_rng(3).bytes(5000),
    "deep": b"{[(" * 4000,
    "packed": b"PK\x03\x04" + b"x" * 100,
}


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize("content", CONTENTS)
def test_what_is_no_model_is_one_error(tmp_path: Path, suffix: str, content: str) -> None:
    path = tmp_path / f"nodes{suffix}"
    path.write_bytes(CONTENTS[content])
    with pytest.raises(InputError) as error:
        import_model(path, units="kN, m")
    assert error.value.remedy


@pytest.mark.parametrize("name", ["missing.tcl", "folder.dxf", "model.json", "model"])
def test_what_is_no_file_of_a_kind_is_one_error(tmp_path: Path, name: str) -> None:
    (tmp_path / "folder.dxf").mkdir()
    with pytest.raises(InputError):
        import_model(tmp_path / name)


def test_a_script_of_too_many_lines_is_one_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("rga.importing.scripts.values.MOST_STEPS", 1000)
    path = tmp_path / "long.tcl"
    path.write_text("set a 1\n" * 2000, encoding="utf-8")
    with pytest.raises(InputError, match="more than 1000 steps"):
        import_model(path, units="kN, m")


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("frame.tcl", "model basic -ndm 2 -ndf 3\nnode\n"),
        ("frame.py", "import openseespy.opensees as ops\nx = (\n"),
    ],
)
def test_a_faulty_line_is_named_with_its_file(tmp_path: Path, name: str, text: str) -> None:
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as error:
        import_model(path, units="kN, m")
    assert error.value.where == f"{path}, line 2"
