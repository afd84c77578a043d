//! Metal and roughness in the terms of Phong's model.

use crate::model::{Image, Material};

/// Metals reflect by their colour and scatter nothing; all else scatters, with a white 4 % highlight.
/// `image` is the picture by which the colour is multiplied.
pub(super) fn shading(material: &gltf::Material<'_>, image: Option<Image>) -> Material {
    let physical = material.pbr_metallic_roughness();
    // Where a picture says what is metal, most is not.
    let metallic = match physical.metallic_roughness_texture() {
        Some(_) => 0.0,
        None => physical.metallic_factor().clamp(0.0, 1.0),
    };
    let roughness = physical.roughness_factor().clamp(0.0, 1.0);
    let [r, g, b, _] = physical.base_color_factor();
    let base = [r, g, b].map(|x| x.clamp(0.0, 1.0));
    // Phong's exponent for a GGX lobe of the same width (Walter 2007, alpha = roughness squared).
    let alpha = (roughness * roughness).max(0.03);
    Material {
        name: material.name().unwrap_or_default().to_owned(),
        diffuse: base.map(|x| x * (1.0 - metallic)),
        specular: base.map(|x| 0.04 + (x - 0.04) * metallic),
        shininess: (2.0 / (alpha * alpha) - 2.0).max(1.0),
        reflectivity: metallic * (1.0 - roughness),
        image,
    }
}
