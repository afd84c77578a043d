use std::cell::Cell;

use hitscan::{
    Arena, Hit, KdTree, Mesh, Ray, Scene,
    accel::{Accelerator, Counted, Entries, Structure},
    geometry::{Aabb, Bundle},
    glam::{Quat, Vec3},
    primitives::{Smooth, Spheres, Surface},
    render::{Camera, Caster, Materials, Numbers, Renderer},
};

use crate::{Model, View, lighting::Lighting, plan};

/// A model under a structure, lit.
#[expect(missing_debug_implementations, reason = "a scene is too much to print")]
pub struct World {
    scene: Tally,
    nodes: &'static Cell<u64>,
    primitives: u32,
    structure_bytes: usize,
    materials: Materials<'static>,
    lighting: Lighting,
    focus: Aabb,
    axes: [Vec3; 3],
}

impl World {
    /// Builds the structure. What is made lives as long as the program: an instance of the module, or a test.
    ///
    /// # Errors
    ///
    /// A sentence that says what is wrong with the model.
    pub fn new(model: Model, structure: u32, preset: u32) -> Result<Self, String> {
        let model: &'static Model = Box::leak(Box::new(model));
        let plan = plan(structure, preset).ok_or("There is no such structure.")?;
        let mesh = Mesh::new(&model.vertices, model.triangles.as_slice()).map_err(|error| error.to_string())?;
        // Without its numbers: to write floats takes 25 kB of module.
        let spheres = Spheres::new(&model.spheres).map_err(|_| "A ball has no radius or is too far out.")?;
        let shape = (Smooth::new(mesh, &model.normals), spheres);

        let count = model.triangles.len() + model.spheres.len();
        let words = vec![0; plan.words(count)].leak();
        let structure = Structure::build(&shape, &mut Arena::new(words), &plan).map_err(|error| error.to_string())?;
        let nodes: &'static Cell<u64> = Box::leak(Box::default());
        // Always counted: linking every walk twice would not fit into the module.
        let scene = Scene::new(Counted::new(structure, nodes), shape).map_err(|error| error.to_string())?;
        let tree = match structure {
            Structure::KdTree(tree) => Scene::new(Counted::new(tree, nodes), shape).ok(),
            _ => None,
        };

        let focus = model.focus.unwrap_or(scene.bounds());
        Ok(Self {
            scene: Tally { scene, tree, rays: Cell::new(0) },
            nodes,
            primitives: structure.primitives(),
            structure_bytes: structure.as_words().len() * 4,
            materials: Materials::new(&model.palette, Numbers::Wide(&model.numbers)),
            lighting: Lighting::studio(&focus, model.axes()),
            focus,
            axes: model.axes(),
        })
    }

    /// The picture of a view, its counts begun anew.
    pub(crate) fn renderer(&self, view: &View, samples: u32) -> Renderer<'_, Tally> {
        let [below, above] = self.lighting.background;
        Renderer::new(&self.scene, self.camera(view), view.width, view.height)
            .with_lights(&self.lighting.lights)
            .with_ambient(self.lighting.ambient)
            .with_background(below, above)
            .with_materials(self.materials)
            .with_terms(view.terms())
            .with_bounces(view.bounces)
            .with_samples(samples)
    }

    /// Somebody who walks around the focus and looks at it.
    fn camera(&self, view: &View) -> Camera {
        const FOV: f32 = 0.6;
        const TAN: f32 = 0.309;
        let [up, right, front] = self.axes;
        let from = Quat::from_rotation_y(view.yaw) * Quat::from_rotation_x(-view.pitch) * Vec3::Z;
        let towards = right * from.x + up * from.y + front * from.z;
        // The sphere around the focus fits into the shorter side of the picture.
        let shorter = TAN * (view.width as f32 / view.height.max(1) as f32).min(1.0);
        let radius = (self.focus.size().length() * 0.5).max(f32::MIN_POSITIVE);
        let distance = radius / shorter / view.zoom;
        let center = self.focus.center();
        Camera::pinhole(center + towards * distance, center, up, FOV)
    }

    /// Begins to count anew.
    pub(crate) fn reset(&self) {
        self.scene.rays.set(0);
        self.nodes.set(0);
    }

    /// Rays cast.
    #[must_use]
    pub fn rays(&self) -> u64 {
        self.scene.rays.get()
    }

    /// Nodes visited.
    #[must_use]
    pub fn nodes(&self) -> u64 {
        self.nodes.get()
    }

    /// Triangles and spheres.
    #[must_use]
    pub fn primitives(&self) -> u32 {
        self.primitives
    }

    /// Bytes of the structure.
    #[must_use]
    pub fn structure_bytes(&self) -> usize {
        self.structure_bytes
    }
}

/// The one kind of scene: by its name, because behind `dyn` the queries that nobody asks are linked, too.
type Shapes<A> = Scene<Counted<'static, A>, (Smooth<'static>, Spheres<'static>)>;

/// A scene that counts the rays cast at it.
pub(crate) struct Tally {
    scene: Shapes<Structure<'static>>,
    /// The same if its structure is a kD-tree, the only one in which tiles look for where their rays begin: for all of them it
    /// would not fit into the module.
    tree: Option<Shapes<KdTree<'static>>>,
    rays: Cell<u64>,
}

impl Tally {
    fn count(&self) {
        self.rays.set(self.rays.get() + 1);
    }
}

impl Caster for Tally {
    fn closest_hit(&self, ray: &Ray, _depth: u32) -> Option<Hit> {
        self.count();
        self.scene.closest_hit(ray)
    }

    fn enter(&self, bundle: &Bundle) -> Entries {
        match &self.tree {
            Some(tree) => tree.enter(bundle),
            None => Entries::whole(self.scene.bounds(), bundle),
        }
    }

    fn closest_hit_from(&self, entries: &Entries, ray: &Ray) -> Option<Hit> {
        self.count();
        match &self.tree {
            Some(tree) => tree.closest_hit_from(entries, ray),
            None if entries.is_empty() => None,
            None => self.scene.closest_hit(ray),
        }
    }

    fn any_hit(&self, ray: &Ray, depth: u32) -> bool {
        self.any_hit_near(ray, depth, &mut None)
    }

    fn any_hit_near(&self, ray: &Ray, _depth: u32, last: &mut Option<u32>) -> bool {
        self.count();
        self.scene.any_hit_near(ray, last)
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        self.scene.surface(ray, hit)
    }

    fn bounds(&self) -> Aabb {
        self.scene.bounds()
    }
}
