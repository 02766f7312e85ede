//! Binomial draws of a known probability, whose number of trials is about known.
//!
//! Exact, to the value and the number of random words: the algorithm is BTPE [1] as `rand_distr` has it (0.6, MIT or
//! Apache-2.0), in the same floating-point operations and with the names of the paper. It is faster because the
//! probability's part is computed once, the width of the triangle is known for numbers of trials near the expected
//! one, the kind of a draw is guessed from its word alone, and a comparison with the probability of a number of
//! successes is decided by products without a division. Means below ten are left to `rand_distr`.
//!
//! [1] V. Kachitvichyanukul, B. W. Schmeiser, "Binomial random variate generation", Commun. ACM 31, 216 (1988).

use std::ops::Range;

use rand::Rng;
use rand_distr::Distribution;

/// Least mean of the algorithm [1].
const LEAST_MEAN: f64 = 10.0;

/// Largest distance from the mode at which the recurrence is preferred to the squeeze.
const NEAR: u64 = 20;

/// Bound of the relative error of a product of [`NEAR`] factors, and of the recurrence; the true one is below 1e-11.
const UNDECIDED: f64 = 1e-9;

/// Distribution of successes among fewer than 2^53 trials.
#[derive(Clone, Debug)]
pub(super) struct Binomial {
    probability: f64,
    /// The lesser of the probabilities of success and failure.
    p: f64,
    /// The greater one.
    q: f64,
    /// Their ratio.
    s: f64,
    /// Half the width of the triangle for each number of trials in `same`.
    p1: f64,
    /// Numbers of trials for which the width is `p1`.
    same: Range<f64>,
    /// Approximate part of all words below which a draw is from the triangle [1].
    triangle: f64,
    /// Approximate part of all words above which a draw is from a tail [1].
    tails: f64,
}

/// What draws are chosen from before some are rejected: a triangle, a parallelogram on either side, and two
/// exponential tails. [`p1`](Hat::p1) and the others are the sums of their areas.
struct Hat {
    n: f64,
    /// Mode.
    m: f64,
    x_m: f64,
    x_l: f64,
    x_r: f64,
    c: f64,
    p1: f64,
    p2: f64,
    p3: f64,
    p4: f64,
    lambda_l: f64,
    lambda_r: f64,
}

impl Binomial {
    /// Successes of that probability among about `trials` trials.
    pub(super) fn new(probability: f64, trials: f64) -> Self {
        let p = if probability > 0.5 { 1.0 - probability } else { probability };
        let q = 1.0 - p;
        let trials = trials.max(LEAST_MEAN / p);
        let p1 = half_width(trials * p * q, q);
        let trials_at = |floor: f64| ((floor + 4.6 * q) / 2.195).powi(2) / (p * q);
        // A bit narrower, for the rounding.
        let same = trials_at(p1 - 0.5) * (1.0 + 1e-12)..trials_at(p1 + 0.5) * (1.0 - 1e-12);
        let mut all = Binomial { probability, p, q, s: p / q, p1, same, triangle: 0.0, tails: 0.0 };
        let hat = all.hat(trials, trials * p);
        (all.triangle, all.tails) = (hat.p1 / hat.p4, hat.p2 / hat.p4);
        all
    }

    /// Draws the number of successes among `trials`.
    #[inline(always)]
    pub(super) fn draw(&self, trials: u64, random: &mut impl Rng) -> u64 {
        let n = trials as f64;
        let np = n * self.p;
        if np >= LEAST_MEAN {
            let y = self.btpe(&self.hat(n, np), random);
            if self.probability > 0.5 { trials - y } else { y }
        } else {
            let few = rand_distr::Binomial::new(trials, self.probability);
            few.map_or(0, |few| few.sample(random))
        }
    }

