use std::{
    ffi::c_void,
    fmt,
    sync::{
        Arc,
        atomic::{AtomicIsize, Ordering},
    },
};

use crate::{
    error::Error,
    layout::{Arguments, Context, RayHit, RayHit16, Valid},
    library::{Handle, Library, Queries},
};

/// RTC_GEOMETRY_TYPE_TRIANGLE.
const TRIANGLE: i32 = 0;
/// RTC_BUFFER_TYPE_INDEX and RTC_FORMAT_UINT3.
const INDEX: (i32, i32) = (0, 0x5003);
/// RTC_BUFFER_TYPE_VERTEX and RTC_FORMAT_FLOAT3.
const VERTEX: (i32, i32) = (1, 0x9003);
/// RTC_SCENE_FLAG_ROBUST.
const ROBUST: i32 = 1 << 2;

/// A half-line between two parameters.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// The point at 0.
    pub origin: [f32; 3],
    /// The step for 1.
    pub direction: [f32; 3],
    /// The least parameter.
    pub t_min: f32,
    /// The greatest one.
    pub t_max: f32,
}

/// How much time a build may take: `RTCBuildQuality`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quality {
    /// The default.
    Medium = 1,
    /// With spatial splits.
    High = 2,
}

/// How a scene is built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// How well.
    pub quality: Quality,
    /// Whether rays should not slip through between triangles.
    pub robust: bool,
}

/// Triangles, ready to be queried.
pub struct Scene {
    library: Arc<Library>,
    device: Handle,
    scene: Handle,
    /// What the device has of memory.
    bytes: Box<AtomicIsize>,
    // Embree reads them where they lie, the vertices up to 4 bytes past the last.
    _vertices: Vec<[f32; 3]>,
    _corners: Vec<[u32; 3]>,
}

impl Scene {
    /// Builds it on this thread.
    pub fn build(
        library: &Arc<Library>,
        mut vertices: Vec<[f32; 3]>,
        corners: Vec<[u32; 3]>,
        options: Options,
    ) -> Result<Self, Error> {
        let count = vertices.len();
        vertices.push([0.0; 3]);
        let functions = &library.functions;
        // SAFETY: the string ends with a zero; a null device says which error it was.
        let device = unsafe { (functions.new_device)(c"threads=1".as_ptr()) };
        let bytes = Box::new(AtomicIsize::new(0));
        let quality = options.quality as i32;
        // SAFETY: the device is there. What it is lent outlives it: it is released in `drop`, before the fields are.
        let scene = unsafe {
            if device.is_null() {
                return Err(Error::Embree((functions.device_error)(device)));
            }
            (functions.set_monitor)(device, Some(count_bytes), (&raw const *bytes).cast_mut().cast());
            let geometry = (functions.new_geometry)(device, TRIANGLE);
            let share = |(slot, format): (i32, i32), data: *const c_void, count: usize| {
                (functions.set_shared_buffer)(geometry, slot, 0, format, data, 0, 12, count);
            };
            share(VERTEX, vertices.as_ptr().cast(), count);
            share(INDEX, corners.as_ptr().cast(), corners.len());
            (functions.set_geometry_quality)(geometry, quality);
            (functions.commit_geometry)(geometry);
            let scene = (functions.new_scene)(device);
            (functions.set_scene_flags)(scene, if options.robust { ROBUST } else { 0 });
            (functions.set_scene_quality)(scene, quality);
            (functions.attach_geometry)(scene, geometry);
            (functions.release_geometry)(geometry);
            (functions.commit_scene)(scene);
            scene
        };
        let built = Self { library: Arc::clone(library), device, scene, bytes, _vertices: vertices, _corners: corners };
        // SAFETY: the device is there.
        match unsafe { (functions.device_error)(device) } {
            0 => Ok(built),
            code => Err(Error::Embree(code)),
        }
    }

    /// Bytes that Embree holds besides the mesh.
    pub fn bytes(&self) -> usize {
        self.bytes.load(Ordering::Relaxed).max(0) as usize
    }

    /// The `t` of the first hit, infinite for a miss.
    #[inline]
    pub fn closest(&self, ray: &Ray) -> f32 {
        let mut hit = RayHit::new(ray);
        // SAFETY: the scene is committed, and everything handed over is laid out as this version wants it.
        unsafe {
            match &self.library.queries {
                Queries::Three { intersect1, .. } => intersect1(self.scene, &mut Context::new(false), &mut hit),
                Queries::Four { intersect1, .. } => intersect1(self.scene, &mut hit, &mut Arguments::new(false)),
            }
        }
        hit.t()
    }

    /// Whether there is a hit.
    #[inline]
    pub fn any(&self, ray: &Ray) -> bool {
        let mut hit = RayHit::new(ray);
        // SAFETY: as in `closest`; only the ray, the front of it, is looked at.
        unsafe {
            match &self.library.queries {
                Queries::Three { occluded1, .. } => occluded1(self.scene, &mut Context::new(false), &mut hit),
                Queries::Four { occluded1, .. } => occluded1(self.scene, &mut hit, &mut Arguments::new(false)),
            }
        }
        hit.is_occluded()
    }

    /// As [`closest`](Self::closest) for each ray, 16 at a time and said to be coherent.
    pub fn closest_packets(&self, mut rays: impl ExactSizeIterator<Item = Ray>, mut write: impl FnMut(f32)) {
        let mut packet = RayHit16::new();
        let (mut context, mut arguments) = (Context::new(true), Arguments::new(true));
        while rays.len() > 0 {
            let count = packet.load(&mut rays);
            let valid = Valid::first(count);
            // SAFETY: as in `closest`.
            unsafe {
                match &self.library.queries {
                    Queries::Three { intersect16, .. } => intersect16(&valid, self.scene, &mut context, &mut packet),
                    Queries::Four { intersect16, .. } => intersect16(&valid, self.scene, &mut packet, &mut arguments),
                }
            }
            (0..count).for_each(|lane| write(packet.t(lane)));
        }
    }
}

impl Drop for Scene {
    fn drop(&mut self) {
        // SAFETY: both are there, and this is their one release.
        unsafe {
            (self.library.functions.release_scene)(self.scene);
            (self.library.functions.release_device)(self.device);
        }
    }
}

impl fmt::Debug for Scene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Scene").field("library", &self.library).field("bytes", &self.bytes).finish_non_exhaustive()
    }
}

/// Adds what Embree takes, and subtracts what it gives back.
unsafe extern "C" fn count_bytes(user: *mut c_void, bytes: isize, _after: bool) -> bool {
    // SAFETY: it was set together with this function, and lives in the scene's box.
    let total = unsafe { &*user.cast::<AtomicIsize>() };
    total.fetch_add(bytes, Ordering::Relaxed);
    true
}
