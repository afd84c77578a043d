use glam::Vec3;

use super::{Caster, Material, Patch, Renderer};
use crate::{
    math,
    primitives::{Surface, unit},
};

/// The terms of light that are computed; each can be on alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Terms {
    /// Light from everywhere.
    pub ambient: bool,
    /// Scattered light of the lights.
    pub diffuse: bool,
    /// Highlights.
    pub specular: bool,
    /// Whether lights are seen from a surface at all.
    pub shadows: bool,
    /// Mirror images.
    pub reflections: bool,
}

impl Terms {
    /// All of them.
    pub const ALL: Self = Self { ambient: true, diffuse: true, specular: true, shadows: true, reflections: true };

    /// None of them.
    pub const NONE: Self = Self { ambient: false, diffuse: false, specular: false, shadows: false, reflections: false };
}

impl<S: Caster + ?Sized> Renderer<'_, S> {
    /// The light that a surface sends towards a viewer, mirror images aside, after so many reflections in a patch.
    pub(super) fn phong(
        &self,
        surface: &Surface,
        material: &Material,
        to_viewer: Vec3,
        (depth, patch): (u32, Option<&Patch<'_, S>>),
    ) -> Vec3 {
        let terms = &self.terms;
        let mut light = if terms.ambient { self.ambient * material.diffuse } else { Vec3::ZERO };
        if !terms.diffuse && !terms.specular {
            return light;
        }
        let normal = if surface.front { surface.shading_normal } else { -surface.shading_normal };
        for (number, source) in self.lights.iter().enumerate() {
            let to_light = unit(source.direction_from(surface.point));
            let cosine = normal.dot(to_light);
            // What faces away from a light is in its own shadow.
            if !(cosine > 0.0 && surface.normal_towards_ray().dot(to_light) > 0.0) {
                continue;
            }
            if terms.shadows {
                let ray = source.shadow_ray(surface.start_towards(to_light));
                let is_shaded = match patch {
                    Some(patch) => patch.shades(number, &ray, depth),
                    None => self.scene.any_hit(&ray, depth),
                };
                if is_shaded {
                    continue;
                }
            }
            if terms.diffuse {
                light += source.color() * material.diffuse * cosine;
            }
            if terms.specular {
                let highlight = mirror(-to_light, normal).dot(to_viewer);
                if highlight > 0.0 {
                    light += source.color() * material.specular * math::pow(highlight, material.shininess);
                }
            }
        }
        light
    }
}

/// `direction` thrown back by a surface with this normal.
pub(super) fn mirror(direction: Vec3, normal: Vec3) -> Vec3 {
    direction - normal * (2.0 * direction.dot(normal))
}
