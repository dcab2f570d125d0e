"""What would go wrong if a service began, in the order of its file."""

import os
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path

from rga.checking.finding import Finding, refused
from rga.errors import InputError
from rga.operation.configuration import Configuration, ServiceSettings
from rga.operation.disk.forecast import YearlyGrowth
from rga.operation.disk.room import DiskRoom
from rga.operation.service_clock import ServiceClock, microseconds
from rga.operation.sources.settings import AnySource, source_name
from rga.operation.sources.source import attempt
from rga.operation.trial.expected_rows import (
    calibration_findings,
    growth_note,
    growth_of,
    noise_findings,
    room_findings,
)
from rga.operation.trial.listening import Heard, listened_to
from rga.operation.trial.twin_files import TwinFiles, repository_findings
from rga.operation.trial.what_came import (
    WhatCame,
    channel_findings,
    clock_findings,
    silent_findings,
    source_findings,
    what_came,
)
from rga.twin.repository.database import FILE_NAME


def service_findings(configuration: Configuration, wait: float) -> list[Finding]:
    """What would go wrong with a service but for its door; nothing is written.

    Args:
        configuration: of the service.
        wait: how long its sources are listened to [s].
    """
    service = configuration.service
    found = list(_disk(service, configuration.alarms.disk))
    if configuration.notify:
        from rga.operation.notices.delivery import sender_of

        for one in configuration.notify:
            found += _of(partial(sender_of, one))
    files = []
    for twin in configuration.twin:
        try:
            files.append(TwinFiles.read(twin))
        except InputError as error:
            found += refused(error)
            continue
        directory = service.data / twin.name
        found += _of(partial(files[-1].check_goes_on, directory))
        if service.repository is None:
            found += _repository(f"twin {twin.name!r}", directory / FILE_NAME)
    if service.repository is not None:
        found += _repository("[service] repository", service.repository)
    return found + _heard(files, DiskRoom(_existing(service.data), configuration.alarms.disk), wait)


def _heard(files: Sequence[TwinFiles], room: DiskRoom, wait: float) -> list[Finding]:
    """What is wrong with sources and with what they bring, and what a year of it takes."""
    sources = [
        (
            one.settings.name,
            {*one.model.sensors, *one.model.context},
            source,
            one.readers[source_name(source)].mapping,
        )
        for one in files
        for source in one.settings.source
    ]
    heard = iter(listened_to(sources, wait))
    now = microseconds(ServiceClock().now())
    found: list[Finding] = []
    growths: list[YearlyGrowth] = []
    for one in files:
        own = [(source, next(heard)) for source in one.settings.source]
        came = [what_came(to.inlet, one.readers[source_name(source)], now) for source, to in own]
        found += _of_twin(one, own, came, now, wait)
        growths.append(growth_of(one, came))
        found.append(growth_note(f"twin {one.settings.name!r}", growths[-1], room.free))
    return [*found, *room_findings(growths, room)]


def _of_twin(
    files: TwinFiles,
    heard: Sequence[tuple[AnySource, Heard]],
    came: Sequence[WhatCame],
    now: int,
    wait: float,
) -> Iterator[Finding]:
    twin, model = files.settings, files.model
    for (source, one), brought in zip(heard, came, strict=True):
        name = source_name(source)
        where, reader = f"twin {twin.name!r}, {name}", files.readers[name]
        if one.error is not None:
            yield from refused(one.error)
            yield from channel_findings(where, reader)
            continue
        yield from source_findings(where, source, one, brought, reader, wait)
        yield from clock_findings(where, source, brought, now)
    where = f"twin {twin.name!r}"
    yield from silent_findings(where, model, twin.source, came, list(files.readers.values()))
    yield from noise_findings(where, model, twin, came)
    calibrated = files.run.pace(None).calibration_rows
    yield from calibration_findings(where, model, twin, calibrated)


def _disk(service: ServiceSettings, least: float) -> Iterator[Finding]:
    """Whether there is room for the twins, and whether it may be used."""
    place = _existing(service.data)
    where = f"[service] data = {str(service.data)!r}"
    if not place.is_dir() or not os.access(place, os.W_OK | os.X_OK):
        what = f"{place} cannot be written by this user"
        yield Finding("error", where, what, "let the user of the service write there")
    room = DiskRoom(place, least)
    if not room.is_enough():
        what = f"{room.free_share:.0%} of the disk is free, and {least:.0%} has to be"
        yield Finding("error", where, what, "make room, or lower [alarms] disk")


def _existing(folder: Path) -> Path:
    """A folder that may still have to be made, or the nearest above it that is there."""
    folder = folder.absolute()
    return next(one for one in (folder, *folder.parents) if one.exists())


def _repository(where: str, place: str | Path) -> list[Finding]:
    """What is wrong with a repository; a database that is away is one such thing."""
    found: list[Finding] = []
    fault = attempt(lambda: found.extend(repository_findings(where, place)))
    return found if fault is None else [Finding("error", where, fault, "see that it can be read")]


def _of(does: Callable[[], object]) -> list[Finding]:
    """What keeps something from being done."""
    try:
        does()
    except InputError as error:
        return refused(error)
    return []
