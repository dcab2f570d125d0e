"""Writing the page: data, style and script in one file that needs no network."""

import json
from collections.abc import Sequence
from dataclasses import replace
from importlib.resources import files

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from rga.drawing.content import Selection, gather
from rga.drawing.page.data import page_data
from rga.drawing.scene.scene import MOST_NAMED, Scene
from rga.drawing.states.diagrams import Quantity
from rga.drawing.states.response import drawn_response
from rga.errors import UnstableStructureError
from rga.model.schema import Model

#: in the order in which they need each other
SCRIPTS = ("paint.js", "camera.js", "view.js", "hand.js", "switches.js")
#: characters that could end a script, or a line of one, as JSON writes them otherwise
ESCAPES = {ord(c): f"\\u{ord(c):04x}" for c in "<>&\u2028\u2029"}


def page(model: Model, shown: Selection) -> str:
    """A page that shows a model from all sides.

    It holds the loads, the sensors, the deformed shape and axial forces; what was asked for is
    switched on at first.

    Raises:
        InputError: as for `gather`.
        UnstableStructureError: a deformed shape or forces of a structure that can move were
            asked for.
    """
    plain = replace(shown, deformed=False, forces=None, sensors=True)
    content = gather(model, plain)
    fault, response = "", None
    try:
        response = drawn_response(
            content.scene,
            shown.contexts,
            _quantities(content.scene, shown.forces),
            shown.scale,
        )
    except UnstableStructureError as error:
        if shown.of_response:
            raise
        fault = str(error)
    data = page_data(content, response)
    data["start"] = {
        "dark": shown.dark,
        "names": sorted(shown.names) if len(model.members) <= MOST_NAMED else [],
        "sensors": not shown.of_response if shown.sensors is None else shown.sensors,
        "loads": not shown.of_response or shown.loads is not None,
        "axes": shown.local_axes,
        "deformed": shown.deformed,
        "forces": shown.forces or "",
    }
    environment = Environment(
        loader=PackageLoader("rga.drawing.page"), autoescape=True, undefined=StrictUndefined
    )
    folder = files("rga.drawing.page") / "templates"
    return environment.get_template("model.html.j2").render(
        title=model.name,
        facts=_facts(model),
        fault=fault,
        data=Markup(json.dumps(data, allow_nan=False).translate(ESCAPES)),
        style=Markup((folder / "view.css").read_text(encoding="utf-8")),
        scripts=[Markup((folder / name).read_text(encoding="utf-8")) for name in SCRIPTS],
    )


def _quantities(scene: Scene, asked: Quantity | None) -> list[Quantity]:
    """Section forces that the page can show: of bars N alone."""
    plane: list[Quantity] = ["N", "V", "M"]
    space: list[Quantity] = ["N", "Vy", "Vz", "T", "My", "Mz"]
    found = (space if scene.model.plane is None else plane) if scene.frame.any() else ["N"]
    return [*found, *([asked] if asked is not None and asked not in found else [])]


def _facts(model: Model) -> str:
    counts: Sequence[tuple[int, str]] = (
        (len(model.nodes), "node"),
        (len(model.members), "member"),
        (len(model.supports), "support"),
        (len(model.sensors), "sensor"),
    )
    return ", ".join(f"{count} {word}{'' if count == 1 else 's'}" for count, word in counts)
