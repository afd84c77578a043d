use hitscan::{geometry::Aabb, glam::Vec3, render::Light};

/// Where light comes from.
#[derive(Clone, Debug)]
pub(crate) struct Lighting {
    /// The lights.
    pub(crate) lights: [Light; 2],
    /// From everywhere.
    pub(crate) ambient: Vec3,
    /// The sky's colours below and above.
    pub(crate) background: [Vec3; 2],
}

impl Lighting {
    /// A warm lamp to the left and a weak blue one to the right, as in a studio.
    pub(crate) fn studio(bounds: &Aabb, [up, right, front]: [Vec3; 3]) -> Self {
        let radius = bounds.size().length() * 0.5;
        let lamp = bounds.center() + (up * 2.0 - right * 1.3 + front * 1.4) * (radius * 1.6);
        let fill = front * 0.5 + right + up * 0.6;
        Self {
            lights: [
                Light::point(lamp, Vec3::new(1.0, 0.91, 0.78)),
                Light::directional(-fill, Vec3::new(0.16, 0.20, 0.27)),
            ],
            ambient: Vec3::new(0.14, 0.155, 0.185),
            background: [Vec3::new(0.50, 0.54, 0.60), Vec3::new(0.02, 0.06, 0.16)],
        }
    }
}
