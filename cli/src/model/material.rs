//! [`Material`]: how a surface answers light, in the terms of Phong's model.

use super::Image;

/// A surface's answer to light; colours are linear RGB from 0 to 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Its name in the file; empty where the file has none.
    pub name: String,
    /// Colour of the light scattered in all directions.
    pub diffuse: [f32; 3],
    /// Colour of the highlight.
    pub specular: [f32; 3],
    /// Phong exponent: the higher, the smaller the highlight.
    pub shininess: f32,
    /// Share of the light that is reflected as by a mirror, 0 to 1.
    pub reflectivity: f32,
    /// The picture by which the colour of scattered light is multiplied.
    pub image: Option<Image>,
}

impl Material {
    /// Matt light grey, for faces of which the file does not say more.
    pub fn neutral(name: impl Into<String>) -> Self {
        Material {
            name: name.into(),
            diffuse: [0.8; 3],
            specular: [0.0; 3],
            shininess: 1.0,
            reflectivity: 0.0,
            image: None,
        }
    }
}
