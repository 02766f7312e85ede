//! A pulse whose exponential tail is short beside its normal time.

/// From so far below the mean on, a normal distribution function is its asymptotic series [standard deviations].
const FAR: f64 = 25.0;

/// An exponential tail that is short beside the normal time: factors of the normal density, as series in which nothing
/// cancels, however short the tail is.
pub(super) struct ShortTail {
    /// Time since the tail's begin [standard deviations].
    u: f64,
    /// Length of the tail [standard deviations].
    w: f64,
    /// 1 - u w [1].
    q: f64,
    /// (1 - S) / x, where S = 1 - x + 3 x^2 - .. is the asymptotic series of Mills' ratio in x = (w / q)^2 [1].
    p: f64,
}

impl ShortTail {
    /// `None` where the series does not hold.
    pub fn of(t_ps: f64, sigma_ps: f64, tail_ps: f64) -> Option<Self> {
        let (u, w) = ((t_ps + tail_ps) / sigma_ps, tail_ps / sigma_ps);
        let q = 1.0 - u * w;
        let x = (w / q).powi(2);
        let p = 1.0 - x * (3.0 - x * (15.0 - x * (105.0 - x * 945.0)));
        (q > FAR * w).then_some(ShortTail { u, w, q, p })
    }

    /// The density, of the normal one at the tail's begin [1].
    pub fn density(&self) -> f64 {
        (1.0 - (self.w / self.q).powi(2) * self.p) / self.q
    }

    /// The slope, of the normal density there over its standard deviation [1].
    pub fn slope(&self) -> f64 {
        (self.w / self.q.powi(2) * self.p - self.u) / self.q
    }
}
