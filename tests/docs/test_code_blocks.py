"""Blocks of Python and `sh` on README and docs run, page by page, each page as one script.

Every line of a block `text` stands in what the script printed, apart from how it is broken.
"""

import json
import shlex
import shutil
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import pytest

from documentation import PAGES, ROOT, blocks, play
from made_findings import cause, findings
from rga.model import load_model

EXAMPLE = ROOT / "examples" / "footbridge"
#: modules that most pages import
IMPORTED = ["documentation", "polars", "rga.cli.app", "rga.diagnosis", "rga.report", "scipy.stats"]
#: what a page takes for granted, by its name
GIVEN = {
    "docs/explanation/detection.md": "import numpy as np\n"
    "baseline, rows = np.random.default_rng(0).standard_normal((2, 200, 3))\n"
    "rows[50:, 1] += 5\n",
    "docs/results/index.md": "import numpy as np\n"
    "baseline, rows = np.random.default_rng(0).standard_normal((2, 200, 3))\n"
    'rows[50:, 1] += 5\nnames = ("D1", "D2", "S1")\n',
    "docs/explanation/joint-posterior.md": "import numpy as np, rga\n"
    'given = rga.load_model("model.json")\n'
    "draw = np.random.default_rng(0)\n"
    "low, high = np.array([one.range for one in given.context.values()]).T\n"
    "contexts = low + (high - low) * draw.random((20, len(low)))\n"
    "noisy = rga.Simulator(given).predict(dict(zip(given.context, contexts.T)))\n"
    "noise = np.array([sensor.noise for sensor in given.sensors.values()])\n"
    "noisy += noise * draw.standard_normal(noisy.shape)\n"
    "readings, tested, later = noisy, noisy, noisy\n"
    "ranges, values = np.column_stack([low, high]), contexts\n"
    "context_noise = 0.01 * (high - low)\n",
}


def written(page: Path) -> list[str]:
    """The blocks of a page that are run, as Python."""
    return [
        one.code if one.language == "python" else commands(one.code)
        for one in blocks(page)
        if one.language in ("python", "sh") and not one.reason
    ]


def commands(code: str) -> str:
    """Python that runs the commands of a block."""
    lines = [shlex.split(line, comments=True) for line in code.splitlines()]
    assert all(name == "rga" for name, *_ in lines)
    called = [f"run_command(*{words})" for _, *words in lines]
    return "\n".join(["from documentation import run_command", *called])


def shown(page: Path) -> list[str]:
    """What a page says that its blocks print."""
    return [
        " ".join(line.split())
        for one in blocks(page)
        if one.language == "text"
        for line in one.code.splitlines()
    ]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with the files that the pages name."""
    shutil.copytree(EXAMPLE, tmp_path / "examples" / "footbridge")
    shutil.copy(EXAMPLE / "model.json", tmp_path)
    rows = (EXAMPLE / "record.csv").read_text(encoding="utf-8").splitlines()
    (tmp_path / "record.csv").write_text("\n".join(rows[:61]), encoding="utf-8")
    low = {"kind": "support_settlement", "support": "abutment", "dof": "uz"}
    low["displacement"] = {"value": -0.0006, "ci90": [-0.0007, -0.0005]}
    (tmp_path / "findings").mkdir()
    content = findings(cause(low)).model_dump(mode="json")
    content["model_sha256"] = load_model(tmp_path / "model.json").sha256
    (tmp_path / "findings" / "findings.json").write_text(json.dumps(content), encoding="utf-8")
    return tmp_path


def losing(two_bars: dict[str, Any]) -> dict[str, Any]:
    """Two bars under a load, one of which loses stiffness."""
    del two_bars["context"]["temperature"], two_bars["effects"]["warmth"]
    two_bars["context"]["loss"] = {"unit": "-", "range": [0.5, 1.0]}
    loss = {"kind": "member_stiffness", "member": "west", "factor": {"context": "loss"}}
    two_bars["effects"]["loss"] = loss
    return two_bars


def where(page: Path) -> str:
    return str(page.relative_to(ROOT))


@pytest.mark.parametrize("page", [one for one in PAGES if written(one)], ids=where)
def test_a_page_runs(page: Path, folder: Path, two_bars: dict[str, Any]) -> None:
    if page.name == "simulation.md":
        (folder / "model.json").write_text(json.dumps(losing(two_bars)), encoding="utf-8")
    script = folder / "page.py"
    code = [GIVEN.get(where(page), ""), *written(page)]
    script.write_text("\n".join(code), encoding="utf-8")
    # Processes begin as copies of one that has what most pages import.
    context = get_context("forkserver")
    context.set_forkserver_preload(IMPORTED)
    process = context.Process(target=play, args=(script,))
    process.start()
    process.join()
    said = [(folder / name).read_text(encoding="utf-8") for name in ("printed", "told")]
    assert process.exitcode == 0, said[1][-2000:]
    printed = " ".join(" ".join(said).split())
    assert [line for line in shown(page) if line not in printed] == []


@pytest.mark.parametrize("page", PAGES, ids=where)
def test_what_is_not_run_is_python_all_the_same(page: Path) -> None:
    for one in blocks(page):
        if one.language == "python":
            compile(one.code, page.name, "exec")
            assert not one.reason or len(one.reason.split()) > 3


def test_most_blocks_run() -> None:
    every = [one for page in PAGES for one in blocks(page) if one.language == "python"]
    assert len([one for one in every if not one.reason]) > 2 * len(every) / 3
