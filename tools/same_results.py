"""Do two commits give the same results? Findings and quick benchmark tables, value by value.

    python tools/same_results.py write REPOSITORY DIRECTORY [--data SHARED]
    python tools/same_results.py compare DIRECTORY DIRECTORY [--within RELATIVE]

`write` runs the commands of a checkout, whose compiled core is in place: the diagnosis of the
practice cases and of the measured crossing (where SHARED holds them), the twin of the case study,
and the benchmarks in their quick form. `compare` leaves out times, versions and the machine, and
ends with exit code 1 where anything else differs.
"""

import argparse
import json
import math
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

#: what differs from run to run, or is meant to differ between commits
VOLATILE = {
    *("versions", "code", "machine", "day"),
    *("seconds", "times", "inference", "learning", "throughput"),
}
BENCHMARKS = ("diagnosis", "faults", "detector", "policies", "loi")


def write(repository: Path, folder: Path, data: Path | None) -> None:
    """Run everything with the code of a checkout."""
    folder.mkdir(parents=True)
    environment = {**os.environ, "PYTHONPATH": str(repository / "python")}

    def run(*arguments: object) -> None:
        print(*arguments, flush=True)
        command = [sys.executable, *map(str, arguments)]
        subprocess.run(command, cwd=folder, env=environment, check=True, stdout=subprocess.DEVNULL)

    for name in BENCHMARKS:
        quick = ["--quick", "--json", folder / f"{name}.json"]
        workers = [] if name in ("detector", "policies") else ["--workers", 1]
        run("-m", "rga", "benchmark", name, "--seed", 1, *quick, *workers)
    run(repository / "examples" / "case_study.py")
    if data is None:
        return
    measured = data / "measured"
    for case in sorted((measured / "practice").glob("*/model.json")):
        out = folder / f"practice-{case.parent.name}"
        run("-m", "rga", "diagnose", case, case.with_name("record.csv"), "-o", out)
    crossing = [repository / "examples/rdso45m/model.json", measured / "rdso45m/record_40kmh.txt"]
    run("-m", "rga", "diagnose", *crossing, "-o", folder / "crossing")


def differences(one: Any, other: Any, within: float, where: str = "") -> Iterator[str]:
    """What differs between two contents of JSON files."""
    if isinstance(one, dict) and isinstance(other, dict):
        for key in sorted({*one, *other} - VOLATILE):
            if key not in one or key not in other:
                yield f"{where}/{key} is in one only"
            else:
                yield from differences(one[key], other[key], within, f"{where}/{key}")
    elif isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        for number, pair in enumerate(zip(one, other, strict=True)):
            yield from differences(*pair, within, f"{where}/{number}")
    elif isinstance(one, float) and isinstance(other, float):
        if not math.isclose(one, other, rel_tol=within, abs_tol=0.0):
            yield f"{where}: {one!r} and {other!r}"
    elif one != other or type(one) is not type(other):
        yield f"{where}: {str(one)[:80]!r} and {str(other)[:80]!r}"


def compare(first: Path, second: Path, within: float) -> int:
    """Print what differs between two folders; the number of files that do."""
    kept = ("findings.json", "model.json", *(f"{name}.json" for name in BENCHMARKS))
    names = {
        path.relative_to(folder)
        for folder in (first, second)
        for path in folder.rglob("*.json")
        if path.name in kept
    }
    different = 0
    for name in sorted(names):
        if not ((first / name).is_file() and (second / name).is_file()):
            print(f"{name}: in one folder only")
            different += 1
            continue
        contents = [json.loads((folder / name).read_text()) for folder in (first, second)]
        found = list(differences(*contents, within))
        print(f"{name}: {'the same' if not found else f'{len(found)} values differ'}")
        print("".join(f"  {line}\n" for line in found[:5]), end="")
        different += bool(found)
    return different


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    commands = parser.add_subparsers(required=True, dest="command")
    writing = commands.add_parser("write")
    writing.add_argument("repository", type=Path)
    writing.add_argument("directory", type=Path)
    writing.add_argument("--data", type=Path, default=None)
    comparing = commands.add_parser("compare")
    comparing.add_argument("first", type=Path)
    comparing.add_argument("second", type=Path)
    comparing.add_argument("--within", type=float, default=0.0)
    given = parser.parse_args()
    if given.command == "write":
        data = None if given.data is None else given.data.resolve()
        write(given.repository.resolve(), given.directory.resolve(), data)
    else:
        sys.exit(1 if compare(given.first, given.second, given.within) else 0)


if __name__ == "__main__":
    main()
