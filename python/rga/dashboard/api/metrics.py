"""What Prometheus reads of a service."""

import shutil
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

from fastapi import APIRouter, Depends
from prometheus_client import CollectorRegistry
from prometheus_client.exposition import CONTENT_TYPE_LATEST, generate_latest
from prometheus_client.metrics_core import (
    CounterMetricFamily,
    GaugeMetricFamily,
    Metric,
    StateSetMetricFamily,
)
from starlette.responses import Response

from rga.dashboard.access.may import may_see_some
from rga.dashboard.access.roles import Who
from rga.dashboard.api.served import answering, surroundings_of
from rga.dashboard.surroundings import SeenTwin, Surroundings
from rga.dashboard.twin_health import STATES, health_of
from rga.errors import InputError
from rga.operation.inbox.account import Account
from rga.twin.hardware.inbox import INBOX

router = APIRouter(tags=["health"])


@router.get(
    "/metrics",
    response_class=Response,
    responses=answering()
    | {200: {"content": {"text/plain": {}}, "description": "The text format of Prometheus."}},
)
def metrics(
    who: Annotated[Who, Depends(may_see_some)],
    known: Annotated[Surroundings, Depends(surroundings_of)],
) -> Response:
    """Numbers of every twin that whoever calls may see."""
    seen = [known.twin(name) for name in known.names if who.may("viewer", name)]
    registry = CollectorRegistry()
    registry.register(_Numbers(seen))
    return Response(generate_latest(registry), media_type=CONTENT_TYPE_LATEST)


class _Numbers:
    """Numbers of twins, taken as they are asked for."""

    def __init__(self, seen: list[SeenTwin]) -> None:
        self._seen = seen

    def collect(self) -> Iterator[Metric]:
        """All of them."""
        states = StateSetMetricFamily("rga_state", "1 for how the twin is", labels=["twin"])
        readable = _gauge("rga_twin_readable", "1 where the repository of the twin can be read")
        row_age = _gauge("rga_row_age_seconds", "Age of the last row that the twin has taken in")
        step_age = _gauge("rga_step_age_seconds", "Time since the twin did something")
        lag = _gauge("rga_lag_rows", "Rows that have come and were not played yet")
        gap = _gauge("rga_gap", "Mean gap of the last row, over the variance of the noise")
        steps = CounterMetricFamily("rga_steps", "Steps of the twin", labels=["twin"])
        faults = _gauge("rga_faults", "What keeps sources and rows of the twin from going on")
        inbox = _gauge("rga_inbox_bytes", "Size of the inbox")
        disk = _gauge("rga_disk_free_bytes", "Room that is left for the twin")
        packets = CounterMetricFamily(
            "rga_packets", "What became of packets", labels=["twin", "source", "fate"]
        )
        waiting = GaugeMetricFamily(
            "rga_packets_waiting", "Packets whose rows are not final", labels=["twin", "source"]
        )
        for seen in self._seen:
            name, directory = [seen.name], seen.served.directory
            faults.add_metric(name, len(seen.faults))
            inbox.add_metric(name, _bytes_of(directory / INBOX))
            disk.add_metric(name, shutil.disk_usage(directory).free)
            for source, one in _accounts(seen).items():
                for fate in ("received", "used", "duplicate", "late", "refused"):
                    packets.add_metric([*name, source, fate], getattr(one, fate))
                waiting.add_metric([*name, source], one.waiting)
            try:
                now, view = seen.reading.now(), seen.reading.view()
            except InputError:
                readable.add_metric(name, 0)
                states.add_metric(name, _only("damaged"))
                continue
            readable.add_metric(name, 1)
            states.add_metric(name, _only(health_of(seen, now).word))
            lag.add_metric(name, seen.lag(now))
            if now is None or view is None:
                continue
            steps.add_metric(name, now.steps)
            step_age.add_metric(name, _age(datetime.fromisoformat(view.acknowledged_at)))
            if now.time is not None:
                row_age.add_metric(name, _age(now.time))
            if now.gap is not None:
                gap.add_metric(name, now.gap)
        yield from (states, readable, row_age, step_age, lag, gap, steps, faults, inbox, disk)
        yield from (packets, waiting)


def _gauge(name: str, words: str) -> GaugeMetricFamily:
    return GaugeMetricFamily(name, words, labels=["twin"])


def _only(word: str) -> dict[str, bool]:
    """Of all states of a twin the one that it is in."""
    return {state: state == word for state in STATES}


def _age(moment: datetime) -> float:
    return (datetime.now(UTC) - moment.astimezone(UTC)).total_seconds()


def _bytes_of(path: Path) -> int:
    """Size of a file of SQLite with what was written beside it."""
    files = (path, path.with_name(f"{path.name}-wal"))
    return sum(one.stat().st_size for one in files if one.exists())


def _accounts(seen: SeenTwin) -> dict[str, Account]:
    found: dict[str, Account] = {}
    for (source, _), one in seen.served.packets.account().items():
        found[source] = found.get(source, Account()) + one
    return found
