"""The source that a configuration states."""

from collections.abc import Collection

from rga.operation.sources.file_head import HeadFinder
from rga.operation.sources.folder import Folder
from rga.operation.sources.settings import (
    AnySource,
    FolderSource,
    MqttSource,
    OpcUaSource,
    SqlSource,
    source_name,
)
from rga.operation.sources.source import DataSource, Inlet, Polling
from rga.records.mapping import FileMapping

#: formats whose files have no line above their rows
_HEADLESS = ("line_protocol", "row", "number")


def opened(
    settings: AnySource, mapping: FileMapping, twin: str, names: Collection[str], inlet: Inlet
) -> DataSource | None:
    """The source, which is not started yet; None: it sends to this service by itself.

    Args:
        settings: of the source.
        mapping: of its logger.
        twin: name of the twin.
        names: of its sensors and contexts.
        inlet: keeps what it brings.

    Raises:
        InputError: a secret or a package is missing.
    """
    name = f"{settings.kind} of {twin}"
    if isinstance(settings, FolderSource):
        heads = HeadFinder(mapping, names, settings.format in _HEADLESS)
        folder = Folder(settings.path, settings.files, heads, inlet.cursor())
        return Polling(name, lambda ending: folder.look(inlet, ending), settings.poll)
    if isinstance(settings, MqttSource):
        from rga.operation.sources.mqtt import Broker

        return Broker(
            settings.url,
            settings.topics,
            twin,
            source_name(settings),
            settings.credentials,
            inlet,
        )
    if isinstance(settings, SqlSource):
        from rga.operation.sources.sql import SqlTable

        table = SqlTable(settings, mapping.time.zone)
        return Polling(name, lambda ending: table.look(inlet, ending), settings.poll)
    if isinstance(settings, OpcUaSource):
        from rga.operation.sources.opcua import OpcUaServer

        return OpcUaServer(name, settings, inlet)
    return None
