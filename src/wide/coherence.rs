use crate::geometry::Ray;

/// Whether the rays of batches go the same way as their neighbours do; the answers are the same whatever is said.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Coherence {
    /// A few of each batch's rays are looked at.
    #[default]
    Measured,
    /// They do, as a camera's rays.
    Coherent,
    /// They do not, as after many bounces.
    Incoherent,
}

/// Pairs of rays that are looked at.
const PAIRS: usize = 16;

impl Coherence {
    /// Whether rays that follow each other go nearly the same way: most at angles of at most this sine.
    pub(super) fn is_found(self, rays: &[Ray], sine: f32) -> bool {
        match self {
            Self::Measured => measure(rays, sine),
            Self::Coherent => true,
            Self::Incoherent => false,
        }
    }
}

/// Whether most neighbours' directions are not farther apart than this.
fn measure(rays: &[Ray], sine: f32) -> bool {
    let step = (rays.len() / PAIRS).max(2);
    let alike = rays.chunks_exact(step).filter(|rays| {
        let &[a, b, ..] = rays else { return false };
        let (a, b) = (a.direction, b.direction);
        a.dot(b) > 0.0 && a.cross(b).length_squared() < sine * sine * a.length_squared() * b.length_squared()
    });
    alike.count() * 4 > rays.chunks_exact(step).len() * 3
}
