"""Templates of the pages, filled."""

from collections.abc import Mapping
from datetime import UTC
from typing import Any
from uuid import uuid4

from jinja2 import Environment, PackageLoader, StrictUndefined
from starlette.responses import HTMLResponse

from rga.dashboard.access.roles import Who
from rga.dashboard.pages.happened import SIGNS
from rga.dashboard.pages.heading import TABS
from rga.dashboard.pages.times import plain_times, utc_words

_ENVIRONMENT = Environment(
    loader=PackageLoader("rga.dashboard"),
    autoescape=True,
    undefined=StrictUndefined,
    trim_blocks=True,
    lstrip_blocks=True,
)
_ENVIRONMENT.filters |= {
    "utc": utc_words,
    "iso": lambda moment: moment.astimezone(UTC).isoformat().replace("+00:00", "Z"),
    "field": lambda moment: f"{moment.astimezone(UTC):%Y-%m-%dT%H:%M}",
    "said": plain_times,
}
# Each form has a key of its own, so that what is sent twice is done once.
_ENVIRONMENT.globals |= {"tabs": TABS, "signs": SIGNS, "new_key": lambda: str(uuid4())}


def rendered(
    template: str, shown: Mapping[str, Any], who: Who, *, live: bool = True, status: int = 200
) -> HTMLResponse:
    """A page.

    Args:
        template: its name without ending.
        shown: what it shows.
        who: looks at it.
        live: it is drawn again when something happens.
        status: of the answer.
    """
    heading = shown.get("heading")
    twin = None if heading is None else heading.twin
    html = _ENVIRONMENT.get_template(f"{template}.html.j2").render(
        shown,
        who=who,
        live=live,
        stream=f"/api/v1/twins/{twin}/stream" if live and twin else "",
        may_operate=who.may("operator", twin),
    )
    # A name from a JSON file may hold half a surrogate pair, which UTF-8 cannot.
    return HTMLResponse(html.encode("utf-8", "replace"), status)
