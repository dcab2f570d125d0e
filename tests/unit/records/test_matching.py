"""Columns that name the member or node of a sensor, and files of which no column is like one."""

import tomllib
from pathlib import Path

import numpy as np
import pytest

from rga.building.structures.howe import howe_truss
from rga.model import Model
from rga.records import load_record
from rga.records.drafting import MappingDraft, draft_mapping

MEMBERS, NODES = ["L3-L4", "L4-L5", "U3-U4"], ["L2", "L4"]


@pytest.fixture(scope="module")
def truss() -> Model:
    builder = howe_truss("roof", "20 m", "3 m", 8, chords="HEA 100", diagonals="L 60x60x6")
    builder.sensors("strain", MEMBERS).sensors("displacement", NODES, direction="down")
    return builder.context("air", "degC", (-20, 40)).build()


def drafted(folder: Path, model: Model, **files: list[str]) -> MappingDraft:
    paths = []
    for name, columns in files.items():
        rows = [f"{k}," + ",".join(f"{k + j}" for j in range(len(columns))) for k in range(5)]
        path = folder / f"{name}.csv"
        path.write_text("\n".join([",".join(["time", *columns]), *rows]), encoding="utf-8")
        paths.append(path)
    return draft_mapping(paths, model, folder)


STRAINS = {
    "Strain {} [µm/m]": "S {}",
    "DMS {} [µm/m]": "S {}",
    "SG {} [ustrain]": "S {}",
    "dms_{} (µε)": "S {}",
}


@pytest.mark.parametrize("strain", STRAINS)
@pytest.mark.parametrize("way", ["Displacement {} [mm]", "Weg {} [cm]", "LVDT {} [mm]"])
def test_a_column_that_names_the_place_in_a_unit_of_the_kind_is_the_sensor(
    strain: str, way: str, tmp_path: Path, truss: Model
) -> None:
    columns = [strain.format(one) for one in MEMBERS] + [way.format(one) for one in NODES]
    draft = drafted(tmp_path, truss, main=columns)
    assert {one.name: one.column for one in draft.matched} == dict(
        zip(truss.sensors, columns, strict=True)
    )
    assert draft.fault is None


@pytest.mark.parametrize(
    ("columns", "said"),
    [
        (["DMS L3-L4 oben [µm/m]", "DMS L3-L4 unten [µm/m]"],
         "S L3-L4 may be 'DMS L3-L4 oben [µm/m]', 'DMS L3-L4 unten [µm/m]'"),
        (["DMS L3-L4"], "S L3-L4 may be 'DMS L3-L4'"),
        (["Weg L2 L4 [mm]"], "D L2 may be 'Weg L2 L4 [mm]', as may D L4"),
    ],
)  # fmt: skip
def test_what_may_be_several_or_has_no_unit_is_doubted(
    columns: list[str], said: str, tmp_path: Path, truss: Model
) -> None:
    draft = drafted(tmp_path, truss, main=[*columns, "x"])
    assert not {one.column for one in draft.matched} & {*columns}
    assert said in draft.doubts


@pytest.mark.parametrize(
    "column", ["Force L3-L4 [kN]", "Strain L2 [µm/m]", "Weg L3-L4 [mm]", "Strain U1-U2 [µm/m]"]
)
def test_another_place_or_kind_is_not_the_sensor(column: str, tmp_path: Path, truss: Model) -> None:
    draft = drafted(tmp_path, truss, main=[column, "D L4"])
    assert [one.name for one in draft.matched] == ["D L4"]


def test_a_number_is_no_place_to_go_by(tmp_path: Path, truss: Model) -> None:
    content = truss.model_dump(mode="json", by_alias=True, exclude_none=True)
    content["nodes"]["7"] = [0, 0, 9]
    content["members"]["12"] = {**content["members"]["L0-L1"], "nodes": ["L0", "7"]}
    for name, member in (("a", "12"), ("b", "L3-L4")):
        content["sensors"][name] = {"kind": "strain", "unit": "microstrain", "member": member}
    draft = drafted(tmp_path, Model.model_validate(content), main=["Kanal 12 [µm/m]", "D L4"])
    assert [one.name for one in draft.matched] == ["D L4"]
    assert "a may be 'Kanal 12 [µm/m]'" in draft.doubts


