"""Stresses of members with and without the causes."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from plane_models import E, model
from rga.diagnosis.member_stresses import MemberStress, member_stresses
from rga.findings.arrays import DiagnosisArrays
from rga.model import read_model
from rga.model.io import model_content
from rga.report.figures.member_stresses import consequence, stress_table

AREA, FORCE = 2e-3, [1e3, 9e4, -4e3]


def account(causes: dict[str, Any], yields: float | None = 250e6) -> DiagnosisArrays:
    """Two bars in line, pulled by a context; the second row is the heaviest."""
    given = model(
        analysis={"geometry": "linear"},
        materials={"steel": {"E": E, "yield_strength": yields}},
        sections={"bar": {"A": AREA}},
        nodes={"a": [0, 0, 0], "b": [2, 0, 0], "c": [5, 0, 0]},
        members={
            name: {"nodes": list(name), "section": "bar", "material": "steel"}
            for name in ("ab", "bc")
        },
        supports={
            "west": {"node": "a", "fixed": ["ux", "uz"]},
            "middle": {"node": "b", "fixed": ["uz"]},
            "east": {"node": "c", "fixed": ["uz"]},
        },
        context={"pull": {"unit": "N", "range": [-1e5, 1e5]}},
        effects={
            "pull": {
                "kind": "nodal_load",
                "forces": {"c": [1, 0, 0]},
                "factor": {"context": "pull"},
            }
        },
    )
    content = model_content(given)
    extended = read_model({**content, "effects": {**content["effects"], **causes}}, "extended")
    made = SimpleNamespace(model=given, extended=extended, contexts={"pull": np.array(FORCE)})
    return cast(DiagnosisArrays, made)


class TestMemberStresses:
    def test_a_member_that_lost_a_quarter_bears_a_third_more(self) -> None:
        loss = {"loss": {"kind": "member_stiffness", "member": "ab", "factor": 0.75}}
        found = member_stresses(account(loss), ["ab", "bc"], 1)
        assert found is not None
        (given, lossy), (whole, still) = found["ab"], found["bc"]
        assert given.stress == pytest.approx(9e4 / AREA, rel=1e-12)
        assert lossy.stress == pytest.approx(9e4 / AREA / 0.75, rel=1e-12)
        assert lossy.utilisation == pytest.approx(9e4 / AREA / 0.75 / 250e6, rel=1e-12)
        assert (given.left, lossy.left) == (1.0, 0.75)
        assert still.stress == pytest.approx(whole.stress, rel=1e-12)
        assert still.left == 1.0

    def test_a_cause_elsewhere_changes_no_stress_here(self) -> None:
        spring = {"s": {"kind": "support_spring", "support": "east", "dof": "ux", "stiffness": 1.0}}
        found = member_stresses(account(spring), ["ab"], 1)
        assert found is not None
        given, extended = found["ab"]
        assert extended.stress == pytest.approx(given.stress, rel=1e-6)
        assert extended.left == 1.0


class TestStressTable:
    def test_the_table_shows_the_ratio_and_what_is_left(self) -> None:
        loss = {"loss": {"kind": "member_stiffness", "member": "ab", "factor": 0.75}}
        found = member_stresses(account(loss), ["ab", "bc"], 1)
        assert found is not None
        table = stress_table(found)
        assert table.lost
        assert table.utilised
        assert table.lines[0][3:] == ["45.0", "60.0", "1.33", "75\xa0%", "18\xa0%", "24\xa0%"]
        assert table.lines[1][5:7] == ["1.00", "–"]

    def test_the_stress_that_grows_most_is_told_in_a_sentence(self) -> None:
        loss = {"loss": {"kind": "member_stiffness", "member": "ab", "factor": 0.75}}
        found = member_stresses(account(loss), ["ab", "bc"], 1)
        assert found is not None
        assert consequence(found).replace("\xa0", " ") == (
            "The stress of ab grows by 33 %, from 45.0 to 60.0 MPa: from 18 % to 24 % of its yield "
            "strength."
        )
        assert consequence({"bc": found["bc"]}) == ""

    def test_what_is_added_counts_and_not_the_share_of_little(self) -> None:
        def at(stress: float) -> MemberStress:
            return MemberStress(moment=0.0, stress=stress, utilisation=None, left=1.0)

        found = {"brace": (at(1.4e6), at(7.1e6)), "chord": (at(-96e6), at(-126e6))}
        assert consequence(found).startswith("The stress of chord grows by 31")
        found["chord"] = at(-96e6), at(-96e6)
        assert consequence(found).startswith("The stress of brace grows by 407")
        found["brace"] = at(1.4e6), at(1.5e6)
        assert consequence(found) == ""
        found["brace"] = at(0.0), at(7e6)
        assert consequence(found).startswith("The stress of brace grows from 0")

    def test_without_a_yield_strength_nothing_is_used_up(self) -> None:
        loss = {"loss": {"kind": "member_stiffness", "member": "ab", "factor": 0.75}}
        found = member_stresses(account(loss, yields=None), ["ab"], 1)
        assert found is not None
        table = stress_table(found)
        assert not table.utilised
        assert len(table.lines[0]) == 7
