"""The gap before and after, by sensor and by group."""

from collections.abc import Mapping, Sequence

import numpy as np

from rga.arrays import FloatArray
from rga.diagnosis.data.held_out import Gain
from rga.findings.arrays import DiagnosisArrays
from rga.findings.schema import (
    Gap,
    GroupGap,
    HeldOut,
    SensorGap,
)


def gap(account: DiagnosisArrays, gained: Gain) -> Gap:
    """The gap on the fitted rows and by sensor, and the gain by the held-out rows."""
    measured = account.record.readings
    before = ((measured - account.before) / account.noise) ** 2
    after = ((measured - account.after) / account.noise) ** 2
    fitted = ~account.held_out
    by_sensor = {
        name: SensorGap(
            before=float(np.nanmean(before[fitted, k])), after=float(np.nanmean(after[fitted, k]))
        )
        for k, name in enumerate(account.record.sensors)
        if not account.rejected[k] and np.isfinite(before[fitted, k]).any()
    }
    return Gap(
        before=float(np.nanmean(before[fitted])),
        after=float(np.nanmean(after[fitted])),
        held_out=HeldOut(
            before=gained.before,
            after=gained.after,
            gain=gained.before - gained.after,
            gain_ci90=gained.interval,
        ),
        by_sensor=by_sensor,
    )


def groups(account: DiagnosisArrays, grouped: Mapping[str, Sequence[str]]) -> list[GroupGap]:
    """Measured over simulated of each group of sensors, in percent off.

    Of causes that begin late from their onset on: rows before it would dilute what they do.
    """
    since = account.record.time_label(float(account.record.time[account.since]))
    order = {name: k for k, name in enumerate(account.record.sensors)}
    return [
        GroupGap(
            group=word,
            sensors=list(names),
            before_percent=_percent_off(account, account.before, [order[n] for n in names]),
            after_percent=_percent_off(account, account.after, [order[n] for n in names]),
            since=since if account.since else None,
        )
        for word, names in grouped.items()
    ]


def _percent_off(account: DiagnosisArrays, simulated: FloatArray, columns: Sequence[int]) -> float:
    acting = slice(account.since, None)
    measured, own = account.record.readings[acting, columns], simulated[acting, columns]
    seen = np.isfinite(measured) & np.isfinite(own)
    weight = np.broadcast_to(account.sigma[list(columns)] ** -2, measured.shape)[seen]
    power = float((weight * own[seen] ** 2).sum())
    if power == 0:
        return 0.0
    return 100 * (float((weight * own[seen] * measured[seen]).sum()) / power - 1)
