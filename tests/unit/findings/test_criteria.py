"""The criteria: frozen, refused where wrong, read from files, and documented."""

import json
import pickle
import re
import runpy
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from pydantic import ValidationError
from pydantic.fields import FieldInfo

from rga import Criteria, load_criteria, load_findings
from rga.errors import InputError
from rga.findings import Findings
from rga.twin.settings import Settings

ROOT = Path(__file__).parents[3]


def figures() -> Iterator[tuple[str, str, FieldInfo]]:
    """Group, name and field of every criterion."""
    for group, of in Criteria.model_fields.items():
        kind: Any = of.annotation
        for name, field in kind.model_fields.items():
            yield group, name, field


def test_they_cannot_be_changed() -> None:
    criteria = Criteria()
    with pytest.raises(ValidationError, match="frozen"):
        criteria.naming.log_odds = 3.0  # type: ignore[misc]
    with pytest.raises(ValidationError, match="frozen"):
        criteria.naming = criteria.naming  # type: ignore[misc]


def test_every_figure_says_what_it_decides_and_why() -> None:
    for group, name, field in figures():
        said = field.json_schema_extra
        assert isinstance(said, dict)
        for words in (field.description, said["unit"], said["reason"]):
            assert isinstance(words, str), (group, name)
            assert words.strip(), (group, name)


@pytest.mark.parametrize("wrong", [-1, 0, float("nan"), float("inf"), "4", True, None, [4]])
def test_what_no_figure_can_be_is_refused(wrong: object) -> None:
    taken = []
    for group, name, _ in figures():
        with suppress(ValidationError):
            Criteria.model_validate({group: {name: wrong}})
            taken.append(f"{group}.{name}")
    assert taken == []


def test_a_figure_that_differs_is_listed() -> None:
    for group, name, field in figures():
        # The next whole number, or half a share.
        other = field.default + 1 if field.default >= 1 else field.default / 2
        criteria = Criteria.model_validate({group: {name: other}})
        assert criteria.differing() == {f"{group}.{name}": other}
        assert criteria != Criteria()
        assert Criteria.model_validate_json(criteria.model_dump_json()) == criteria
        assert pickle.loads(pickle.dumps(criteria)) == criteria


def test_nothing_differs_by_default() -> None:
    assert Criteria().differing() == {}


@pytest.mark.parametrize("suffix", ["toml", "json"])
def test_a_file_states_what_differs(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"criteria.{suffix}"
    content = "[naming]\nlog_odds = 9\n" if suffix == "toml" else '{"naming": {"log_odds": 9}}'
    path.write_text(content, encoding="utf-8")
    assert load_criteria(path).differing() == {"naming.log_odds": 9.0}


WRONG = {
    "group": ("[nameing]\nlog_odds = 9\n", "nameing: ", "the criteria are record, zeros"),
    "name": ("[naming]\nodds = 9\n", "naming.odds: ", "the keys of [naming] are log_odds"),
    "value": ("[naming]\nlog_odds = -9\n", "naming.log_odds: ", "greater than 0"),
    "text": ('[rivals]\nlisted = "3"\n', "rivals.listed: ", "valid integer"),
    "figure in place of a group": ("naming = 9\n", "naming: ", "the criteria are record"),
    "rows": ("[record]\nmost_rows = 20\nleast_rows = 30\n", "record: ", "above most_rows 20"),
    "syntax": ("[naming\n", "these are no criteria: ", "mend the syntax"),
}


@pytest.mark.parametrize("case", WRONG)
def test_a_wrong_file_gets_one_clear_error(tmp_path: Path, case: str) -> None:
    content, begins, holds = WRONG[case]
    path = tmp_path / "criteria.toml"
    path.write_text(content, encoding="utf-8")
    with pytest.raises(InputError) as refusal:
        load_criteria(path)
    words = str(refusal.value)
    assert words.startswith(begins)
    assert holds in words
    assert str(path) in words
    assert "\n" not in words


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="the criteria cannot be read, no such file"):
        load_criteria(tmp_path / "criteria.toml")
    (tmp_path / "list.json").write_text("[1]", encoding="utf-8")
    with pytest.raises(InputError, match="give a table of criteria"):
        load_criteria(tmp_path / "list.json")


def test_a_run_has_them_among_its_settings() -> None:
    settings = Settings.model_validate({"criteria": {"rivals": {"log_odds": 3.0}}})
    assert settings.criteria.differing() == {"rivals.log_odds": 3.0}
    with pytest.raises(ValidationError):
        Settings.model_validate({"criteria": {"rivals": {"log_odds": -3.0}}})


def test_findings_without_them_are_read(tmp_path: Path) -> None:
    gap = {"before": 1.0, "after": 1.0, "gain": 0.0, "gain_ci90": [0.0, 0.0]}
    content: dict[str, Any] = {
        "rga_findings": 1,
        "verdict": "nothing_wrong",
        "gap": {"before": 1.0, "after": 1.0, "held_out": gap, "by_sensor": {}},
        "unexplained": {"share": 0.0, "looks_like": "nothing"},
        "seed": 0,
        "model_sha256": "",
        "record_sha256": "",
    }
    path = tmp_path / "findings.json"
    path.write_text(json.dumps(content), encoding="utf-8")
    assert load_findings(path).criteria == Criteria()
    content["criteria"] = {"naming": {"log_odds": 9.0}}
    path.write_text(json.dumps(content), encoding="utf-8")
    findings: Findings = load_findings(path)
    assert findings.criteria.differing() == {"naming.log_odds": 9.0}
    content["criteria"] = {"naming": {"log_odds": "high"}}
    path.write_text(json.dumps(content), encoding="utf-8")
    with pytest.raises(InputError, match=r"criteria\.naming\.log_odds"):
        load_findings(path)


def test_the_page_of_docs_is_that_of_the_class() -> None:
    written = (ROOT / "docs" / "reference" / "criteria.md").read_text(encoding="utf-8")
    page = runpy.run_path(str(ROOT / "tools" / "criteria_table.py"))["page"](written)
    assert written == page, "run python tools/criteria_table.py"
    for group, name, _ in figures():
        section = written.split(f"## `{group}`", 1)[1].split("\n## ", 1)[0]
        assert re.search(rf"^\| `{name}` \|", section, re.MULTILINE)


def test_the_file_of_the_page_is_read(tmp_path: Path) -> None:
    written = (ROOT / "docs" / "reference" / "criteria.md").read_text(encoding="utf-8")
    path = tmp_path / "criteria.toml"
    path.write_text(written.split("```toml\n", 1)[1].split("```", 1)[0], encoding="utf-8")
    assert load_criteria(path).differing() == {"naming.log_odds": 9.2, "channels.own_part": 3.0}
