"""Draw a bridge with an effect hidden by a seed, diagnose its record, and say what was hidden.

    python examples/generated_bridge.py [SEED]

The record comes from physics of its own (rga_bench.synthetic); the diagnosis sees only the files.
"""

import sys
from pathlib import Path

from rga.cli import main
from rga.findings.phrases import effect_words
from rga_bench.synthetic import draw_case


def run(seed: int, folder: Path) -> None:
    """Write the case into a folder and diagnose it there."""
    case = draw_case(seed)
    case.write(folder)
    print(f"A {case.truth['bridge']} bridge, an effect hidden by seed {seed}; files in {folder}.")
    record = folder / "record.csv"
    try:
        main(["diagnose", str(folder / "model.json"), str(record), "-o", str(folder / "findings")])
    finally:  # a command leaves with its exit code
        hidden = {"kind": case.truth["kind"], **case.truth["place"]}
        if case.truth["parameter"] is not None:
            hidden[case.truth["parameter"]] = case.truth["value"]
        print(f"What was hidden: {effect_words(hidden)}.")


if __name__ == "__main__":
    chosen = int(sys.argv[1]) if len(sys.argv) > 1 else 1029
    run(chosen, Path("runs") / f"seed-{chosen}")
