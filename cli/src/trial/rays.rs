use hitscan::{
    Ray,
    geometry::Aabb,
    glam::{Vec3, Vec3Swizzles},
    render::{Camera, Caster},
};

/// Primary rays of a trial.
const RAYS: usize = 4096;

/// Rays of three kinds at one scene: the same bits on every machine, so that what is counted on them is, too.
#[derive(Clone, Debug, Default)]
pub struct Rays {
    /// From a camera through the middles of its pixels.
    pub primary: Vec<Ray>,
    /// From where these hit, in directions distributed as a matte surface scatters light.
    pub bounce: Vec<Ray>,
    /// From where these hit to a lamp beside the camera; whether they hit is all that is asked.
    pub shadow: Vec<Ray>,
}

impl Rays {
    /// Those of a trial: from a camera that sees the whole scene.
    pub fn around(scene: &dyn Caster) -> Self {
        Self::new(scene, &outside(&scene.bounds()), RAYS)
    }

    /// About `count` primary rays, and as many of the others as of these hit.
    pub fn new(scene: &dyn Caster, camera: &Camera, count: usize) -> Self {
        let side = (count as f32).sqrt().ceil().max(1.0) as u32;
        let bounds = scene.bounds();
        let lamp = camera.eye() + (camera.eye() - bounds.center()).yzx() * 0.5 + bounds.size() * 0.05;
        let mut random = Random(0x9E37_79B9_7F4A_7C15);
        let mut rays = Self::default();
        for (x, y) in (0..side).flat_map(|y| (0..side).map(move |x| (x, y))) {
            let ray = camera.ray(x as f32 + 0.5, y as f32 + 0.5, side, side);
            rays.primary.push(ray);
            let Some(hit) = scene.closest_hit(&ray, 0) else { continue };
            let surface = scene.surface(&ray, &hit);
            let scattered = scatter(surface.normal_towards_ray(), &mut random);
            rays.bounce.push(Ray::new(surface.start_towards(scattered), scattered));
            rays.shadow.push(Ray::between(surface.start_towards(lamp - surface.point), lamp));
        }
        rays
    }
}

/// A camera that sees everything, from the front, the right and above.
pub fn outside(bounds: &Aabb) -> Camera {
    /// The angle of view: the sphere around the scene is 60 degrees wide from two of its radii away.
    const FOV: f32 = std::f32::consts::FRAC_PI_3;
    let ahead = Vec3::new(-0.5, -0.45, -0.74).normalize();
    let eye = bounds.center() - ahead * bounds.size().length().max(f32::MIN_POSITIVE);
    Camera::pinhole(eye, eye + ahead, Vec3::Y, FOV)
}

/// A direction around `normal`, as likely as the cosine of the angle between the two.
fn scatter(normal: Vec3, random: &mut Random) -> Vec3 {
    // Not quite 1, so that the sum is never zero.
    (normal + random.direction() * 0.9999).normalize()
}

/// A small generator of reproducible numbers (xorshift64*, Vigna 2016).
struct Random(u64);

impl Random {
    /// A number from -1 up to 1.
    fn signed(&mut self) -> f32 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 40) as f32 / 8_388_608.0 - 1.0
    }

    /// Any direction; by rejection, because sines are not the same on every machine.
    fn direction(&mut self) -> Vec3 {
        loop {
            let point = Vec3::new(self.signed(), self.signed(), self.signed());
            let square = point.length_squared();
            if (1.0e-4..=1.0).contains(&square) {
                return point / square.sqrt();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use hitscan::{List, Mesh, Scene};

    use super::*;

    #[test]
    fn rays_leave_the_surface_that_was_hit() {
        let vertices = [Vec3::new(-9.0, 0.0, -9.0), Vec3::new(-9.0, 0.0, 9.0), Vec3::new(9.0, 0.0, 0.0)];
        let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]]).unwrap();
        let scene = Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
        let rays = Rays::new(&scene, &outside(&scene.bounds()), 900);
        assert_eq!(rays.primary.len(), 900);
        assert!(rays.bounce.len() > 50 && rays.bounce.len() < 900);
        assert_eq!(rays.bounce.len(), rays.shadow.len());
        for ray in rays.bounce.iter().chain(&rays.shadow) {
            assert!(ray.direction.y > 0.0 && !scene.any_hit(ray), "{ray:?}");
        }
        let upwards = rays.bounce.iter().map(|ray| f64::from(ray.direction.y)).sum::<f64>();
        // The mean cosine of what a matte surface scatters is 2/3.
        assert!((upwards / rays.bounce.len() as f64 - 2.0 / 3.0).abs() < 0.1);
    }

    #[test]
    fn a_scene_without_size_has_rays_that_are_harmless() {
        let vertices = [Vec3::splat(7.0); 3];
        let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]]).unwrap();
        let scene = Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
        let rays = Rays::new(&scene, &outside(&scene.bounds()), 16);
        assert!(rays.primary.len() == 16 && rays.bounce.is_empty());
    }
}
