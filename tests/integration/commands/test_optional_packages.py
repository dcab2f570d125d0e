"""What needs neither torch nor a database works without them; what does says what to install."""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

from rga.lazy import EXTRAS

WITHOUT = f"""
import sys
from importlib.abc import MetaPathFinder

class Missing(MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in {set(EXTRAS)!r}:
            raise ModuleNotFoundError(f"No module named {{name!r}}", name=name)

sys.meta_path.insert(0, Missing())
"""


def without(code: str, *arguments: Path) -> subprocess.CompletedProcess[str]:
    """Code run in a process in which no optional package can be imported."""
    command = [sys.executable, "-c", WITHOUT + code, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_the_front_is_light() -> None:
    code = "import sys, time\nbegan = time.process_time()\nimport rga\n"
    code += "print(time.process_time() - began, 'torch' in sys.modules)"
    seconds, heavy = [], set()
    for _ in range(3):
        done = subprocess.run(
            [sys.executable, "-c", code], capture_output=True, text=True, check=True
        )
        took, torch = done.stdout.split()
        seconds.append(float(took))
        heavy.add(torch)
    assert min(seconds) < 0.2
    assert heavy == {"False"}


def test_a_model_is_simulated_diagnosed_and_watched_without_them(
    two_bars: dict[str, Any], tmp_path: Path
) -> None:
    (tmp_path / "model.json").write_text(json.dumps(two_bars), encoding="utf-8")
    code = """
import numpy as np, rga
import rga.cli, rga.detection, rga.inference.joint.infer, rga.jobs.batch, rga.planning.planner
import rga.report
from pathlib import Path
folder = Path(sys.argv[1])
model = rga.load_model(folder / "model.json")
draw, rows = np.random.default_rng(1), 60
contexts = {"temperature": draw.uniform(0, 20, rows), "load": draw.uniform(0, 1e5, rows)}
noise = draw.standard_normal((rows, 2)) * [0.01, 0.5]
readings, sensors = rga.Simulator(model).predict(contexts) + noise, tuple(model.sensors)
record = rga.Record(60.0 * np.arange(rows), 0.0, "seconds", sensors, readings, contexts)
rga.diagnose(model, record).write(folder / "out")
print(sorted(path.name for path in (folder / "out").iterdir()))
"""
    done = without(code, tmp_path)
    assert done.stderr == ""
    assert done.stdout.strip() == "['findings.json', 'model.json', 'report.html']"


def test_what_is_missed_is_reported(model_file: Path) -> None:
    missed = {
        "rga.Simulator(rga.load_model(sys.argv[1])).as_torch()": ("torch", "networks"),
        "from rga.inference import train": ("torch", "networks"),
        "rga.Twin": ("sqlalchemy", "twin"),
        "rga.run": ("sqlalchemy", "twin"),
        "from rga.twin import carry_out": ("sqlalchemy", "twin"),
    }
    code = f"""
import rga
for use in {list(missed)!r}:
    try:
        exec(use)
    except rga.errors.MissingPackageError as error:
        print(error)
rga.Twin
"""
    done = without(code, model_file)
    said = [
        f'{package} is not installed: pip install "rga[{extra}]"'
        for package, extra in missed.values()
    ]
    assert done.stdout.splitlines() == said
    assert done.returncode == 1
    assert done.stderr.splitlines()[-1] == f"rga.errors.MissingPackageError: {said[2]}"


def test_a_command_says_it_in_one_line(model_file: Path, tmp_path: Path) -> None:
    code = "from rga.cli import main\nmain(['replay', sys.argv[1]])"
    done = without(code, tmp_path)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert "is not installed: pip install" in done.stderr
