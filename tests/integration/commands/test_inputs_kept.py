"""An output that would replace what a command reads is refused, and the input stays."""

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from conftest import Outcome

TEXTS = {
    "low.json": '{"low": {"kind": "support_settlement", "support": "east", "dof": "uz", '
    '"displacement": -0.002}}',
    "list.csv": "name,model,record\ndata,data/model.json,record.csv\n",
    "out/summary.csv": "name,model,record\nA,../model.json,../record.csv\n",
    "contexts.csv": "temperature,west load,east load\n10,20,20\n",
    "bar.tcl": "model basic -ndm 2 -ndf 2\nnode 1 0 0\nnode 2 1 0\nfix 1 1 1\nfix 2 0 1\n"
    "uniaxialMaterial Elastic 1 2e11\nelement truss 1 1 2 0.01 1\n",
    "data/import.toml": 'files = ["values.csv"]\n',
}

#: command lines, and the input that each would replace
COMMANDS = {
    "check": ("check model.json record.csv --json model.json", "model.json"),
    "check, a record": ("check model.json record.csv --json record.csv", "record.csv"),
    "check, a mapping": ("check model.json data --json data/import.toml", "data/import.toml"),
    "check, what a mapping names": (
        "check model.json data --json data/values.csv",
        "data/values.csv",
    ),
    "check, by another name": ("check model.json record.csv --json link.json", "model.json"),
    "whatif": ("whatif model.json --set temperature=20 --json model.json", "model.json"),
    "whatif, an effect": ("whatif model.json --add low.json --json low.json", "low.json"),
    "simulate": ("simulate model.json contexts.csv -o contexts.csv", "contexts.csv"),
    "results": ("results model.json contexts.csv -o contexts.csv", "contexts.csv"),
    "import": ("import bar.tcl -o link.tcl.json --units kN,m", "bar.tcl"),
    "import-record": (
        "import-record record.csv --model model.json -o record.csv --force",
        "record.csv",
    ),
    "diagnose": ("diagnose model.json record.csv -o .", "model.json"),
    "diagnose-many": ("diagnose-many list.csv -o . --workers 1", "data/model.json"),
    "diagnose-many, its list": ("diagnose-many out/summary.csv -o out", "out/summary.csv"),
    "run": ("run model.json record.csv -o . --settings settings.json", "model.json"),
    "plan": ("plan model.json found -o found/findings.json", "found/findings.json"),
    "plan, its model": ("plan model.json found --json model.json", "model.json"),
}


@pytest.fixture(scope="module")
def given(small_stream: Callable[..., Path], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with inputs of every command, and what a diagnosis found."""
    from rga.diagnosis import diagnose
    from rga.model import load_model
    from rga.records import load_record

    folder = tmp_path_factory.mktemp("given") / "all"
    shutil.copytree(small_stream(rows=100), folder)
    for name in ("data/model.json", "data/values.csv"):
        (folder / name).parent.mkdir(exist_ok=True)
        source = "model.json" if name.endswith("json") else "record.csv"
        shutil.copy(folder / source, folder / name)
    for name, text in TEXTS.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    (folder / "link.json").symlink_to("model.json")
    (folder / "link.tcl.json").symlink_to("bar.tcl")
    model = load_model(folder / "model.json")
    diagnose(model, load_record(folder / "record.csv", model)).write(folder / "found")
    return folder


def contents() -> dict[str, bytes]:
    return {str(path): path.read_bytes() for path in Path().rglob("*") if path.is_file()}


@pytest.mark.parametrize("name", COMMANDS)
def test_an_input_is_not_written_over(
    name: str,
    given: Path,
    tmp_path: Path,
    rga: Callable[..., Outcome],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    shutil.copytree(given, tmp_path / "here", symlinks=True)
    monkeypatch.chdir(tmp_path / "here")
    line, lost = COMMANDS[name]
    before = contents()
    assert lost in before
    outcome = rga(*line.split())
    assert outcome.code == 2
    assert "would replace a file that was read" in outcome.err
    assert outcome.err.count("error") == 1
    assert contents() == before


def test_results_of_an_earlier_command_are_replaced(
    given: Path, tmp_path: Path, rga: Callable[..., Outcome], monkeypatch: pytest.MonkeyPatch
) -> None:
    shutil.copytree(given, tmp_path / "here", symlinks=True)
    monkeypatch.chdir(tmp_path / "here")
    for _ in range(2):
        assert rga(*["check", "model.json", "record.csv", "--json", "checked.json"]).code == 0
        assert rga(*["diagnose", "model.json", "record.csv", "-o", "found"]).code == 0
        assert rga(*["simulate", "model.json", "contexts.csv", "-o", "simulated.csv"]).code == 0
