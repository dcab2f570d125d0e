"""The report: one file that says all, in any case, and lets no name from a file break it."""

import re
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rga.drawing.projection import views
from rga.findings import schema as contract
from rga.findings.arrays import DiagnosisArrays
from rga.findings.schema import Cause, Explanation, Findings, GroupGap, Unexplained
from rga.model import Model, read_model
from rga.quantities import number, percent, quantity
from rga.records import Record
from rga.report import write_report
from rga.report.figures.deviation import percent_off
from rga.report.figures.gain import blocks
from rga.report.figures.series import runs_on

HOSTILE = "<script>alert('x')</script> $\\frac{a_b}$ & \"q\""
#: what a full report says somewhere
SAID = """131 to 1.3 | 121 to 138 | 24.0 MN/m | temperature leaves its range | X9 | joint slip | T1
elevation at y = 5 m | follows the temperature | 0.1.0"""


def truss(panels: int = 4, at: tuple[float, ...] = (0.0,), plane: str | None = "xz") -> Model:
    """Trusses of some panels, with sensors on the first two panels of each."""
    nodes: dict[str, Any] = {}
    members: dict[str, Any] = {}
    sensors: dict[str, Any] = {}
    supports: dict[str, Any] = {}

    def bar(first: str, last: str, group: str) -> None:
        member = {"nodes": [first, last], "section": "bar", "material": "steel", "groups": [group]}
        members[f"{first}-{last}"] = member

    for number_, y in enumerate(at):
        low = [f"L{i}{number_}" for i in range(panels + 1)]
        high = [f"U{i}{number_}" for i in range(panels + 1)]
        nodes |= {name: [6.0 * i, y, 0.0] for i, name in enumerate(low)}
        nodes |= {name: [6.0 * i, y, 7.0] for i, name in enumerate(high)}
        for i in range(panels):
            bar(low[i], low[i + 1], "bottom chord")
            bar(high[i], high[i + 1], "top chord")
            bar(low[i], high[i + 1], "diagonal")
        for i in range(panels + 1):
            bar(low[i], high[i], "vertical")
            if number_:
                bar(f"L{i}{number_ - 1}", low[i], "cross girder")
        supports[f"west{number_}"] = {"node": low[0], "fixed": ["ux", "uy", "uz"]}
        supports[f"east{number_}"] = {"node": low[-1], "fixed": ["uz"]}
        down = {"kind": "displacement", "node": low[1], "direction": [0, 0, 1], "unit": "mm"}
        sensors[f"D{number_}"] = down
        for gauge, member in (("S", f"{low[0]}-{low[1]}"), ("T", f"{low[0]}-{high[1]}")):
            sensors[f"{gauge}{number_}"] = {"kind": "strain", "member": member, "unit": "m/m"}
    content = {
        "rga_model": 1,
        "name": "test bridge",
        "materials": {"steel": {"E": 2e11}},
        "sections": {"bar": {"A": 0.01}},
        "nodes": nodes,
        "members": members,
        "supports": supports,
        "context": {"temperature": {"unit": "degC", "range": [-20, 40]}},
        "sensors": sensors,
    }
    return read_model(content | ({"plane": plane} if plane else {}), "test")


SPRING = {
    "kind": "support_spring",
    "support": "east0",
    "dof": "ux",
    "stiffness": {"value": 2.4e7, "ci90": [2.1e7, 2.8e7]},
}


