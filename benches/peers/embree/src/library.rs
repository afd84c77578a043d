use std::{
    ffi::{OsStr, c_char, c_void},
    fmt, ptr,
};

use crate::{
    error::Error,
    layout::{Arguments, Context, RayHit, RayHit16, Valid},
};

/// A device, a scene, a geometry: only Embree looks inside.
pub type Handle = *mut c_void;

/// Told of every piece of memory that Embree takes or gives back.
pub type Monitor = unsafe extern "C" fn(user: *mut c_void, bytes: isize, after: bool) -> bool;

type Query3<R> = unsafe extern "C" fn(Handle, *mut Context, *mut R);
type Query4<R> = unsafe extern "C" fn(Handle, *mut R, *mut Arguments);
type Packet3 = unsafe extern "C" fn(*const Valid, Handle, *mut Context, *mut RayHit16);
type Packet4 = unsafe extern "C" fn(*const Valid, Handle, *mut RayHit16, *mut Arguments);

/// The queries, which Embree 4 calls another way.
pub enum Queries {
    /// As Embree 3 has them.
    Three { intersect1: Query3<RayHit>, occluded1: Query3<RayHit>, intersect16: Packet3 },
    /// As Embree 4 has them.
    Four { intersect1: Query4<RayHit>, occluded1: Query4<RayHit>, intersect16: Packet4 },
}

macro_rules! functions {
    ($($field:ident = $symbol:literal: fn($($argument:ty),*) $(-> $result:ty)?,)*) => {
        /// What is called to make and to drop things; the same in Embree 3 and 4.
        pub struct Functions {
            $(pub $field: unsafe extern "C" fn($($argument),*) $(-> $result)?,)*
        }

        impl Functions {
            fn of(library: &libloading::Library) -> Result<Self, Error> {
                Ok(Self {
                    // SAFETY: the types are those of `rtcore.h`, and `Library` keeps the code loaded beside the pointers.
                    $($field: unsafe { *library.get($symbol)? },)*
                })
            }
        }
    };
}

functions! {
    new_device = b"rtcNewDevice": fn(*const c_char) -> Handle,
    release_device = b"rtcReleaseDevice": fn(Handle),
    device_property = b"rtcGetDeviceProperty": fn(Handle, i32) -> isize,
    device_error = b"rtcGetDeviceError": fn(Handle) -> i32,
    set_monitor = b"rtcSetDeviceMemoryMonitorFunction": fn(Handle, Option<Monitor>, *mut c_void),
    new_scene = b"rtcNewScene": fn(Handle) -> Handle,
    release_scene = b"rtcReleaseScene": fn(Handle),
    set_scene_flags = b"rtcSetSceneFlags": fn(Handle, i32),
    set_scene_quality = b"rtcSetSceneBuildQuality": fn(Handle, i32),
    commit_scene = b"rtcCommitScene": fn(Handle),
    attach_geometry = b"rtcAttachGeometry": fn(Handle, Handle) -> u32,
    new_geometry = b"rtcNewGeometry": fn(Handle, i32) -> Handle,
    release_geometry = b"rtcReleaseGeometry": fn(Handle),
    set_geometry_quality = b"rtcSetGeometryBuildQuality": fn(Handle, i32),
    set_shared_buffer = b"rtcSetSharedGeometryBuffer": fn(Handle, i32, u32, i32, *const c_void, usize, usize, usize),
    commit_geometry = b"rtcCommitGeometry": fn(Handle),
}

/// An Embree that was found.
pub struct Library {
    pub(crate) functions: Functions,
    pub(crate) queries: Queries,
    version: String,
    /// Last, so that it is unloaded last.
    _code: libloading::Library,
}

impl Library {
    /// The library of this path, or of this name where the system looks for libraries.
    pub fn open(path: impl AsRef<OsStr>) -> Result<Self, Error> {
        // SAFETY: Embree's initialisers ask nothing of who loads it.
        let code = unsafe { libloading::Library::new(path.as_ref())? };
        let functions = Functions::of(&code)?;
        // SAFETY: a null configuration is the default one.
        let device = unsafe { (functions.new_device)(ptr::null()) };
        if device.is_null() {
            // SAFETY: of a null device, the error of the thread is asked for.
            return Err(Error::Embree(unsafe { (functions.device_error)(ptr::null_mut()) }));
        }
        // SAFETY: the device is there; 1, 2 and 3 are RTC_DEVICE_PROPERTY_VERSION_MAJOR, _MINOR and _PATCH.
        let [major, minor, patch] = [1, 2, 3].map(|number| unsafe { (functions.device_property)(device, number) });
        // SAFETY: nothing was made with it.
        unsafe { (functions.release_device)(device) };
        // SAFETY: the types are those of `rtcore_scene.h` of either version.
        let queries = unsafe {
            match major {
                3 => Queries::Three {
                    intersect1: *code.get(b"rtcIntersect1")?,
                    occluded1: *code.get(b"rtcOccluded1")?,
                    intersect16: *code.get(b"rtcIntersect16")?,
                },
                4 => Queries::Four {
                    intersect1: *code.get(b"rtcIntersect1")?,
                    occluded1: *code.get(b"rtcOccluded1")?,
                    intersect16: *code.get(b"rtcIntersect16")?,
                },
                _ => return Err(Error::Version(major)),
            }
        };
        Ok(Self { functions, queries, version: format!("{major}.{minor}.{patch}"), _code: code })
    }

    /// Its version, as 4.4.0.
    pub fn version(&self) -> &str {
        &self.version
    }
}

impl fmt::Debug for Library {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Library").field("version", &self.version).finish_non_exhaustive()
    }
}
