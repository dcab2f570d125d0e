"""Draw the stream of the case study, run the twin of its bridge on it, and say what was hidden.

    python examples/case_study.py [SEED]

A pedestrian truss bridge works as on any day, then an event brings contexts that no day had, then
something in the structure changes. The record comes from physics of its own (rga_bench.synthetic);
the run sees only the files.
"""

import sys
from pathlib import Path

from rga.cli import main
from rga.findings.phrases import effect_words
from rga_bench.synthetic import Case, draw_stream


def run(seed: int, folder: Path) -> None:
    """Write the stream into a folder and run the twin on it there."""
    stream = draw_stream(seed)
    stream.write(folder)
    print(f"A stream of {len(stream.time)} rows, drawn by seed {seed}; files in {folder}.")
    record = folder / "record.csv"
    try:
        main(["run", str(folder / "model.json"), str(record), "-o", str(folder / "twin")])
    finally:  # a command leaves with its exit code
        print("\n".join(what_was_hidden(stream)))


def what_was_hidden(stream: Case) -> list[str]:
    """The drift and the structural effect of a stream, in words."""
    truth, drift = stream.truth, stream.truth["drift"]
    novel = [
        f"{name} {low:.3g} to {high:.3g} {stream.model['context'][name]['unit']}".removesuffix(" -")
        for name, (low, high) in drift["novel"].items()
        if low > drift["ordinary"][name][1] or high < drift["ordinary"][name][0]
    ]
    hidden = {"kind": truth["kind"], **truth["place"], truth["parameter"]: truth["value"]}
    return [
        f"What was hidden: {effect_words(hidden)}, from {truth['onset']:.0f} s on;",
        f"and an event, from {drift['from']:.0f} s to {drift['until']:.0f} s: {', '.join(novel)}.",
    ]


if __name__ == "__main__":
    chosen = int(sys.argv[1]) if len(sys.argv) > 1 else 3
    run(chosen, Path("runs") / f"case-study-{chosen}")
