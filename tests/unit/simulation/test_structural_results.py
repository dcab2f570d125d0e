"""Displacements, reactions, section forces and stresses, beside closed forms and a dense solver."""

from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest

from independent.reference_solver import solve_case
from rga.arrays import FloatArray
from rga.errors import InputError, UnstableStructureError
from rga.model import Model, read_model
from rga.model.schema import DOFS
from rga.simulation import Results, results

E, AREA, IY, IZ, J = 2.1e11, 0.01, 8e-5, 2e-5, 1e-6
G = E / 2.6
SPAN, LOAD = 6.0, 12e3
FIBRES = {"top": [0.0, 0.15], "bottom": [0.0, -0.15], "right": [-0.05, 0.0]}


def beam(left: list[str], right: list[str], **effects: Any) -> Model:
    """A level member of 6 m in space, held at its ends."""
    section = {"A": AREA, "Iy": IY, "Iz": IZ, "J": J, "fibres": FIBRES}
    return read_model(
        {
            "rga_model": 1,
            "name": "beam",
            "materials": {"steel": {"E": E, "yield_strength": 235e6}},
            "sections": {"girder": section},
            "nodes": {"A": [0, 0, 0], "B": [SPAN, 0, 0]},
            "members": {
                "AB": {
                    "nodes": ["A", "B"],
                    "section": "girder",
                    "material": "steel",
                    "kind": "frame",
                    "groups": ["all"],
                }
            },
            "supports": {
                "west": {"node": "A", "fixed": left},
                "east": {"node": "B", "fixed": right},
            },
            "effects": effects,
        },
        "beam",
    )


PINNED = ["ux", "uy", "uz", "rx"]
SLIDING = ["uy", "uz", "rx"]
UNIFORM = {"kind": "member_load", "member": "AB", "uniform": [0, 0, -LOAD]}


def close(found: Any, expected: Any) -> None:
    size = np.abs(expected).max()
    assert np.abs(np.asarray(found) - expected).max() <= 1e-9 * size


class TestClosedForms:
    def test_a_simple_beam_under_a_uniform_load(self) -> None:
        found = results(beam(PINNED, SLIDING, load=UNIFORM), stations=9)
        x = SPAN * found.stations
        moment = -LOAD * x * (SPAN - x) / 2
        close(found.section_forces[0, 0, :, 4], moment)
        close(found.section_forces[0, 0, :, 2], -LOAD * (SPAN / 2 - x))
        close(found.reactions[0, :, 2], [LOAD * SPAN / 2] * 2)
        close(found.displacements[0, :, 4], LOAD * SPAN**3 / (24 * E * IY) * np.array([1, -1]))
        close(found.stresses.of_members["AB"]["bottom"][0], -0.15 * moment / IY)
        close(found.stresses.of_members["AB"]["top"][0], 0.15 * moment / IY)

    def test_a_point_load_between_the_nodes_of_a_clamped_beam(self) -> None:
        load = {"kind": "member_load", "member": "AB", "point": [0, LOAD, 0], "x": 2.0}
        clamped = list(DOFS)
        found = results(beam(clamped, clamped, load=load), stations=7)
        a, b = 2.0, SPAN - 2.0
        # The moment about z bends in the x-y plane: positive where fibres at -y are stretched.
        at_ends = LOAD * a * b / SPAN**2 * np.array([b, a])
        close(found.section_forces[0, 0, [0, -1], 5], at_ends)
        close(found.reactions[0, :, 5], [-at_ends[0], at_ends[1]])
        close(found.section_forces[0, 0, 2, 5], -2 * LOAD * a**2 * b**2 / SPAN**3)
        shear = LOAD * b**2 * (3 * a + b) / SPAN**3
        close(found.section_forces[0, 0, :3, 1], [shear] * 3)
        close(found.section_forces[0, 0, 3:, 1], [shear - LOAD] * 4)

    def test_what_pushes_at_the_end_of_a_cantilever(self) -> None:
        push = [1e3, 2e3, 3e3, 4e3, 5e3, 6e3]
        load = {"kind": "nodal_load", "forces": {"B": push}}
        found = results(beam(list(DOFS), [], load=load), stations=3)
        for station, lever in enumerate([SPAN, SPAN / 2, 0.0]):
            expected = [*push[:4], push[4] - push[2] * lever, push[5] + push[1] * lever]
            close(found.section_forces[0, 0, station], expected)
        stress = found.stresses.of_members["AB"]["right"][0, -1]
        close(stress, 1e3 / AREA + 0.05 * 6e3 / IZ)


