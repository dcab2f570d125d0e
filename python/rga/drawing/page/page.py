"""Writing the page: data, style and script in one file that needs no network."""

import json
from collections.abc import Sequence
from dataclasses import replace
from importlib.resources import files

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from rga.drawing.content import Content, Selection, gather
from rga.drawing.page.data import page_data
from rga.drawing.scene.scene import MOST_NAMED
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
    content = gather(model, replace(shown, deformed=False, forces=None, sensors=True))
    asked = shown.deformed or shown.forces is not None
    fault = ""
    response: Content | None = None
    try:
        response = gather(
            model, replace(shown, deformed=True, forces=shown.forces or "N", loads=())
        )
    except UnstableStructureError as error:
        if asked:
            raise
        fault = str(error)
    data = page_data(content, response)
    data["start"] = {
        "dark": shown.dark,
        "names": sorted(shown.names) if len(model.members) <= MOST_NAMED else [],
        "sensors": not asked if shown.sensors is None else shown.sensors,
        "loads": not asked or shown.loads is not None,
        "axes": shown.local_axes,
        "deformed": shown.deformed,
        "forces": shown.forces is not None,
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


def _facts(model: Model) -> str:
    counts: Sequence[tuple[int, str]] = (
        (len(model.nodes), "node"),
        (len(model.members), "member"),
        (len(model.supports), "support"),
        (len(model.sensors), "sensor"),
    )
    return ", ".join(f"{count} {word}{'' if count == 1 else 's'}" for count, word in counts)
