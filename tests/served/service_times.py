"""A clock that tests set."""

from datetime import UTC, datetime, timedelta

from rga.operation.service_clock import ServiceClock

NOON = datetime(2026, 11, 27, 12, tzinfo=UTC)


class SetClock(ServiceClock):
    """A clock that stands still until a test lets time pass."""

    def __init__(self) -> None:
        self.at, self.elapsed = NOON, 0.0

    def now(self) -> datetime:
        return self.at

    def monotonic(self) -> float:
        return self.elapsed

    def pass_by(self, seconds: float) -> None:
        """Let time pass."""
        self.at += timedelta(seconds=seconds)
        self.elapsed += seconds
