use hitscan::{
    geometry::Aabb,
    glam::Vec3,
    render::{Light, Material},
};

use super::Viewpoint;

/// Where light comes from.
#[derive(Clone, Debug)]
pub struct Lighting {
    /// The lights.
    pub lights: Vec<Light>,
    /// From everywhere.
    pub ambient: Vec3,
    /// The sky's colours below and above.
    pub background: [Vec3; 2],
}

impl Lighting {
    /// A lamp over the photographer's left shoulder and a weak blue one from the right, as in a studio.
    pub fn studio(bounds: &Aabb, view: &Viewpoint) -> Self {
        let (center, radius) = (bounds.center(), bounds.size().length() * 0.5);
        let backward = -view.camera.forward();
        let lamp = center + (backward * 0.8 - view.right * 1.4 + view.above * 1.5) * (radius * 3.0);
        let fill = backward * 0.4 + view.right + view.above * 0.6;
        Self {
            lights: vec![
                Light::point(lamp, Vec3::new(0.92, 0.86, 0.76)),
                Light::directional(-fill, Vec3::new(0.13, 0.16, 0.20)),
            ],
            ambient: Vec3::new(0.11, 0.12, 0.14),
            background: [Vec3::new(0.62, 0.66, 0.70), Vec3::new(0.06, 0.13, 0.26)],
        }
    }
}

/// What a mesh without materials is made of: glazed clay.
pub fn glazed() -> Material {
    Material::matte(Vec3::new(0.66, 0.60, 0.52)).with_highlights(0.35, 60.0).with_reflectivity(0.08)
}

/// What it stands on.
pub fn plate() -> Material {
    Material::matte(Vec3::new(0.28, 0.30, 0.32)).with_highlights(0.1, 40.0).with_reflectivity(0.12)
}
