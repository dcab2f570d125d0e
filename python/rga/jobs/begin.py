"""For whom the rows are that are fed in a directory: a live twin is begun there, or is known."""

from pathlib import Path

from rga.errors import InputError
from rga.files import made_directory
from rga.model import Model, as_model
from rga.numerics.seeds import as_seed
from rga.twin.hardware.inbox import INBOX, Addressee, Inbox
from rga.twin.hardware.interface import LIVE
from rga.twin.hardware.live import check_lives
from rga.twin.repository import Repository
from rga.twin.repository.database import FILE_NAME
from rga.twin.settings import Settings, as_settings
from rga.twin.versions import written


def begun(
    model: Model | str | Path,
    directory: str | Path,
    *,
    settings: Settings | str | Path | None = None,
    name: str | None = None,
    seed: int = 0,
) -> Path:
    """The directory of a live twin, which is named there unless it is known.

    Args:
        model: the structure with its effects and sensors, or its file.
        directory: for the inbox, the repository and the report.
        settings: with calibration_rows, packet and settle.
        name: of the twin; None: that of the structure.
        seed: of everything random.

    Raises:
        InputError: such a model cannot go on for ever, a setting is missing, the seed is none, or
            another twin is there.
    """
    wanted = addressee_of(as_model(model), as_settings(settings), name, seed)
    place = made_directory(directory)
    _check_holds_no_record(place)
    inbox = Inbox(place)
    try:
        known = inbox.name(wanted)
    finally:
        inbox.close()
    check_same(known, wanted, place)
    return place


def _check_holds_no_record(place: Path) -> None:
    """Whether no record was played in a directory.

    Raises:
        InputError: one was.
    """
    if (place / INBOX).exists() or not (place / FILE_NAME).exists():
        # Where an inbox is, a live twin has begun; its repository may be of an earlier rga.
        return
    with Repository.open(place, read_only=True) as repository:
        if any(not one.identity.source.startswith(LIVE) for one in repository.runs()):
            raise InputError(
                "a run of a finished record is here", str(place), "take another directory"
            )


def addressee_of(model: Model, settings: Settings, name: str | None, seed: int) -> Addressee:
    """Whom rows of a live twin are for.

    Raises:
        InputError: such a model cannot go on for ever, a setting is missing, or the seed is none.
    """
    seed = as_seed(seed)
    check_lives(model)
    settings.pace(None)
    text, digest = written(model)
    return Addressee(
        name or model.name, text, model.sha256 or digest, settings.model_dump_json(), seed
    )


def check_same(known: Addressee, wanted: Addressee, place: Path) -> None:
    """Whether the twin of a directory is the one that is wanted there.

    Raises:
        InputError: it is another.
    """
    compared = ("name", "model", "settings", "seed")
    if others := [one for one in compared if getattr(known, one) != getattr(wanted, one)]:
        raise InputError(
            f"a live twin that differs in {' and '.join(others)} is here",
            str(place),
            "give what it was begun with, or take another directory",
        )
