"""All twins of the comparison, in as many processes as are asked for."""

from collections.abc import Callable, Sequence
from dataclasses import fields

import numpy as np

from rga.parallel import finished
from rga_bench.policies.setting import PolicySetting
from rga_bench.policies.twin_run import PolicyResult, run_twin

#: of a policy on all streams of a sort: the means of what was measured
Means = dict[str, float]


def compare(
    setting: PolicySetting,
    *,
    workers: int = 1,
    progress: Callable[[float], None] = lambda done: None,
) -> list[PolicyResult]:
    """Play every stream through a twin of every policy; nothing depends on the workers.

    Args:
        setting: how much is played.
        workers: processes at work.
        progress: told the share that is done.

    Returns:
        In the order of the tasks.
    """
    tasks = setting.tasks()
    known: dict[tuple[str, int, str], PolicyResult] = {}
    for task, played in finished(run_twin, tasks, workers=workers):
        known[task.stream, task.seed, task.policy] = played.result()
        progress(len(known) / len(tasks))
    return [known[task.stream, task.seed, task.policy] for task in tasks]


def means(played: Sequence[PolicyResult]) -> dict[tuple[str, str], Means]:
    """By stream and policy, the mean over the streams drawn of every measure."""
    places = dict.fromkeys((one.stream, one.policy) for one in sorted(played, key=_sort(played)))
    measures = [
        one.name for one in fields(PolicyResult) if one.name not in ("stream", "seed", "policy")
    ]
    return {
        place: {
            name: float(
                np.mean([getattr(p, name) for p in played if (p.stream, p.policy) == place])
            )
            for name in measures
        }
        for place in places
    }


def _sort(played: Sequence[PolicyResult]) -> Callable[[PolicyResult], int]:
    streams = list(dict.fromkeys(one.stream for one in played))
    return lambda one: streams.index(one.stream)
