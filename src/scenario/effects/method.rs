//! Methods of simulation and estimation.

/// Declares the methods, their list and their names.
macro_rules! methods {
    ($(#[doc = $meaning:literal] $method:ident: $name:literal,)*) => {
        /// A way to simulate or to estimate that holds only without certain effects.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Method {
            $(#[doc = $meaning] $method,)*
        }

        impl Method {
            /// All methods.
            pub const ALL: [Method; [$($name),*].len()] = [$(Method::$method),*];

            /// Returns the method's name in documents.
            pub fn name(self) -> &'static str {
                match self {
                    $(Method::$method => $name,)*
                }
            }
        }
    };
}

methods! {
    /// Fast-forwarding: idle cycles and whole shots are not stepped.
    FastForward: "fast-forwarding",
    /// Simulating each frame by itself, on any thread.
    SeparateFrames: "frames on several threads",
    /// Treating the shots of a frame as independent and alike.
    IndependentShots: "independent shots",
    /// Drawing the histogram of a frame at once from the closed form.
    HistogramDraw: "`--fidelity histogram`",
    /// Comparing with a Verilog bench.
    VerilogBench: "Verilog benches",
    /// The Cramér-Rao bound.
    CramerRaoBound: "the bound",
    /// The second opinion on each frame.
    SecondOpinion: "second opinions",
    /// The model of `--estimator likelihood`.
    Likelihood: "`likelihood`",
    /// The model of `--estimator two-echoes`.
    TwoEchoes: "`two-echoes`",
    /// The model of `likelihood_estimator`.
    LikelihoodEstimator: "`likelihood_estimator`",
    /// The model of `--estimator matched`.
    Matched: "`matched`",
    /// The model of `centroid_estimator`.
    Centroid: "`centroid`",
    /// The model of `--estimator peak` and `--estimator subtraction`.
    Peak: "`peak` and `subtraction`",
}

impl Method {
    /// Returns the method that this one is built on, whose obstacles are its own.
    pub(super) fn foundation(self) -> Option<Method> {
        match self {
            Method::HistogramDraw => Some(Method::IndependentShots),
            Method::SecondOpinion => Some(Method::LikelihoodEstimator),
            _ => None,
        }
    }
}
