//! Sums over a window, and what they tell of the next value.

use rga_simd::f64::Lanes;

use super::DIGITS_LEFT;
use super::rule::WindowRule;
use super::tile::{Eight, WIDTH};

/// Of each lane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Moments<N> {
    pub shift: N,
    /// S
    pub sum: N,
    /// Q
    pub square: N,
    /// Largest Q since S and Q were summed.
    pub peak: N,
    /// M Q - S^2; infinite while the window fills, so that nothing exceeds.
    pub spread: N,
}

impl Moments<Eight> {
    pub(super) const FILLING: Self = Self {
        shift: Eight::ZERO,
        sum: Eight::ZERO,
        square: Eight::ZERO,
        peak: Eight::ZERO,
        spread: Eight([f64::INFINITY; WIDTH]),
    };
}

/// A rule in numbers that stand in every lane.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(super) struct Weights<N> {
    count: N,
    /// Of r^2 and of M Q - S^2 in the comparison.
    own: N,
    others: N,
    /// Of the largest Q: what M Q - S^2 must not fall below.
    digits: N,
    zero: N,
}

impl<N: Copy> Weights<N> {
    #[inline(always)]
    pub(super) fn new<L: Lanes<Numbers = N>>(lanes: L, rule: &WindowRule) -> Self {
        let (own, others) = rule.weights();
        let count = rule.earlier() as f64;
        Self {
            count: lanes.splat(count),
            own: lanes.splat(own.max(0.0)),
            others: lanes.splat(others),
            digits: lanes.splat(DIGITS_LEFT * count),
            zero: lanes.splat(0.0),
        }
    }
}

impl<N: Copy> Moments<N> {
    #[inline(always)]
    pub(super) fn load<L: Lanes<Numbers = N>>(lanes: L, stored: &Moments<Eight>) -> Self {
        Self {
            shift: lanes.load(&stored.shift.0),
            sum: lanes.load(&stored.sum.0),
            square: lanes.load(&stored.square.0),
            peak: lanes.load(&stored.peak.0),
            spread: lanes.load(&stored.spread.0),
        }
    }

    /// The shift stays as it is.
    #[inline(always)]
    pub(super) fn store<L: Lanes<Numbers = N>>(&self, lanes: L, stored: &mut Moments<Eight>) {
        lanes.store(self.sum, &mut stored.sum.0);
        lanes.store(self.square, &mut stored.square.0);
        lanes.store(self.peak, &mut stored.peak.0);
        lanes.store(self.spread, &mut stored.spread.0);
    }

    /// Whether a value exceeds the bound; not where it is NaN.
    #[inline(always)]
    pub(super) fn exceeded<L: Lanes<Numbers = N>>(
        &self,
        lanes: L,
        weights: &Weights<N>,
        value: N,
    ) -> L::Mask {
        let gained = lanes.sub(value, self.shift);
        // -r, and the sign of r^2 for that of r.
        let short = lanes.take_product(weights.count, gained, self.sum);
        let own = lanes.mul(weights.own, short);
        let others = lanes.mul(weights.others, self.spread);
        lanes.above(weights.zero, lanes.mul_add(own, lanes.abs(short), others))
    }

    /// With a value in place of the oldest.
    #[inline(always)]
    pub(super) fn moved<L: Lanes<Numbers = N>>(
        &self,
        lanes: L,
        weights: &Weights<N>,
        value: N,
        oldest: N,
    ) -> Self {
        let gained = lanes.sub(value, self.shift);
        let lost = lanes.sub(oldest, self.shift);
        let change = lanes.sub(gained, lost);
        let sum = lanes.add(self.sum, change);
        let square = lanes.mul_add(change, lanes.add(gained, lost), self.square);
        Self {
            shift: self.shift,
            sum,
            square,
            peak: lanes.max(self.peak, square),
            spread: lanes.take_product(sum, sum, lanes.mul(weights.count, square)),
        }
    }

    /// Whether M Q - S^2 has enough digits.
    #[inline(always)]
    pub(super) fn sound<L: Lanes<Numbers = N>>(&self, lanes: L, weights: &Weights<N>) -> L::Mask {
        lanes.at_most(lanes.mul(weights.digits, self.peak), self.spread)
    }

    /// These where marked, else others.
    #[inline(always)]
    pub(super) fn select<L: Lanes<Numbers = N>>(
        &self,
        lanes: L,
        mask: L::Mask,
        others: &Self,
    ) -> Self {
        Self {
            shift: self.shift,
            sum: lanes.select(mask, self.sum, others.sum),
            square: lanes.select(mask, self.square, others.square),
            peak: lanes.select(mask, self.peak, others.peak),
            spread: lanes.select(mask, self.spread, others.spread),
        }
    }
}
