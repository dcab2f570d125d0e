"""Verification cases of the finite-element core: JSON files with inputs and expected outputs."""

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rga import _core
from rga.bounded_files import bytes_of
from rga.simulation.verification_input import FrameCase, Json, Loads, output_arrays, point

# A reference value below this part of what the loads could cause is a zero, spelled out by the
# rounding of a 40-digit solve (-6e-36 N, say). Double precision can only be held to a zero.
ZERO = 1e-12
#: what comes of a case whose parts are not what they should be
MALFORMED = (ValueError, TypeError, AttributeError, IndexError)


@dataclass(frozen=True)
class VerificationResult:
    """What came out of one file. `worst` is the largest |x - value| / (atol + rtol |value|).

    `readable` is false for a file that is no case of this format.
    """

    name: str
    passed: bool
    worst: float
    count: int
    first_failure: str | None
    readable: bool = True


@dataclass(frozen=True)
class Check:
    """One number against its expectation."""

    what: str
    value: float
    expected: float
    tolerance: float

    def words(self) -> str:
        return (
            f"{self.what} is {self.value!r}, expected {self.expected!r} within {self.tolerance:.3g}"
        )

    @property
    def ratio(self) -> float:
        miss = abs(self.value - self.expected)
        if math.isnan(miss):
            return math.inf
        if self.tolerance > 0.0:
            return miss / self.tolerance
        return 0.0 if miss == 0.0 else math.inf


def verify_folder(folder: str | Path) -> list[VerificationResult]:
    """Runs every case of a folder, in the order of the names."""
    return [verify_case(path) for path in sorted(Path(folder).glob("*.json"))]


def verify_case(path: str | Path) -> VerificationResult:
    """Runs one file: a case, or context samples on the case beside it that they name."""
    path = Path(path)
    readable = True
    try:
        case = json.loads(bytes_of(path, "case"))
        if "samples" in case:
            base = json.loads(bytes_of(path.parent / f"{case['base']}.json", "case"))
            checks = _check_samples(case, base)
        else:
            frame = FrameCase.read(case)
            checks = [
                check
                for load_case in case["load_cases"]
                for check in _check_load_case(case, frame, load_case)
            ]
    except (_core.InvalidInput, _core.UnstableStructure) as error:
        failure = str(error)
    except KeyError as error:
        failure = f"the case lacks, or has nowhere, what it names {error.args[0]!r}"
        readable = False
    except (RecursionError, ArithmeticError, *MALFORMED) as error:
        failure = f"the case cannot be read as one of this format ({error})"
        readable = False
    else:
        return _judge(path.stem, checks)
    return VerificationResult(path.stem, False, math.inf, 0, failure, readable)


def _judge(name: str, checks: Sequence[Check]) -> VerificationResult:
    worst = max((check.ratio for check in checks), default=0.0)
    failure = next((check for check in checks if not check.ratio <= 1.0), None)
    passed = failure is None and bool(checks)
    words = None if failure is None else failure.words()
    if not checks:
        words = "nothing is expected of it"
    return VerificationResult(name, passed, worst, len(checks), words)


def _check_load_case(case: Json, frame: FrameCase, load_case: Json) -> list[Check]:
    expected = load_case["expected"]
    loads = Loads(frame, patterns=1)
    loads.add(load_case, case.get("inclined_supports") or [])
    values = _core.respond(frame.arrays, loads.arrays(), output_arrays(frame, expected))[0]
    sizes = loads.sizes()
    return [
        Check(
            f"{load_case['name']}: {_name(entry)}",
            float(value),
            entry["value"],
            _tolerance(entry, sizes),
        )
        for value, entry in zip(values, expected, strict=True)
    ]


def _tolerance(entry: Json, sizes: Mapping[str, float]) -> float:
    tolerance: float = entry["atol"] + entry["rtol"] * abs(entry["value"])
    if not math.isfinite(tolerance):
        raise ValueError("a tolerance is not finite")
    turning = entry.get("dof", "")[:1] == "r" or int(entry.get("index", 0)) % 6 >= 3
    if entry["kind"] == "displacement":
        kind = "rotation" if turning else "displacement"
    else:
        kind = "moment" if turning else "force"
    zero = ZERO * sizes[kind]
    if entry["origin"] == "reference" and abs(entry["value"]) < zero:
        return max(tolerance, zero)
    return tolerance


def _name(entry: Json) -> str:
    place = f"element {entry['element']}" if "element" in entry else f"node {entry['node']}"
    part = entry.get("dof", entry.get("index"))
    return f"{entry['kind']} of {place}" + ("" if part is None else f", {part}")


def _check_samples(case: Json, base: Json) -> list[Check]:
    """Context samples: loads and temperatures of a sample are one pattern, its stiffnesses one
    structure."""
    entries = [{"kind": "displacement", **sensor} for sensor in case["sensors"]]
    checks: list[Check] = []
    for group in case["samples"]:
        for index, expected in enumerate(group["sensors"]):
            frame = FrameCase.read(base)
            loads = _sample_loads(case, frame, group, index)
            values = _core.respond(frame.arrays, loads.arrays(), output_arrays(frame, entries))[0]
            tolerance = case["rtol_of_max"] * max(abs(value) for value in expected)
            checks += [
                Check(f"{group['kind']} sample {index}: {_name(entry)}", value, wanted, tolerance)
                for entry, value, wanted in zip(entries, values.tolist(), expected, strict=True)
            ]
    return checks


def _sample_loads(case: Json, frame: FrameCase, group: Json, index: int) -> Loads:
    """The loads of a sample; its stiffnesses go into the frame."""
    loads = Loads(frame, patterns=1)
    for size, pattern in zip(group["q"][index], case["load_patterns"], strict=True):
        for load in pattern:
            loads.forces[0, frame.nodes[str(load["node"])], :3] += size * point(load["f"])
    fields = np.array(case["temperature_fields"])
    loads.strain[0, :, 0] = case["alpha"] * (np.array(group["T"][index]) @ fields)
    if group.get("k_mult") is not None:
        frame.arrays["A"] = frame.arrays["A"] * np.array(group["k_mult"][index])
    frame.arrays["spring_stiffness"] = np.array(group["spring_k"][index])
    return loads