def random_frame(seed: int) -> Model:
    """A frame in space, its members loaded in every way, its supports moved, its bars warm."""
    draw = np.random.default_rng(seed)
    points = {
        f"n{k}": draw.uniform(-0.6, 0.6, 3) + np.array([2.5 * (k % 3), 3.0 * (k // 3), 0.0])
        for k in range(6)
    }
    pairs = [(0, 1), (1, 2), (3, 4), (4, 5), (0, 3), (2, 5), (1, 4), (0, 4)]
    members = {
        f"m{k}": {
            "nodes": [f"n{i}", f"n{j}"],
            "section": f"s{k % 2}",
            "material": "steel",
            "kind": "truss" if k == 7 else "frame",
            "local_y": list(draw.uniform(-1, 1, 3)),
            "groups": ["warm" if k % 2 else "cold"],
        }
        for k, (i, j) in enumerate(pairs)
    }
    sections = {
        f"s{k}": {"A": 0.01 * (1 + k), "Iy": 5e-5, "Iz": 2e-5 * (1 + k), "J": 1e-5} for k in (0, 1)
    }
    effects: dict[str, Any] = {
        "nodes": {
            "kind": "nodal_load",
            "forces": {f"n{k}": list(1e4 * draw.normal(size=6)) for k in (1, 4)},
        },
        "warmth": {"kind": "temperature", "groups": {"warm": 1.0}, "delta": 20.0},
        "sunk": {
            "kind": "support_settlement", "support": "b", "dof": "uz", "displacement": -2e-3,
        },
        "uniform": {
            "kind": "member_load", "member": "m0", "uniform": list(3e3 * draw.normal(size=3)),
        },
        "trapezoid": {
            "kind": "member_load", "member": "m3", "axis": "z", "trapezoid": [0.3, 1.5, 2e3, -5e3],
        },
        "point": {
            "kind": "member_load", "member": "m6", "x": 1.1,
            "point": list(5e3 * draw.normal(size=3)),
        },
    }  # fmt: skip
    return read_model(
        {
            "rga_model": 1,
            "name": "random frame",
            "materials": {"steel": {"E": E, "nu": 0.3, "alpha": 1.2e-5}},
            "sections": sections,
            "nodes": {name: [float(x) for x in point] for name, point in points.items()},
            "members": members,
            "supports": {
                "a": {"node": "n0", "fixed": list(DOFS)},
                "b": {"node": "n2", "fixed": ["ux", "uy", "uz"]},
                "c": {"node": "n5", "fixed": ["uz", "rx"]},
            },
            "effects": effects,
        },
        "random frame",
    )


def as_case(model: Model) -> tuple[dict[str, Any], dict[str, Any]]:
    """The same in the format of the dense solver, which imports nothing of the package."""
    elements = []
    for name, member in model.members.items():
        section = model.sections[member.section]
        bends = {"G": G, "Iy": section.Iy, "Iz": section.Iz, "J": section.J}
        elements.append(
            {
                "id": name,
                "type": "beam" if member.kind == "frame" else "truss",
                "nodes": list(member.nodes),
                "E": E,
                "A": section.A,
                "local_y": list(member.local_y or ()),
                **(bends if member.kind == "frame" else {}),
            }
        )
    content = model.model_dump(mode="json")["effects"]
    keys = list(zip(("fx", "fy", "fz", "mx", "my", "mz"), range(6), strict=True))
    load_case = {
        "name": "all",
        "nodal_loads": [
            {"node": node, **{key: force[k] for key, k in keys}}
            for node, force in content["nodes"]["forces"].items()
        ],
        "element_loads": [
            *(
                {"element": name, "kind": "thermal", "alpha": 1.2e-5, "dT": 20.0}
                for name in model.groups["warm"]
            ),
            {
                "element": "m0",
                "kind": "uniform",
                **dict(zip(("wx", "wy", "wz"), content["uniform"]["uniform"], strict=True)),
            },
            {"element": "m3", "kind": "trapezoid", "axis": "z", "x1": 0.3, "x2": 1.5, "w1": 2e3,
             "w2": -5e3},
            {
                "element": "m6",
                "kind": "point",
                "x": 1.1,
                **dict(zip(("Px", "Py", "Pz"), content["point"]["point"], strict=True)),
            },
        ],
        "prescribed": [{"node": "n2", "dof": "uz", "value": -2e-3}],
        "expected": [
            *({"kind": "displacement", "node": n, "dof": dof} for n in model.nodes for dof in DOFS),
            *(
                {"kind": "reaction", "node": n, "dof": dof}
                for n in ("n0", "n2", "n5")
                for dof in DOFS
            ),
            *(
                {"kind": "end_force", "element": name, "index": k}
                for name in model.members
                for k in range(12)
            ),
        ],
    }  # fmt: skip
    case = {
        "dim": 3,
        "nodes": {name: list(point) for name, point in model.nodes.items()},
        "elements": elements,
        "supports": [
            {"node": one.node, "dofs": list(one.fixed)} for one in model.supports.values()
        ],
    }
    return case, load_case


def cut(ends: FloatArray, loads: list[tuple[int, float, float, float, float]], x: float) -> Any:
    """What lies beyond x does to what lies before it: equilibrium of the part before.

    Args:
        ends: forces and moments of the first node, float[6].
        loads: axis, from, to, start, end.
    """
    total = np.zeros(6)
    total[:3], total[3:] = ends[:3], ends[3:6] + np.cross([-x, 0, 0], ends[:3])
    for axis, low, high, first, last in loads:
        if low == high:
            points, sizes = np.array([low]), np.array([first])
            points, sizes = points[points < x], sizes[points < x]
        else:
            top = min(x, high)
            if top <= low:
                continue
            nodes, weights = np.polynomial.legendre.leggauss(4)
            points = low + (nodes + 1) / 2 * (top - low)
            sizes = (
                weights * (top - low) / 2 * (first + (last - first) * (points - low) / (high - low))
            )
        for point, size in zip(points, sizes, strict=True):
            force = np.zeros(3)
            force[axis] = size
            total[:3] += force
            total[3:] += np.cross([point - x, 0, 0], force)
    return -total


class TestDenseSolver:
    @pytest.mark.parametrize("seed", range(6))
    def test_random_frames_are_those_of_the_dense_solver(self, seed: int) -> None:
        model = random_frame(seed)
        found = results(model, stations=8)
        case, load_case = as_case(model)
        expected = np.array([float(value) for value in solve_case(case, load_case)])
        motions, reactions, ends = np.split(expected, np.cumsum([6 * len(model.nodes), 18]))
        close(found.displacements[0, :, :3], motions.reshape(-1, 6)[:, :3])
        close(found.displacements[0, :, 3:], motions.reshape(-1, 6)[:, 3:])
        assert found.held == ("n0", "n2", "n5")
        close(found.reactions[0], reactions.reshape(-1, 6))
        content = model.model_dump(mode="json")["effects"]
        forces = np.empty((len(model.members), len(found.stations), 6))
        for number, (name, member) in enumerate(model.members.items()):
            first, last = (np.array(model.nodes[node]) for node in member.nodes)
            length = float(np.linalg.norm(last - first))
            loads = {
                "m0": [(k, 0.0, length, w, w) for k, w in enumerate(content["uniform"]["uniform"])],
                "m3": [(2, 0.3, 1.5, 2e3, -5e3)],
                "m6": [(k, 1.1, 1.1, p, 0.0) for k, p in enumerate(content["point"]["point"])],
            }.get(name, [])
            own = ends.reshape(-1, 12)[number, :6]
            for station, place in enumerate(found.stations):
                forces[number, station] = cut(own, loads, place * length)
        close(found.section_forces[0], forces)


class TestStresses:
    def test_a_lost_quarter_of_a_section_is_a_third_more_stress(self) -> None:
        pull = {"kind": "nodal_load", "forces": {"B": [1e5, 0, 0]}}
        loss = {"kind": "member_stiffness", "member": "AB", "factor": 0.75}
        whole, less = (
            results(beam(list(DOFS), [], load=pull, **more)) for more in ({}, {"loss": loss})
        )
        close(less.section_forces, whole.section_forces)
        for fibre, stress in whole.stresses.of_members["AB"].items():
            close(less.stresses.of_members["AB"][fibre], stress / 0.75)
        assert whole.stresses.reduced == {}
        assert less.stresses.reduced == {"AB": [0.75]}

    def test_more_stiffness_than_drawn_is_no_more_area(self) -> None:
        pull = {"kind": "nodal_load", "forces": {"B": [1e5, 0, 0]}}
        gain = {"kind": "member_stiffness", "group": "all", "factor": 1.3}
        found = results(beam(list(DOFS), [], load=pull, gain=gain))
        close(found.stresses.of_members["AB"]["top"], np.full((1, 11), 1e5 / AREA))

    def test_a_member_is_used_up_by_its_worst_fibre(self) -> None:
        found = results(beam(PINNED, SLIDING, load=UNIFORM))
        worst = 0.15 * LOAD * SPAN**2 / 8 / IY
        (row,) = found.members().to_dicts()
        close(row["stress max"], worst)
        close(row["utilisation"], worst / 235e6)

    def test_without_fibres_there_is_the_stress_of_the_axial_force(self) -> None:
        model = random_frame(0)
        found = results(model)
        assert list(found.stresses.of_members["m2"]) == ["axis"]
        bends = [one.kind == "frame" for one in model.members.values()]
        for column in ("stress min", "stress max"):
            assert found.members()[column].is_null().to_list() == bends
        assert found.members()["utilisation"].is_null().all()

    def test_a_bar_needs_no_fibres(self, two_bars: dict[str, Any]) -> None:
        found = results(read_model(two_bars, "bars"), {"temperature": 20.0, "load": 5e4})
        area = found.model.sections["bar"].A
        lowest, stress = found.members()["N min"] / area, found.members()["stress min"]
        assert stress.to_list() == pytest.approx(lowest.to_list())


class TestTable:
    def found(self) -> Results:
        return results(
            beam(PINNED, SLIDING, load=UNIFORM | {"factor": 1.0}), {"time": [0.0, 60.0]}, stations=3
        )

    def test_every_number_stands_in_the_table_once(self) -> None:
        found, table = self.found(), self.found().to_frame()
        assert len(table) == 2 * (2 * 6 + 2 * 6 + 3 * 6 + 3 * 3)
        moments = table.filter((pl.col("quantity") == "My") & pl.col("at").is_not_null())
        assert moments["at"].to_list() == [0.0, 0.5, 1.0] * 2
        assert moments["row"].to_list() == [1, 1, 1, 2, 2, 2]
        assert moments["time"].to_list() == [0.0] * 3 + [60.0] * 3
        assert set(moments["of"]) == {"AB"}
        close(moments["value"], found.section_forces[:, 0, :, 4].ravel())
        stress = table.filter(pl.col("quantity") == "stress top")["value"]
        close(stress, found.stresses.of_members["AB"]["top"].ravel())

    @pytest.mark.parametrize("suffix", [".csv", ".parquet"])
    def test_a_file_holds_the_table(self, tmp_path: Path, suffix: str) -> None:
        path = tmp_path / f"results{suffix}"
        self.found().write(path)
        read = pl.read_csv(path) if suffix == ".csv" else pl.read_parquet(path)
        assert read.equals(self.found().to_frame())
        assert [one.name for one in tmp_path.iterdir()] == [path.name]

    def test_another_format_is_refused(self, tmp_path: Path) -> None:
        with pytest.raises(InputError, match=r"'\.txt' is no format of a table"):
            self.found().write(tmp_path / "results.txt")
        assert list(tmp_path.iterdir()) == []


class TestRefused:
    def test_a_mechanism_is_named(self) -> None:
        with pytest.raises(UnstableStructureError, match=r"node 'A' in rx|node 'B' in rx"):
            results(beam(["ux", "uy", "uz"], ["uy", "uz"]))

    def test_a_structure_without_loads_still_shows_that_it_can_move(self) -> None:
        with pytest.raises(UnstableStructureError):
            results(beam(["ux", "uy", "uz"], [], load=UNIFORM))

    def test_stations_are_a_whole_number_of_two_to_many(self) -> None:
        wrong: tuple[Any, ...] = (1, 10_002, 100_000_000, 2.5, True, "5")
        for stations in wrong:
            with pytest.raises(InputError, match="give a whole number from 2 to 10001"):
                results(beam(PINNED, SLIDING), stations=stations)
        assert len(results(beam(PINNED, SLIDING), stations=10_001).stations) == 10_001

    def test_more_than_memory_holds_is_refused(self) -> None:
        with pytest.raises(InputError, match="more than fit into memory"):
            results(beam(PINNED, SLIDING), {"time": np.arange(1_000_000.0)}, stations=1001)


def test_a_table_of_contexts_may_have_more_columns(two_bars: dict[str, Any]) -> None:
    model = read_model(two_bars, "two bars")
    values = {"load": [0.0, 5e4], "temperature": [10.0, 20.0]}
    table = pl.DataFrame({**values, "note": ["calm", "windy"]})
    from_table, by_name = results(model, table), results(model, values)
    np.testing.assert_array_equal(from_table.section_forces, by_name.section_forces)
    assert set(from_table.contexts) == set(values)


def test_a_context_that_there_is_not_is_no_context(two_bars: dict[str, Any]) -> None:
    with pytest.raises(InputError, match=r"'lode'.*the model has temperature, load"):
        results(read_model(two_bars, "two bars"), {"load": 0, "temperature": 10, "lode": 5e4})
