use std::{ffi::OsString, rc::Rc, sync::Arc};

use hitscan::Ray;
use hitscan_peers_embree::{self as ffi, Library, Options, Quality, Scene};

use super::{Contender, Engine, Role, Wanted, shadow};
use crate::{clock::time_build, mesh::Mesh, rays::Kind};

/// Where the system's library may be; the first that is there is taken.
const NAMES: [&str; 4] = ["libembree4.so.4", "libembree4.so", "libembree3.so.3", "libembree3.so"];

/// The versions of Embree that were found.
#[derive(Debug)]
pub struct Libraries(Vec<Arc<Library>>);

impl Libraries {
    /// Those of these paths; with none, the system's if there is one.
    pub fn open(paths: &[OsString]) -> Result<Self, ffi::Error> {
        let found: Vec<Library> = if paths.is_empty() {
            NAMES.iter().find_map(|name| Library::open(name).ok()).into_iter().collect()
        } else {
            paths.iter().map(Library::open).collect::<Result<_, _>>()?
        };
        Ok(Self(found.into_iter().map(Arc::new).collect()))
    }

    /// Whether there is none.
    pub const fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

/// One ray at a time.
struct Single(Rc<Scene>);

/// Sixteen at a time, as far as that is for camera rays.
struct Packets(Rc<Scene>);

/// Builds those of Embree that are wanted; others are measured by the first version.
pub fn embree(mesh: &Mesh, libraries: &Libraries, wanted: &Wanted) -> Vec<Contender<'static>> {
    const PRESETS: [(&str, Role, Options); 2] = [
        ("high", Role::High, Options { quality: Quality::High, robust: false }),
        ("robust", Role::Robust, Options { quality: Quality::High, robust: true }),
    ];
    let mut contenders = Vec::new();
    for (place, library) in libraries.0.iter().enumerate() {
        let role = |role| (place == 0).then_some(role);
        for (preset, own_role, options) in PRESETS {
            let name = format!("Embree {} {preset}", library.version());
            let packets = format!("{name}, packets");
            if !wanted.has(&name) && !wanted.has(&packets) {
                continue;
            }
            let vertices = mesh.vertices().map(|vertex| vertex.to_array()).collect();
            let (scene, build) = time_build({
                let input: (Vec<_>, Vec<_>) = (vertices, mesh.corners().collect());
                move || Scene::build(library, input.0.clone(), input.1.clone(), options)
            });
            let scene = match scene {
                Ok(scene) => Rc::new(scene),
                Err(error) => {
                    eprintln!("{name}: {error}");
                    continue;
                }
            };
            if options.robust {
                contenders.push(Contender { name, role: role(own_role), build, engine: Box::new(Single(scene)) });
            } else {
                let engine = Box::new(Single(Rc::clone(&scene)));
                contenders.push(Contender { name, role: role(own_role), build, engine });
                let engine = Box::new(Packets(scene));
                contenders.push(Contender { name: packets, role: role(Role::Packets), build, engine });
            }
        }
    }
    contenders
}

fn ray(ray: &Ray) -> ffi::Ray {
    ffi::Ray { origin: ray.origin.to_array(), direction: ray.direction.to_array(), t_min: ray.t_min, t_max: ray.t_max }
}

impl Engine for Single {
    fn bytes(&self) -> usize {
        self.0.bytes()
    }

    fn closest(&self, rays: &[Ray], t: &mut Vec<f32>) {
        t.extend(rays.iter().map(|origin| self.0.closest(&ray(origin))));
    }

    fn any(&self, rays: &[Ray], t: &mut Vec<f32>) {
        t.extend(rays.iter().map(|origin| shadow(self.0.any(&ray(origin)))));
    }
}

impl Engine for Packets {
    fn bytes(&self) -> usize {
        self.0.bytes()
    }

    fn closest(&self, rays: &[Ray], t: &mut Vec<f32>) {
        self.0.closest_packets(rays.iter().map(ray), |hit| t.push(hit));
    }

    fn any(&self, rays: &[Ray], t: &mut Vec<f32>) {
        Single(Rc::clone(&self.0)).any(rays, t);
    }

    fn casts(&self, kind: Kind) -> bool {
        kind == Kind::Primary
    }
}
