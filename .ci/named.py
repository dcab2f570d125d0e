"""Whether the case study that `make run` has played named what was hidden in it, and no more."""

import json
import sys
from pathlib import Path

from rga_bench.synthetic import draw_stream

SEED = 3

findings = json.loads(Path(f"runs/case-study-{SEED}/twin/findings.json").read_text("utf-8"))
truth = draw_stream(SEED).truth
hidden = {"kind": truth["kind"], **truth["place"]}
named = [cause["effect"] for cause in findings["causes"]]
print(f"hidden: {hidden}; named: {named}")
if [{key: one.get(key) for key in hidden} for one in named] != [hidden]:
    sys.exit("the case study did not name what was hidden")
if abs(named[0][truth["parameter"]]["value"] / truth["value"] - 1) > 0.1:
    sys.exit(f"the case study is off: {truth['value']} was hidden")
