/// Which hit a ray is cast for: see [`Scene::hit`](crate::Scene::hit).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Wanted {
    /// The first along the ray.
    Closest,
    /// The first that is found.
    Any,
}
