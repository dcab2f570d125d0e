"""Ways to infer contexts that several files test: those without labels, and the peers of others."""

from rga_bench.contexts.methods.discrepancy import smooth_discrepancy
from rga_bench.contexts.methods.domain_adaptation import skada_coral, skada_dann
from rga_bench.contexts.methods.ensemble_kalman import ensemble_kalman
from rga_bench.contexts.methods.iterated_kalman import iterated_kalman
from rga_bench.contexts.methods.low_rank import low_rank_discrepancy
from rga_bench.contexts.methods.neural_posterior import neural_posterior
from rga_bench.contexts.methods.posterior_modes import maximum_posterior
from rga_bench.contexts.methods.prior import prior_mean
from rga_bench.contexts.methods.unscented_kalman import unscented_kalman

UNLABELLED = [
    prior_mean,
    maximum_posterior,
    smooth_discrepancy,
    low_rank_discrepancy,
    iterated_kalman,
    unscented_kalman,
    ensemble_kalman,
]
#: packages that peers need
NEEDS = {neural_posterior: "sbi", skada_coral: "skada", skada_dann: "skada"}
