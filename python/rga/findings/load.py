"""Findings read back from their file."""

import hashlib
import json
from pathlib import Path

from pydantic import ValidationError

from rga.bounded_files import bytes_of, fault_of
from rga.errors import InputError, kind_of
from rga.files import as_path
from rga.findings.schema import Findings


def as_findings(given: Findings | str | Path) -> Findings:
    """Findings, read where their file, or the directory that holds it, is given.

    Raises:
        InputError: as `load_findings`; these are no findings.
    """
    if isinstance(given, Findings):
        return given
    if isinstance(given, str | Path):
        return load_findings(given)
    what = f"{kind_of(given)} is no findings"
    raise InputError(what, "findings", "give Findings, or the path of their file")


def load_findings(path: str | Path) -> Findings:
    """Read findings.json; its arrays (`Findings.account`) are not kept there.

    Args:
        path: the file, or the directory that holds it.

    Raises:
        InputError: the file is missing or unreadable, or holds no findings.
    """
    path = as_path(path, "findings")
    if path.is_dir():
        path = path / "findings.json"
    remedy = "give findings.json of `rga diagnose` or `rga run`, or its directory"
    raw = bytes_of(path, "findings", remedy=remedy)
    try:
        content = json.loads(raw.decode("utf-8"), parse_constant=_no_number)
    except (ValueError, RecursionError) as error:
        raise InputError(
            f"this is no JSON: {fault_of(error)}", str(path), "mend the syntax"
        ) from None
    if not isinstance(content, dict) or "rga_findings" not in content:
        raise InputError(
            "these are no findings: there is no key 'rga_findings'",
            str(path),
            "give findings.json of `rga diagnose` or `rga run`",
        )
    try:
        return Findings.model_validate(content)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        key = ".".join(str(part) for part in first["loc"])
        raise InputError(
            f"{key}: {first['msg']}", str(path), "give findings as the diagnosis wrote them"
        ) from None


def _no_number(name: str) -> None:
    raise ValueError(f"{name} is no number")


def findings_sha256(findings: Findings) -> str:
    """Hash of the content of findings."""
    return hashlib.sha256(findings.to_json().encode()).hexdigest()