    #[inline(always)]
    fn hat(&self, n: f64, np: f64) -> Hat {
        let &Binomial { p, q, .. } = self;
        let f_m = np + p;
        let m = f_m.floor();
        let p1 = if self.same.contains(&n) { self.p1 } else { half_width(np * q, q) };
        let x_m = m + 0.5;
        let (x_l, x_r) = (x_m - p1, x_m + p1);
        let c = 0.134 + 20.5 / (15.3 + m);
        let p2 = p1 * (1.0 + 2.0 * c);
        let lambda = |a: f64| a * (1.0 + 0.5 * a);
        let lambda_l = lambda((f_m - x_l) / (f_m - x_l * p));
        let lambda_r = lambda((x_r - f_m) / (x_r * q));
        let p3 = p2 + c / lambda_l;
        let p4 = p3 + c / lambda_r;
        Hat { n, m, x_m, x_l, x_r, c, p1, p2, p3, p4, lambda_l, lambda_r }
    }

    #[inline(always)]
    fn btpe(&self, hat: &Hat, random: &mut impl Rng) -> u64 {
        loop {
            let (word, v) = (uniform(random.next_u64()), uniform(random.next_u64()));
            let u = word * hat.p4;
            // Guesses from the word alone, which are checked: a processor that has mistaken the kind of the draw
            // knows it before the hat is computed.
            let drawn = if word < self.triangle && u <= hat.p1 {
                return hat.triangle(u, v);
            } else if word > self.tails && u > hat.p2 {
                hat.tail(u, v)
            } else if u <= hat.p1 {
                return hat.triangle(u, v);
            } else if u <= hat.p2 {
                hat.parallelogram(u, v)
            } else {
                hat.tail(u, v)
            };
            let Some((y, v)) = drawn else { continue };
            if self.nearly_below(hat, y, v).unwrap_or_else(|| self.is_below(hat, y, v)) {
                return y;
            }
        }
    }

    /// Whether `v` is at most f(y), the probability of `y` successes over that of the mode; `None` where that
    /// needs more care.
    #[inline(always)]
    fn nearly_below(&self, hat: &Hat, y: u64, v: f64) -> Option<bool> {
        let m = hat.m as i64 as u64;
        let steps = y.abs_diff(m);
        if steps > NEAR {
            return None;
        }
        // The greater number's probability over the lesser one's is `above / below`.
        let (mut above, mut below) = (1.0, 1.0);
        let mut i = y.min(m) as f64;
        for _ in 0..steps {
            above *= (hat.n - i) * self.s;
            i += 1.0;
            below *= i;
        }
        let (v, f) = if y > m { (v * below, above) } else { (v * above, below) };
        if v < f * (1.0 - UNDECIDED) {
            Some(true)
        } else if v > f * (1.0 + UNDECIDED) {
            Some(false)
        } else {
            None
        }
    }

    /// Whether `v` is at most f(y), as `rand_distr` computes it.
    #[cold]
    #[inline(never)]
    fn is_below(&self, hat: &Hat, y: u64, v: f64) -> bool {
        let &Binomial { p, q, s, .. } = self;
        let (n, m) = (hat.n as u64, hat.m as u64);
        let npq = hat.n * p * q;
        let k = y.abs_diff(m);
        if k <= NEAR || k as f64 >= 0.5 * npq - 1.0 {
            // The recurrence from the lesser number to the greater one.
            let a = s * (hat.n + 1.0);
            let up = (m + 1..=y).fold(1.0, |f, i| f * (a / i as f64 - s));
            let f = (y + 1..=m).fold(up, |f, i| f / (a / i as f64 - s));
            return v <= f;
        }
        // The squeeze: bounds of ln f(y).
        let k = k as f64;
        let rho = (k / npq) * ((k * (k / 3.0 + 0.625) + 1.0 / 6.0) / npq + 0.5);
        let t = -0.5 * k * k / npq;
        let alpha = v.ln();
        if alpha < t - rho {
            return true;
        } else if alpha > t + rho {
            return false;
        }
        // By Stirling's formula.
        let [x1, f1, z, w] = [y, m, n - m, n - y].map(|count| (count + 1) as f64);
        let y_sub_m = y as f64 - m as f64;
        let ln_f = hat.x_m * (f1 / x1).ln()
            + ((n - m) as f64 + 0.5) * (z / w).ln()
            + y_sub_m * (w * p / (x1 * q)).ln()
            + stirling(f1)
            + stirling(z)
            - stirling(x1)
            - stirling(w);
        alpha <= ln_f
    }
}

