"""A service starts without what it never does itself."""

import subprocess
import sys


def test_nothing_that_reads_files_or_plays_twins_is_loaded_with_a_service() -> None:
    others = {"torch", "polars", "yaml", "scipy.special", "scipy.linalg"}
    others |= {"rga.diagnosis", "rga.detection.monitor", "rga.twin.runner", "rga.twin.digital_twin"}
    code = "import sys, rga.dashboard.app, rga.operation.service;"
    code += f"print(*({others!r} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == []
