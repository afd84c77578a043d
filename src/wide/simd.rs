use fearless_simd::Level;

/// A set of instructions for many numbers at a time; all give the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Simd {
    /// None: one number at a time, as far as the compiler does not know better.
    Scalar,
    /// The least that a target has: SSE2 on x86-64.
    Baseline,
    /// SSE4.2.
    Sse42,
    /// AVX2.
    Avx2,
    /// AVX-512, of the extent of Ice Lake.
    Avx512,
}

impl Simd {
    /// All kinds.
    const ALL: [Self; 5] = [Self::Scalar, Self::Baseline, Self::Sse42, Self::Avx2, Self::Avx512];

    /// The kinds that this machine has, the slowest first.
    ///
    /// ```
    /// use hitscan::wide::Simd;
    /// assert_eq!(Simd::available().next(), Some(Simd::Scalar));
    /// ```
    pub fn available() -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().filter(|kind| kind.level().is_some())
    }

    /// What the kernels are dispatched by; none if this machine does not have it.
    pub(super) fn level(self) -> Option<Level> {
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        let best = Level::new();
        match self {
            Self::Scalar => Some(Level::fallback()),
            Self::Baseline => Some(Level::baseline()),
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Self::Sse42 => best.as_sse4_2().map(fearless_simd::Simd::level),
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Self::Avx2 => best.as_avx2().map(fearless_simd::Simd::level),
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Self::Avx512 => best.as_avx512().map(fearless_simd::Simd::level),
            #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
            _ => None,
        }
    }
}
