use super::{Caster, Material, Materials, Textures};
use crate::{
    accel::Entries,
    geometry::{Aabb, Bundle, Pencil, Ray},
    primitives::{Hit, Surface},
    query::ItemBuffer,
};

/// A scene whose materials have textures: a decorator, so that pictures without them do not pay.
///
/// A texture's colour is multiplied with the diffuse one. Where in it a hit is, [`Mapped`](crate::primitives::Mapped)
/// triangles tell.
///
/// ```
/// use hitscan::{
///     List, Mesh, Scene,
///     glam::{Vec2, Vec3},
///     primitives::{Mapped, TexCoords},
///     render::{Camera, Material, Materials, Numbers, Renderer, Texels, Texture, Textured, Textures},
/// };
/// let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
/// let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]])?;
/// let coordinates = [Vec2::new(0.0, 1.0), Vec2::ONE, Vec2::ZERO];
/// let scene = Scene::new(List::new(&mesh)?, Mapped::new(mesh, &mesh, TexCoords::new(&coordinates)))?;
///
/// let palette = [Material::matte(Vec3::ONE)];
/// let materials = Materials::new(&palette, Numbers::First);
/// let textures = [Some(Texture::new(2, 1, Texels::Rgb565(&[0xf800, 0x07e0]))?)];
/// let textured = Textured::new(&scene, materials, Textures::new(&textures));
/// let camera = Camera::framing(&scene.bounds(), Vec3::Z, Vec3::Y);
/// let renderer = Renderer::new(&textured, camera, 64, 48).with_ambient(Vec3::ONE);
/// let [left, right] = [renderer.pixel(24, 38), renderer.pixel(40, 38)];
/// assert!(left.x > left.y && right.y > right.x);
/// # Ok::<(), hitscan::Error>(())
/// ```
#[derive(Debug)]
pub struct Textured<'a, S: ?Sized> {
    scene: &'a S,
    materials: Materials<'a>,
    textures: Textures<'a>,
}

impl<S: ?Sized> Clone for Textured<'_, S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: ?Sized> Copy for Textured<'_, S> {}

impl<'a, S: Caster + ?Sized> Textured<'a, S> {
    /// A scene with materials and their textures; a renderer's materials count where a primitive's has none.
    #[must_use]
    pub const fn new(scene: &'a S, materials: Materials<'a>, textures: Textures<'a>) -> Self {
        Self { scene, materials, textures }
    }
}

impl<S: Caster + ?Sized> Caster for Textured<'_, S> {
    fn closest_hit(&self, ray: &Ray, depth: u32) -> Option<Hit> {
        self.scene.closest_hit(ray, depth)
    }

    fn enter(&self, bundle: &Bundle) -> Entries {
        self.scene.enter(bundle)
    }

    fn closest_hits(&self, pencil: &Pencil, hits: &mut ItemBuffer) -> bool {
        self.scene.closest_hits(pencil, hits)
    }

    fn closest_hit_from(&self, entries: &Entries, ray: &Ray) -> Option<Hit> {
        self.scene.closest_hit_from(entries, ray)
    }

    fn any_hit(&self, ray: &Ray, depth: u32) -> bool {
        self.scene.any_hit(ray, depth)
    }

    fn any_hit_near(&self, ray: &Ray, depth: u32, last: &mut Option<u32>) -> bool {
        self.scene.any_hit_near(ray, depth, last)
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        self.scene.surface(ray, hit)
    }

    fn material(&self, hit: &Hit, surface: &Surface) -> Option<Material> {
        let known = self.scene.material(hit, surface);
        let texture = self.materials.number(hit.primitive).and_then(|number| self.textures.get(number));
        let Some(texture) = texture else { return known };
        let material = known.unwrap_or_else(|| self.materials.of(hit.primitive));
        Some(Material { diffuse: material.diffuse * texture.color(surface.uv), ..material })
    }

    fn bounds(&self) -> Aabb {
        self.scene.bounds()
    }
}
