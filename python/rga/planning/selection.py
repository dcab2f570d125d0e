"""Which measurements to take: greedily, with exchanges, the cheapest that separate all pairs."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray
from rga.experiments.measurement_model import Errors
from rga.experiments.separation import Known, Pair, known, nothing, whitened, with_one_more
from rga.experiments.site import Site

#: rounds of exchange, and the smallest share by which an exchange must lower the confusion
EXCHANGES, WORTH = 3, 0.01


@dataclass(frozen=True)
class Choice:
    """Measurements that are taken.

    Attributes:
        sensors: columns of the site that are added, in the order of choice.
        tests: numbers of the load tests.
        separation: d_perp of every pair, float[pairs].
    """

    sensors: tuple[int, ...]
    tests: tuple[int, ...]
    separation: FloatArray


class Chooser:
    """Chooses measurements of a site for pairs of explanations.

    The confusion of two explanations at separation d is at most exp(-d^2 / 8): Bhattacharyya's
    bound for normal distributions (Kailath 1967, IEEE Transactions on Communication Technology
    15). The sum of it over the pairs is lowered: the smallest separation counts most.

    Args:
        site: with all that could be measured.
        errors: about one of the explanations.
        pairs: that are to be separated.
        enough: separation beyond which no more is bought [-].
    """

    def __init__(self, site: Site, errors: Errors, pairs: Sequence[Pair], enough: float) -> None:
        self._site, self._errors, self._pairs, self._enough = site, errors, pairs, enough

    def separation(self, sensors: Sequence[int], tests: Sequence[int]) -> FloatArray:
        """d_perp of every pair by some measurements, float[pairs]."""
        return np.sqrt([one.square for one in self._known(sensors, tests)])

    def alone(self) -> list[Choice]:
        """Every sensor and every test by itself, that which confuses least first."""
        none = self._measured((), ())
        several = [*self._sensors_more(none), *self._tests_more(none)]
        return sorted(several, key=self._confused)

    def best(
        self,
        most_sensors: int,
        most_tests: int,
        first: tuple[Sequence[int], Sequence[int]] = ((), ()),
    ) -> Choice:
        """The choice within a budget of sensors and of tests.

        Args:
            most_sensors, most_tests: the budget.
            first: sensors and tests from which the choice begins beside beginning from none; of
                choices that are alike theirs is taken.
        """
        sensors, tests = tuple(first[0])[:most_sensors], tuple(first[1])[:most_tests]
        plain = self._begun_with(self._measured((), ()), most_sensors, most_tests)
        if not sensors and not tests:
            return plain
        begun = self._begun_with(self._measured(sensors, tests), most_sensors, most_tests)
        before, after = self._confused(plain), self._confused(begun)
        if abs(after - before) > WORTH * before:
            return begun if after < before else plain
        return begun if self.cost(begun) <= self.cost(plain) else plain

    def _begun_with(self, chosen: Choice, most_sensors: int, most_tests: int) -> Choice:
        while not self._separates(chosen):
            options = self._sensors_more(chosen) if len(chosen.sensors) < most_sensors else []
            if len(chosen.tests) < most_tests:
                options += self._tests_more(chosen)
            better = self._best_buy(chosen, options)
            if better is None and len(chosen.sensors) < most_sensors:
                # A test may say nothing but to a sensor that is not there yet.
                with_test = self._tests_more(chosen) if len(chosen.tests) < most_tests else []
                together = [both for one in with_test for both in self._sensors_more(one)]
                better = self._best_buy(chosen, together)
            if better is None:
                break
            chosen = better
        for _ in range(EXCHANGES):
            exchanged = self._exchanged(chosen)
            if exchanged is chosen:
                break
            chosen = exchanged
        return self._without_needless(chosen)

    def _exchanged(self, chosen: Choice) -> Choice:
        for kind, more in (("sensors", self._sensors_more), ("tests", self._tests_more)):
            for one in getattr(chosen, kind):
                if self._separates(chosen):
                    return chosen
                without = self._without(chosen, kind, one)
                best = min(more(without), key=self._confused, default=chosen)
                if self._confused(best) < (1 - WORTH) * self._confused(chosen):
                    chosen = best
        return chosen

    def _without_needless(self, chosen: Choice) -> Choice:
        """Drop, the dearest first, what is not needed to separate as far as is enough."""
        priced = [(self._cost_of(kind, one), kind, one) for kind in ("tests", "sensors")
                  for one in getattr(chosen, kind)]  # fmt: skip
        for _, kind, one in sorted(priced, key=lambda item: -item[0]):
            without = self._without(chosen, kind, one)
            needed = np.minimum(chosen.separation, self._enough)
            if (without.separation >= needed - 1e-9).all():
                chosen = without
        return chosen

    def _best_buy(self, chosen: Choice, options: Sequence[Choice]) -> Choice | None:
        """The option that lowers the confusion most for its cost; None where none lowers it."""
        now = self._confused(chosen)
        lower = [one for one in options if self._confused(one) < (1 - WORTH) * now]
        paid = self.cost(chosen)
        enough = [one for one in lower if self._separates(one)]
        if enough:
            return min(enough, key=self.cost)
        return min(
            lower,
            key=lambda one: np.log(self._confused(one) / now) / (self.cost(one) - paid),
            default=None,
        )

    def cost(self, chosen: Choice) -> float:
        """In strain gauges put on."""
        return sum(self._cost_of("sensors", one) for one in chosen.sensors) + sum(
            self._cost_of("tests", one) for one in chosen.tests
        )

    def _cost_of(self, kind: str, one: int) -> float:
        site = self._site
        return site.added[one - site.standing].cost if kind == "sensors" else site.tests[one].cost

    def _measured(self, sensors: tuple[int, ...], tests: tuple[int, ...]) -> Choice:
        return Choice(sensors, tests, self.separation(sensors, tests))

    def _without(self, chosen: Choice, kind: str, one: int) -> Choice:
        kept = {"sensors": chosen.sensors, "tests": chosen.tests}
        kept[kind] = tuple(other for other in kept[kind] if other != one)
        return self._measured(**kept)

    def _tests_more(self, chosen: Choice) -> list[Choice]:
        rest = (one for one in range(len(self._site.tests)) if one not in chosen.tests)
        return [self._measured(chosen.sensors, (*chosen.tests, one)) for one in rest]

    def _sensors_more(self, chosen: Choice) -> list[Choice]:
        before = self._known(chosen.sensors, chosen.tests)
        rows = [*range(self._site.operating), *self._rows(chosen.tests)]
        columns = range(self._site.standing, len(self._site.sensors))
        more = whitened(self._errors, self._pairs, rows, columns)
        squares = [with_one_more(one, more, k) for k, one in enumerate(before)]
        by_sensor = np.sqrt(np.array(squares).T)
        first = self._site.standing
        return [
            Choice((*chosen.sensors, first + k), chosen.tests, separation)
            for k, separation in enumerate(by_sensor)
            if first + k not in chosen.sensors
        ]

    def _known(self, sensors: Sequence[int], tests: Sequence[int]) -> list[Known]:
        measured = [
            whitened(self._errors, self._pairs, rows, columns)
            for rows, columns in (
                (self._rows(tests), range(self._site.standing)),
                ([*range(self._site.operating), *self._rows(tests)], sensors),
            )
            if rows and columns
        ]
        if not measured:
            return [nothing(self._errors, pair) for pair in self._pairs]
        return [known(measured, k) for k in range(len(self._pairs))]

    def _rows(self, tests: Sequence[int]) -> list[int]:
        return [self._site.operating + one for one in tests]

    def _separates(self, chosen: Choice) -> bool:
        return bool((chosen.separation >= self._enough).all())

    def _confused(self, chosen: Choice) -> float:
        return float(np.exp(-(np.minimum(chosen.separation, self._enough) ** 2) / 8).sum())
