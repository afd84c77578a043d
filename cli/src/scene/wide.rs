use hitscan::{
    Hit, List, Mesh, Primitives, Ray, Scene,
    geometry::Aabb,
    primitives::Surface,
    render::Caster,
    wide::{Options, WideBvh},
};

use super::{Preset, Queries, broken, built::refuse};
use crate::{failure::Failure, progress::Progress, units};

/// The fastest structure of hosts over a mesh: it lies in memory alone, and no asset holds it.
#[derive(Debug)]
pub struct Wide<'a> {
    bvh: WideBvh<Mesh<'a>>,
    preset: Preset,
    /// What building it took.
    pub seconds: f64,
}

impl<'a> Wide<'a> {
    /// Builds it on the threads of the current pool.
    pub fn new(mesh: Mesh<'a>, preset: Preset) -> Result<Self, Failure> {
        let options = match preset {
            Preset::Small => Options { byte_price: 1.0, ..Options::balanced() },
            Preset::Balanced => Options::balanced(),
            Preset::Fast => Options::best(),
        };
        let progress = Progress::spinner("building the wide BVH …");
        let bvh = WideBvh::new(mesh, &options).map_err(refuse)?;
        Ok(Self { bvh, preset, seconds: progress.finish() })
    }

    /// Builds it on one thread, as everything else is built that it is compared with.
    pub fn alone(mesh: Mesh<'a>, preset: Preset) -> Result<Self, Failure> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
        let pool = pool.map_err(|error| Failure::new(format!("no thread: {error}"), "close some programs"))?;
        pool.install(|| Self::new(mesh, preset))
    }

    /// Bytes of the structure itself.
    pub fn bytes(&self) -> usize {
        self.bvh.bytes()
    }

    /// Its name and build time.
    pub fn time(&self) -> String {
        format!("wide {} built in {}", self.preset.name(), units::seconds(self.seconds))
    }

    /// Name, bytes and build time in one line.
    pub fn describe(&self) -> String {
        let Self { preset, seconds, .. } = self;
        let per_triangle = self.bytes() as f64 / f64::from(self.bvh.triangles().len().max(1));
        let (bytes, seconds) = (units::count(self.bytes()), units::seconds(*seconds));
        format!("wide {}, {bytes} bytes ({per_triangle:.1} per primitive), built in {seconds}", preset.name())
    }

    /// It, ready for rays; surfaces are those of `primitives` with the same numbers.
    pub fn scene<P: Primitives>(&self, primitives: P) -> Result<Shown<'_, P>, Failure> {
        let mesh = *self.bvh.triangles();
        let all = Scene::new(List::new(&mesh).map_err(refuse)?, mesh).map_err(broken)?;
        Ok(Shown { bvh: &self.bvh, all, primitives })
    }
}

/// A mesh under the structure, which looks like these primitives.
#[derive(Debug)]
pub struct Shown<'a, P> {
    bvh: &'a WideBvh<Mesh<'a>>,
    /// It knows the first hit alone.
    all: Scene<List, Mesh<'a>>,
    primitives: P,
}

impl<P: Primitives> Caster for Shown<'_, P> {
    fn closest_hit(&self, ray: &Ray, _depth: u32) -> Option<Hit> {
        self.bvh.closest_hit(ray)
    }

    fn any_hit(&self, ray: &Ray, _depth: u32) -> bool {
        self.bvh.any_hit(ray)
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        self.primitives.surface(ray, hit)
    }

    fn bounds(&self) -> Aabb {
        self.bvh.bounds()
    }
}

impl<P: Primitives + Sync> Queries for Shown<'_, P> {
    fn count(&self, ray: &Ray) -> (Option<Hit>, u32) {
        self.all.count(ray)
    }

    fn first_hits(&self, rays: &[Ray]) -> Vec<Option<Hit>> {
        let mut hits = vec![None; rays.len()];
        self.bvh.closest_hits(rays, &mut hits);
        hits
    }

    fn any_hits(&self, rays: &[Ray]) -> Vec<bool> {
        let mut hits = vec![false; rays.len()];
        self.bvh.any_hits(rays, &mut hits);
        hits
    }
}