def found(
    model: Model,
    rows: int = 60,
    smooth: bool = True,
    rejected: tuple[str, ...] = (),
    **changes: Any,
) -> Findings:
    """Findings about a model whose readings are 80 % of what it simulates."""
    random = np.random.default_rng(0)
    sensors = tuple(model.sensors)
    time = (np.arange(rows) * 600.0).astype(np.float64)
    drive = np.sin(time / 4000) if smooth else random.standard_normal(rows)
    size = np.array([3e-5 if model.sensors[name].kind == "strain" else 4.0 for name in sensors])
    before = drive[:, None] * size
    after = 0.8 * before
    noise = np.broadcast_to(0.02 * size, before.shape)
    readings = after + noise * random.standard_normal(before.shape)
    held_out = np.zeros(rows, dtype=bool)
    held_out[2 * rows // 3 : 2 * rows // 3 + rows // 5] = True
    record = Record(time, 100.0, "seconds", sensors, readings, {"temperature": drive})
    out = np.array([name in rejected for name in sensors])
    content: dict[str, Any] = {
        "verdict": "named",
        "gap": contract.Gap(
            before=134.0,
            after=1.2,
            held_out=contract.HeldOut(
                before=131.0, after=1.3, gain=129.7, gain_ci90=(121.0, 137.5)
            ),
            by_sensor={
                n: contract.SensorGap(before=140.0, after=1.1) for n in sensors if n not in rejected
            },
        ),
        "causes": [Cause(effect=SPRING, status="named", log_odds=235.0, d_prime=22.0, d_perp=11.0)],
        "unexplained": Unexplained(share=0.02, looks_like="follows the temperature"),
        "seed": 1,
        "model_sha256": "a" * 64,
        "record_sha256": "b" * 64,
    }
    findings = Findings(**(content | changes))
    findings._account = DiagnosisArrays(
        model, model, record, held_out, out, before, after, 0.02 * size, noise
    )
    return findings


class Reader(HTMLParser):
    """Tags and text of a page; what is fetched from elsewhere."""

    def __init__(self) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.fetched: list[str] = []
        self.text = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        for name, value in attrs:
            if name in ("src", "href", "xlink:href") and not str(value).startswith(
                ("#", "data:text/csv")
            ):
                self.fetched.append(str(value))

    def handle_data(self, data: str) -> None:
        self.text += data


def read(findings: Findings, directory: Path) -> tuple[Reader, str]:
    html = write_report(findings, directory / "report.html").read_text(encoding="utf-8")
    reader = Reader()
    reader.feed(html)
    return reader, html


def test_report_says_all_and_fetches_nothing(tmp_path: Path) -> None:
    findings = found(
        truss(at=(0.0, 5.0), plane=None),
        rejected=("T1",),
        explanations=[
            Explanation(words=words, effects=effects, log_odds=9, gap=1.2, gap_unseen_channels=1.4)
            for words, effects in (("modulus", []), ("spring", [SPRING]))
        ],
        groups=[GroupGap(group="gauges", sensors=["S0"], before_percent=-20, after_percent=0.4)],
        contexts={"temperature": {"start": {"value": 3.0, "ci90": [2.5, 3.5]}, "law": "linear"}},
        unidentifiable=[
            contract.Unidentifiable(kind="joint_slip", place=f"member {n}", d_prime_at_largest=1.2)
            for n in range(20)
        ],
        warnings=["temperature leaves its range"],
        versions={"rga": "0.1.0"},
    )
    findings.account.record.unused["X9"] = "its location is not stated"
    reader, html = read(findings, tmp_path)
    assert not reader.fetched
    assert "script" not in reader.tags
    channels = len(findings.account.record.sensors)
    assert reader.tags.count("svg") == 5 + channels
    assert html.count('<svg role="img" aria-label="') == 5 + channels
    assert html.count("data:text/csv") == channels
    plain = reader.text.replace("\u00a0", " ")
    assert "Left out on paper: the HTML file of this report draws each channel" in plain
    assert "What is left: " in plain
    assert "d_perp" in plain
    assert "\u22a5" not in plain
    for words in re.split(r" \| |\n", SAID):
        assert words in plain
    assert re.search(r'class="best".*?spring', html, re.DOTALL)
    assert [path.name for path in tmp_path.iterdir()] == ["report.html"]


def test_report_is_the_same_twice(tmp_path: Path) -> None:
    findings = found(truss())
    assert read(findings, tmp_path)[1] == read(findings, tmp_path)[1]


def test_hostile_names_stay_text(tmp_path: Path) -> None:
    model = truss()
    sensors = {f"{HOSTILE}{n}": sensor for n, sensor in enumerate(model.sensors.values())}
    sensors["\ud800 名 \n$x^{"] = next(iter(model.sensors.values()))
    model = model.model_copy(update={"sensors": sensors, "name": HOSTILE})
    cause = Cause(
        effect={
            "kind": "sensor_bias",
            "sensor": f"{HOSTILE}0",
            "offset": {"value": 1, "ci90": [0, 2]},
        },
        status="ambiguous",
        onset="2022-05-30T12:00:00",
        onset_ci90=("2022-05-30T11:00:00", "2022-05-30T13:00:00"),
        log_odds=5.0,
        d_prime=4.0,
        d_perp=0.1,
        rivals=[SPRING],
        why=HOSTILE,
        separated_by=HOSTILE,
    )
    reader, html = read(
        found(
            model,
            causes=[cause],
            warnings=[HOSTILE],
            unexplained=Unexplained(share=0.5, looks_like=HOSTILE),
            contexts={HOSTILE: {HOSTILE: [HOSTILE, None, True]}},
            groups=[GroupGap(group=HOSTILE, sensors=[], before_percent=1, after_percent=1)],
            explanations=[
                Explanation(words=HOSTILE, effects=[], log_odds=1, gap=1, remark=HOSTILE)
            ],
        ),
        tmp_path,
    )
    assert "script" not in reader.tags
    assert "<script" not in html
    assert HOSTILE in reader.text


@pytest.mark.parametrize(
    "rows", [1, *(pytest.param(rows, marks=pytest.mark.thorough) for rows in (2, 5)), 1500]
)
@pytest.mark.parametrize("smooth", [True, False])
def test_any_number_of_rows(tmp_path: Path, rows: int, smooth: bool) -> None:
    reader, _ = read(found(truss(), rows=rows, smooth=smooth), tmp_path)
    assert "svg" in reader.tags


def test_nothing_wrong_has_no_causes(tmp_path: Path) -> None:
    reader, _ = read(found(truss(), verdict="nothing_wrong", causes=[]), tmp_path)
    assert "No cause was named" in reader.text


def test_channels_without_readings(tmp_path: Path) -> None:
    findings = found(truss(), rejected=("S0", "T0"))
    findings.account.record.readings[:, 0] = np.nan
    reader, _ = read(findings, tmp_path)
    assert "rejected" in reader.text
    assert np.isnan(percent_off(findings.account, findings.account.before)).all()


def test_a_single_sensor(tmp_path: Path) -> None:
    model = truss()
    reader, _ = read(
        found(model.model_copy(update={"sensors": {"D0": model.sensors["D0"]}})), tmp_path
    )
    assert reader.tags.count("svg") == 4 + 1


@pytest.mark.parametrize("panels", [3, 20])
def test_bridges_of_any_size(tmp_path: Path, panels: int) -> None:
    lost = {"kind": "member_stiffness", "member": "L10-L11", "factor": 0.4}
    gone = Cause(effect=lost, status="named", log_odds=9, d_prime=5, d_perp=5)
    model = truss(panels, at=(-2.0, 2.0), plane=None)
    reader, _ = read(found(model, causes=[gone]), tmp_path)
    assert reader.tags.count("svg") == 4 + len(model.sensors)
    plain = reader.text.replace("\u00a0", " ")
    assert "member stiffness of L10-L11" in plain
    drawn = [view.title for view in views(model, {"L10-L11"})]
    assert len(drawn) == 3
    assert all(title in plain for title in drawn)


def test_findings_from_a_file_cannot_be_drawn(tmp_path: Path) -> None:
    findings = Findings.model_validate_json(found(truss()).to_json())
    with pytest.raises(ValueError, match="arrays"):
        write_report(findings, tmp_path / "report.html")


def test_views_follow_the_trusses() -> None:
    assert [view.title for view in views(truss(), set())] == ["elevation"]
    both = truss(at=(0.0, 5.0), plane=None)
    titles = [f"elevation at y = {y} m" for y in (0, 5)]
    assert [view.title for view in views(both, set())] == titles
    assert views(both, {"L10-L11"})[-1].title == "plan"


def test_percent_off_and_smoothness() -> None:
    findings = found(truss())
    np.testing.assert_allclose(percent_off(findings.account, findings.account.before), -20, atol=1)
    assert runs_on(findings.account)
    assert not runs_on(found(truss(), smooth=False).account)


def test_blocks_cover_the_held_out_rows() -> None:
    account = found(truss()).account
    covered = np.zeros(len(account.record), dtype=bool)
    for first, last in blocks(account):
        covered[first : last + 1] = True
    np.testing.assert_array_equal(covered, account.held_out)


def test_numbers_have_sensible_digits() -> None:
    assert quantity(0.0117, "m2", (0.0112, 0.0122)) == "117.0\u00a0cm² [112.0, 122.0]"
    assert quantity(-0.003, "m") == "\u22123.00\u00a0mm"
    assert quantity(5.0, "N/m", (5.0, 5.0)) == "5.00\u00a0N/m [5.00, 5.00]"
    assert number(1.23456e-7) == "1.23·10⁻⁷"
    assert percent(float("nan")) == "\u2013"
