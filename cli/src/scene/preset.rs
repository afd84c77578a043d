/// How much memory a structure may take for speed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Preset {
    /// The fewest bytes.
    Small,
    /// Nearly as fast in less than half the bytes of `fast`.
    #[default]
    Balanced,
    /// The least time per ray.
    Fast,
}

impl Preset {
    /// All of them, the fewest bytes first.
    pub const ALL: [Self; 3] = [Self::Small, Self::Balanced, Self::Fast];

    /// Its name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Small => "small",
            Self::Balanced => "balanced",
            Self::Fast => "fast",
        }
    }

    /// The most bytes per primitive that a structure may take to be recommended.
    pub const fn bytes_per_primitive(self) -> f64 {
        match self {
            Self::Small => 16.0,
            Self::Balanced => 40.0,
            Self::Fast => 200.0,
        }
    }
}
