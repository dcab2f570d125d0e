"""A service starts without what it never does itself."""

import subprocess
import sys


def test_no_diagnosis_and_no_detector_is_loaded_by_a_service() -> None:
    others = {"torch", "scipy.special", "scipy.linalg", "rga.detection.monitor"}
    others |= {"rga.diagnosis", "rga.twin.runner", "rga.twin.digital_twin"}
    code = "import sys, rga.dashboard.app, rga.operation.service;"
    code += f"print(*({others!r} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == []
