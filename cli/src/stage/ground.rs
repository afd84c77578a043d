use hitscan::{
    Hit, List, PreparedRay, Primitives, Ray, Scene, Span,
    geometry::Aabb,
    glam::Vec3,
    primitives::Surface,
    render::{Caster, Material},
};

use crate::failure::Failure;

/// A disc in a coordinate plane.
#[derive(Clone, Copy, Debug)]
struct Plate {
    axis: usize,
    center: Vec3,
    radius: f32,
}

impl Primitives for Plate {
    fn len(&self) -> u32 {
        1
    }

    fn bounds(&self, _index: u32) -> Aabb {
        let mut reach = Vec3::splat(self.radius);
        reach[self.axis] = 0.0;
        Aabb::new(self.center - reach, self.center + reach)
    }

    fn intersect(&self, index: u32, ray: &PreparedRay, span: &Span) -> Option<Hit> {
        let (origin, direction) = (ray.ray().origin[self.axis], ray.ray().direction[self.axis]);
        let t = (self.center[self.axis] - origin) / direction;
        let mut off = ray.ray().at(t) - self.center;
        off[self.axis] = 0.0;
        if off.length() <= self.radius { span.accept(t, index) } else { None }
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        let mut point = ray.at(hit.t);
        // Exactly in the plane, so that the error is none.
        point[self.axis] = self.center[self.axis];
        let normal = Vec3::AXES[self.axis];
        let front = ray.direction[self.axis] < 0.0;
        Surface {
            point,
            geometric_normal: normal,
            shading_normal: normal,
            front,
            error: 0.0,
            ..Surface::facing(ray, hit.t)
        }
    }
}

/// A scene that stands on a round plate, whatever its structure: a decorator.
#[derive(Debug)]
pub struct Grounded<'a, S: ?Sized> {
    scene: &'a S,
    plate: Scene<List, Plate>,
    number: u32,
}

impl<'a, S: Caster + ?Sized> Grounded<'a, S> {
    /// The scene on a plate below its bounds, `up` being a coordinate axis; the plate's number is `number`, which must
    /// follow those of the scene's primitives.
    pub fn new(scene: &'a S, up: usize, number: u32) -> Result<Self, Failure> {
        /// The plate's radius and its distance from the lowest point, in lengths of the scene's diagonal.
        const REACH: f32 = 6.0;
        const GAP: f32 = 1.0e-4;
        let bounds = scene.bounds();
        let diagonal = bounds.size().length();
        let mut center = bounds.center();
        center[up] = bounds.min[up] - GAP * diagonal;
        let plate = Plate { axis: up, center, radius: (REACH * diagonal).max(f32::MIN_POSITIVE) };
        let refuse = |error: &dyn std::fmt::Display| Failure::new(format!("no ground: {error}"), "give --no-ground");
        let list = List::new(&plate).map_err(|error| refuse(&error))?;
        let plate = Scene::new(list, plate).map_err(|error| refuse(&error))?;
        Ok(Self { scene, plate, number })
    }
}

impl<S: Caster + ?Sized> Caster for Grounded<'_, S> {
    fn closest_hit(&self, ray: &Ray, depth: u32) -> Option<Hit> {
        let below = self.plate.closest_hit(ray).map(|hit| Hit { primitive: self.number, ..hit });
        let nearer = below.map_or(*ray, |hit| ray.up_to(hit.t));
        self.scene.closest_hit(&nearer, depth).or(below)
    }

    fn any_hit(&self, ray: &Ray, depth: u32) -> bool {
        self.plate.any_hit(ray) || self.scene.any_hit(ray, depth)
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        if hit.primitive == self.number {
            Caster::surface(&self.plate, ray, &Hit { primitive: 0, ..*hit })
        } else {
            self.scene.surface(ray, hit)
        }
    }

    fn material(&self, hit: &Hit) -> Option<Material> {
        if hit.primitive == self.number { None } else { self.scene.material(hit) }
    }

    fn bounds(&self) -> Aabb {
        self.scene.bounds().union(&Caster::bounds(&self.plate))
    }
}

#[cfg(test)]
mod tests {
    use hitscan::Mesh;

    use super::*;

    #[test]
    fn what_stands_on_the_plate_hides_it() {
        let vertices = [Vec3::new(-1.0, 1.0, -1.0), Vec3::new(3.0, 1.0, -1.0), Vec3::new(-1.0, 1.0, 3.0)];
        let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]]).unwrap();
        let scene = Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
        let grounded = Grounded::new(&scene, 1, 1).unwrap();
        let down = |x: f32| Ray::new(Vec3::new(x, 5.0, 0.5), Vec3::NEG_Y);
        assert_eq!(grounded.closest_hit(&down(0.0), 0), Some(Hit { t: 4.0, primitive: 0 }));
        let beside = grounded.closest_hit(&down(-5.0), 0).unwrap();
        assert_eq!(beside.primitive, 1);
        let surface = grounded.surface(&down(-5.0), &beside);
        assert!(surface.front && surface.shading_normal == Vec3::Y && surface.point.y < 1.0);
        let away = Ray::new(surface.start_towards(Vec3::Y), Vec3::Y);
        assert!(grounded.closest_hit(&away, 0).is_none() && !grounded.any_hit(&away, 0));
        assert!(grounded.closest_hit(&down(1000.0), 0).is_none());
    }
}
