"""T2: the repository grows by contexts that nothing like has been simulated at."""

from collections.abc import Callable

from rga.twin.archive import Archive
from rga.twin.calibration.capture import ContextCapture
from rga.twin.messages.query_bus import QueryResponse
from rga.twin.novelty import novel
from rga.twin.settings import Settings


class Integration:
    """Keeps novel contexts of rows that the twin explains.

    Args:
        exchange: knows the twin.
        archive: keeps them.
        calibration: knows the contexts of the rows.
        settings: of the run.
        event: notes a kind of event, its row and its words.
    """

    def __init__(
        self,
        exchange: QueryResponse,
        archive: Archive,
        calibration: ContextCapture,
        settings: Settings,
        event: Callable[..., None],
    ) -> None:
        self._exchange, self._archive = exchange, archive
        self._calibration, self._settings, self._event = calibration, settings, event

    def integrate(self, distinct: float, first: int, end: int) -> None:
        """Keep what is novel among rows.

        Args:
            distinct: least distance from all contexts that are kept, in shares of the ranges.
            first, end: of the rows.
        """
        state, calibration = self._exchange.twin.state, self._calibration
        if not state.latent:
            return
        latent, rows = calibration.latent, calibration.ledger.rows(first, end)
        mean, deviation = calibration.rows.summaries.gaps_before(first)
        chosen = novel(
            calibration.ledger.gaps(first, end),
            rows.contexts[:, latent],
            bound=mean + self._settings.repository_z * deviation,
            stored=self._archive.simulated_contexts(state.version)[:, latent],
            width=calibration.width,
            distinct=distinct,
        )
        if chosen:
            contexts, simulated = rows.contexts[chosen], rows.simulated[chosen]
            self._archive.keep_novel(state.version, end - 1, contexts, simulated)
            others, row = len(chosen) - 1, first + chosen[0]
            more = f", and those of {others} row{'s' * (others > 1)} more" if others else ""
            self._event("novel context", row, f"stored: {calibration.told(row)}{more}")
