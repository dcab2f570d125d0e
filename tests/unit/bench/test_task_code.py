"""Outcomes depend on the code that their task imports, and on no other."""

import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import pytest

import rga
from rga.errors import InputError
from rga_bench.diagnosis import judge as diagnosis
from rga_bench.faults import judge as faults
from rga_bench.ledger import Ledger
from rga_bench.task_code import ROOT, code_hash, imported_files

#: a small house of both packages; `task` reaches all but the last four of its files
FILES = {
    "rga/__init__.py": """
        from rga.lazy import opening
        __getattr__ = opening(__name__, {"Simulator": "rga.simulation", "run": "rga.jobs"})
    """,
    "rga/lazy.py": "",
    "rga/simulation/__init__.py": "from rga.simulation.solver import Simulator",
    "rga/simulation/solver.py": "from rga import _core, kinds",
    "rga/_core.abi3.so": "compiled",
    "rga/kinds/__init__.py": """
        from pkgutil import walk_packages
        for module in walk_packages(__path__, f"{__name__}."):
            __import__(module.name)
    """,
    "rga/kinds/loads/__init__.py": "",
    "rga/kinds/loads/creep.py": "",
    "rga/networks/__init__.py": "",
    "rga/networks/training.py": "",
    "rga_bench/__init__.py": "",
    "rga_bench/beside.py": "",
    "rga_bench/task.py": """
        from typing import TYPE_CHECKING
        import numpy as np
        from rga import Simulator
        from .beside import something
        if TYPE_CHECKING:
            from rga_bench.types_only import Shape
        def run(task):
            try:
                from rga.networks import training
            except ImportError:
                import rga
            return rga.run(task)
    """,
    "rga_bench/types_only.py": "",
    "rga_bench/tables.py": "from rga_bench.task import run",
    "rga/jobs/__init__.py": "",
    "rga/report.py": "",
}
#: files that are open once a module is imported
OPENED = """
import importlib, sys
from rga_bench.task_code import PACKAGES
own = set(sys.modules)
importlib.import_module(sys.argv[1])
for name in set(sys.modules) - own | {"rga"}:
    if name.partition(".")[0] in PACKAGES:
        print(sys.modules[name].__file__)
"""

#: of rga and its benchmarks as they are
files_of = cache(imported_files)


@dataclass(frozen=True)
class Kept:
    """An outcome."""

    id: str


@pytest.fixture
def root(tmp_path: Path) -> Path:
    for name, text in FILES.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        lines = text.splitlines()
        path.write_text("\n".join(line.removeprefix("        ") for line in lines))
    return tmp_path


def test_imports_are_followed_wherever_they_stand(root: Path) -> None:
    found = {path.relative_to(root).as_posix() for path in imported_files("rga_bench.task", root)}
    assert found == set(list(FILES)[:-4])


@pytest.mark.parametrize("name", FILES)
def test_an_outcome_is_of_the_code_that_its_task_imports(name: str, root: Path) -> None:
    def ledger() -> Ledger[Kept]:
        return Ledger(root / "kept", Kept, {"code": code_hash("rga_bench.task", root)})

    ledger().add(Kept("one"))
    with (root / name).open("a") as file:
        file.write("\n# another version\n")
    if name in list(FILES)[:-4]:
        with pytest.raises(InputError, match="of another version: code"):
            ledger()
    else:
        assert ledger().outcomes == {"one": Kept("one")}


@pytest.mark.parametrize("task", [diagnosis.judge, faults.judge])
def test_a_diagnosis_depends_on_no_page(task: Callable[..., object]) -> None:
    files = files_of(task.__module__)
    folders = {path.relative_to(ROOT).as_posix().rpartition("/")[0] for path in files}
    assert {"rga/diagnosis", "rga/simulation/paths", "rga_bench/synthetic", "rga"} <= folders
    assert not [one for one in folders if one.startswith(("rga/report", "rga/cli", "rga/twin"))]
    assert ROOT / "rga_bench/diagnosis/tables.py" not in files
    assert any(path.stem.startswith("_core") for path in files)


def test_what_a_task_opens_is_among_its_files() -> None:
    """An interpreter of its own says what importing a task has opened."""
    command = [sys.executable, "-c", OPENED, diagnosis.__name__]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    opened = {Path(line) for line in done.stdout.splitlines()}
    assert Path(rga.__file__) in opened
    assert opened <= files_of(diagnosis.__name__)
