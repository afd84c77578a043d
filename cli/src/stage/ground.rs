use hitscan::{
    Hit, List, PreparedRay, Primitives, Ray, Scene, Span,
    accel::Entries,
    geometry::{Aabb, Bundle, Pencil},
    glam::Vec3,
    primitives::Surface,
    query::ItemBuffer,
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

impl<S: ?Sized> Grounded<'_, S> {
    /// The hit of the ray with the plate.
    fn below(&self, ray: &Ray) -> Option<Hit> {
        self.plate.closest_hit(ray).map(|hit| Hit { primitive: self.number, ..hit })
    }

    /// The first hit of the ray with the plate or with the scene, which is asked up to the plate and whose number is less.
    fn first(&self, ray: &Ray, of_scene: impl FnOnce(&Ray) -> Option<Hit>) -> Option<Hit> {
        let below = self.below(ray);
        let nearer = below.map_or(*ray, |hit| ray.up_to(hit.t));
        of_scene(&nearer).or(below)
    }
}

impl<S: Caster + ?Sized> Caster for Grounded<'_, S> {
    fn closest_hit(&self, ray: &Ray, depth: u32) -> Option<Hit> {
        self.first(ray, |ray| self.scene.closest_hit(ray, depth))
    }

    /// Where rays may begin in the scene; the plate needs no beginning.
    fn enter(&self, bundle: &Bundle) -> Entries {
        self.scene.enter(bundle)
    }

    fn closest_hit_from(&self, entries: &Entries, ray: &Ray) -> Option<Hit> {
        self.first(ray, |ray| self.scene.closest_hit_from(entries, ray))
    }

    fn closest_hits(&self, pencil: &Pencil, hits: &mut ItemBuffer) -> bool {
        let is_done = self.scene.closest_hits(pencil, hits);
        if is_done {
            let rays = (0..pencil.rows()).flat_map(|row| (0..pencil.columns()).map(move |column| (column, row)));
            for (column, row) in rays {
                if let Some(below) = self.below(&pencil.ray(column, row)) {
                    hits.offer(column, row, below);
                }
            }
        }
        is_done
    }

    fn any_hit(&self, ray: &Ray, depth: u32) -> bool {
        self.plate.any_hit(ray) || self.scene.any_hit(ray, depth)
    }

    fn any_hit_near(&self, ray: &Ray, depth: u32, last: &mut Option<u32>) -> bool {
        self.plate.any_hit(ray) || self.scene.any_hit_near(ray, depth, last)
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        if hit.primitive == self.number {
            Caster::surface(&self.plate, ray, &Hit { primitive: 0, ..*hit })
        } else {
            self.scene.surface(ray, hit)
        }
    }

    fn material(&self, hit: &Hit, surface: &Surface) -> Option<Material> {
        if hit.primitive == self.number { None } else { self.scene.material(hit, surface) }
    }

    fn bounds(&self) -> Aabb {
        self.scene.bounds().union(&Caster::bounds(&self.plate))
    }
}

#[cfg(test)]
mod tests {
    use hitscan::{
        KdTree, Mesh,
        accel::Plan,
        bake,
        render::{Camera, Renderer, Tile},
    };

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

    /// A picture by tiles, at once or begun together, through both decorators, is the picture pixel by pixel, and tiles that
    /// see nothing of the scene are told.
    #[test]
    fn tiles_enter_what_stands_on_the_plate() {
        let vertices = [Vec3::new(-1.0, 1.0, -1.0), Vec3::new(3.0, 1.0, -1.0), Vec3::new(-1.0, 4.0, 3.0)];
        let mesh = Mesh::new(&vertices, &[[0_u16, 1, 2]]).unwrap();
        let list = Scene::new(List::new(&mesh).unwrap(), &mesh).unwrap();
        let words = bake::build(&mesh, &Plan::KdTree(Default::default())).unwrap();
        let tree = Scene::new(KdTree::open(&words).unwrap(), &mesh).unwrap();
        for (scene, at_once) in [(&list as &(dyn Caster + Sync), false), (&tree, true)] {
            tiles_of(scene, at_once);
        }
    }

    fn tiles_of(scene: &(dyn Caster + Sync), at_once: bool) {
        let counted = super::super::Counted::new(scene, 1);
        let grounded = Grounded::new(&counted, 1, 1).unwrap();
        let camera = Camera::pinhole(Vec3::new(-4.0, 6.0, -9.0), Vec3::ONE, Vec3::Y, 0.9);
        let renderer = Renderer::new(&grounded, camera, 96, 96);
        let mut empty = 0;
        for tile in renderer.tiles(32, 16) {
            empty += u32::from(grounded.enter(&camera.bundle(&tile, 96, 96).unwrap()).is_empty());
            let pencil = camera.pencil(&Tile { width: 8, height: 8, ..tile }, 96, 96).unwrap();
            assert_eq!(grounded.closest_hits(&pencil, &mut ItemBuffer::new()), at_once);
            let mut filled = vec![Vec3::ZERO; tile.area()];
            renderer.fill(tile, &mut filled).unwrap();
            assert!(filled.iter().zip(tile.pixels()).all(|(light, (x, y))| *light == renderer.pixel(x, y)));
        }
        assert!((6..18).contains(&empty), "{empty}");
    }
}