def test_a_file_without_a_match_stays_and_remarks_are_all_there_is_to_take_away(
    tmp_path: Path, truss: Model
) -> None:
    own = ["MS1 [µm/m]", "MS2 [µm/m]", "MS3 [µm/m]", "Batt [V]"]
    draft = drafted(tmp_path, truss, main=["D L2", "D L4", "air [°C]"], gauges=own)
    content = tomllib.loads(draft.toml)
    assert draft.fault is None
    assert content["beside"][0]["files"] == ["gauges.csv"]
    assert '# "S L3-L4" = { column = "MS1 [µm/m]" }  # from 0 to 4 µm/m; or S L4-L5' in draft.toml
    assert '# NAME = { column = "Batt [V]" }  # from 3 to 7 V' in draft.toml
    assert "gauges.csv: no column is like a channel: its lines are remarks" in draft.doubts
    (tmp_path / "import.toml").write_text(draft.toml, encoding="utf-8")
    as_it_stands = load_record(tmp_path, truss)
    assert as_it_stands.sensors == ("D L2", "D L4")
    assert as_it_stands.notes[-1] == "gauges.csv gives no channel: all that it has is unused"
    (tmp_path / "import.toml").write_text(draft.toml.replace('# "S ', '"S '), encoding="utf-8")
    record = load_record(tmp_path, truss)
    assert record.sensors == tuple(truss.sensors)
    np.testing.assert_allclose(record.readings[:, 1], np.arange(1, 6))
    assert not record.unused.keys() & truss.sensors.keys()


def test_so_it_is_where_no_file_has_a_match(tmp_path: Path, truss: Model) -> None:
    draft = drafted(tmp_path, truss, main=["a [µm/m]", "b [µm/m]", "c [mm]", "d [mm]"])
    assert draft.fault is not None
    assert tomllib.loads(draft.toml)["files"] == ["main.csv"]
    (tmp_path / "import.toml").write_text(draft.toml.replace('# "', '"'), encoding="utf-8")
    record = load_record(tmp_path, truss)
    assert record.sensors == ("S L3-L4", "S L4-L5", "D L2", "D L4")


def test_a_gauge_that_a_person_left_out_stays_out(tmp_path: Path, truss: Model) -> None:
    draft = drafted(tmp_path, truss, main=[f"S {one}" for one in MEMBERS])
    whole = draft.toml + '"S U3-U4" = "its cable is cut"\n'
    (tmp_path / "import.toml").write_text(whole, encoding="utf-8")
    record = load_record(tmp_path, truss)
    assert record.sensors == ("S L3-L4", "S L4-L5")
    assert record.unused["S U3-U4"] == "its cable is cut"


def test_doubts_of_one_kind_are_told_together(tmp_path: Path, truss: Model) -> None:
    columns = [f"x{k} [V]" for k in range(30)]
    draft = drafted(tmp_path, truss, main=["s_L3-L4 [µm/m]", *columns])
    assert len(draft.doubts) <= 6
    assert not any("but for its writing" in doubt for doubt in draft.doubts)
    assert any("no columns are like the sensors 'S L4-L5', 'S U3-U4'" in d for d in draft.doubts)


def test_codes_of_many_columns_are_counted(tmp_path: Path, truss: Model) -> None:
    names = ",".join(f"c{k}" for k in range(8))
    rows = [f"{k}," + ",".join(["-9999" if k == 3 else str(k)] * 8) for k in range(6)]
    path = tmp_path / "r.csv"
    path.write_text("\n".join([f"time,{names}", *rows]), encoding="utf-8")
    doubts = " ".join(draft_mapping([path], truss, tmp_path).doubts)
    shown = ", ".join(f"c{k} (1 row)" for k in range(5))
    assert f"-9999 stands in {shown} and 3 more columns: is it a missing value?" in doubts


def test_a_faster_logger_is_read_between_its_rows_not_averaged(
    tmp_path: Path, truss: Model
) -> None:
    (tmp_path / "m.csv").write_text("time,D L2,D L4\n0,1,2\n3600,2,3\n", encoding="utf-8")
    rows = "\n".join(f"{600 * k},{k}" for k in range(7))
    (tmp_path / "air.csv").write_text(f"time,air\n{rows}\n", encoding="utf-8")
    draft = draft_mapping([tmp_path / "m.csv", tmp_path / "air.csv"], truss, tmp_path)
    assert tomllib.loads(draft.toml)["beside"][0]["match"] == "interpolate"
    assert '"mean" where the files above hold means themselves' in draft.toml