impl Hat {
    /// Returns what is drawn from the triangle, which is never rejected.
    #[inline(always)]
    fn triangle(&self, u: f64, v: f64) -> u64 {
        (self.x_m - self.p1 * v + u) as i64 as u64
    }

    /// Returns what is drawn from a parallelogram, and the height of the point.
    #[inline(always)]
    fn parallelogram(&self, u: f64, v: f64) -> Option<(u64, f64)> {
        let x = self.x_l + (u - self.p1) / self.c;
        let height = v * self.c + 1.0 - (x - self.x_m).abs() / self.p1;
        (height <= 1.0).then_some((x as i64 as u64, height))
    }

    /// Returns what is drawn from a tail, and the height of the point.
    #[inline(never)]
    fn tail(&self, u: f64, v: f64) -> Option<(u64, f64)> {
        if u <= self.p3 {
            let x = self.x_l + v.ln() / self.lambda_l;
            (x >= 0.0).then_some((x as u64, v * ((u - self.p2) * self.lambda_l)))
        } else {
            let y = (self.x_r - v.ln() / self.lambda_r) as u64;
            (y <= self.n as u64).then_some((y, v * ((u - self.p3) * self.lambda_r)))
        }
    }
}

/// Half the width of the triangle.
#[inline(always)]
fn half_width(npq: f64, q: f64) -> f64 {
    (2.195 * npq.sqrt() - 4.6 * q).floor() + 0.5
}

/// Converts a word to a number from 0 to 1 as `rand`'s `Uniform` does.
#[inline(always)]
fn uniform(word: u64) -> f64 {
    f64::from_bits(1f64.to_bits() | word >> 12) - 1.0
}

/// Stirling's series.
fn stirling(a: f64) -> f64 {
    let a2 = a * a;
    (13860. - (462. - (132. - (99. - 140. / a2) / a2) / a2) / a2) / a / 166320.
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    /// Compares a draw with that of `rand_distr`, and the number of words.
    fn compare(probability: f64, trials: u64, expected: f64, random: &mut ChaCha8Rng) {
        let mut theirs = random.clone();
        let drawn = Binomial::new(probability, expected).draw(trials, random);
        let reference = rand_distr::Binomial::new(trials, probability).unwrap().sample(&mut theirs);
        let place = format!("{trials} trials of {probability}, expected {expected}");
        assert_eq!((drawn, random.get_word_pos()), (reference, theirs.get_word_pos()), "{place}");
    }

    #[test]
    fn a_million_draws_are_those_of_rand_distr() {
        let mut random = ChaCha8Rng::seed_from_u64(11);
        for draw in 0..1_000_000 {
            let trials = 2f64.powf(random.random_range(0.0..32.0)) as u64;
            let mean = 2f64.powf(random.random_range(3.0..20.0));
            let small = (mean / trials as f64).min(random.random());
            let probability = if draw % 3 == 0 { 1.0 - small } else { small };
            let expected = trials as f64 * random.random_range(0.8..1.2);
            compare(probability, trials, expected, &mut random);
        }
    }

    #[test]
    fn draws_with_extreme_probabilities_are_those_of_rand_distr() {
        let mut random = ChaCha8Rng::seed_from_u64(12);
        for probability in [0.0, 1e-300, 1e-17, 1e-9, 0.5, 0.5f64.next_up(), 1f64.next_down(), 1.0]
        {
            for trials in [0, 1, 19, 20, 21, 1 << 30, 1 << 52] {
                for expected in [0.0, 1.0, trials as f64] {
                    compare(probability, trials, expected, &mut random);
                }
            }
        }
    }

    #[test]
    fn a_width_that_is_known_is_the_one_that_is_computed() {
        let mut random = ChaCha8Rng::seed_from_u64(13);
        for _ in 0..100_000 {
            let p = 2f64.powf(random.random_range(-20.0..-1.0));
            let binomial = Binomial::new(p, random.random_range(10.0..1e6) / p);
            let q = binomial.q;
            for n in [binomial.same.start.ceil(), binomial.same.end.floor()] {
                if binomial.same.contains(&n) {
                    assert_eq!(half_width(n * p * q, q), binomial.p1, "{n} trials of {p}");
                }
            }
        }
    }
}
