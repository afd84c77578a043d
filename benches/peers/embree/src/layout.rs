//! What is handed over, as `rtcore_ray.h` and `rtcore_common.h` lay it out.

use std::{ffi::c_void, ptr};

use crate::scene::Ray;

/// No geometry: what a hit record holds before there is a hit.
const INVALID: u32 = u32::MAX;

/// A ray and where its hit goes. The hit record is that of Embree 4, a little longer than that of Embree 3.
#[repr(C, align(16))]
pub struct RayHit {
    origin: [f32; 3],
    t_near: f32,
    direction: [f32; 3],
    time: f32,
    /// The end of the ray; afterwards the `t` of the hit, or -inf where only any hit was asked for and is there.
    t_far: f32,
    mask: u32,
    id: u32,
    flags: u32,
    normal: [f32; 3],
    barycentric: [f32; 2],
    primitive: u32,
    geometry: u32,
    instances: [u32; 2],
}

impl RayHit {
    pub fn new(ray: &Ray) -> Self {
        Self {
            origin: ray.origin,
            t_near: ray.t_min,
            direction: ray.direction,
            time: 0.0,
            t_far: ray.t_max,
            mask: u32::MAX,
            id: 0,
            flags: 0,
            normal: [0.0; 3],
            barycentric: [0.0; 2],
            primitive: INVALID,
            geometry: INVALID,
            instances: [INVALID; 2],
        }
    }

    /// The `t` of the hit that was written, infinite if there is none.
    pub fn t(&self) -> f32 {
        if self.geometry == INVALID { f32::INFINITY } else { self.t_far }
    }

    /// Whether any hit was found, where only that was asked for.
    pub fn is_occluded(&self) -> bool {
        self.t_far == f32::NEG_INFINITY
    }
}

/// Sixteen of them, number by number.
#[repr(C, align(64))]
pub struct RayHit16 {
    origin: [[f32; 16]; 3],
    t_near: [f32; 16],
    direction: [[f32; 16]; 3],
    time: [f32; 16],
    t_far: [f32; 16],
    mask: [u32; 16],
    id: [u32; 16],
    flags: [u32; 16],
    normal: [[f32; 16]; 3],
    barycentric: [[f32; 16]; 2],
    primitive: [u32; 16],
    geometry: [u32; 16],
    instances: [[u32; 16]; 2],
}

impl RayHit16 {
    pub fn new() -> Self {
        Self {
            origin: [[0.0; 16]; 3],
            t_near: [0.0; 16],
            direction: [[0.0; 16]; 3],
            time: [0.0; 16],
            t_far: [0.0; 16],
            mask: [u32::MAX; 16],
            id: [0; 16],
            flags: [0; 16],
            normal: [[0.0; 16]; 3],
            barycentric: [[0.0; 16]; 2],
            primitive: [INVALID; 16],
            geometry: [INVALID; 16],
            instances: [[INVALID; 16]; 2],
        }
    }

    /// Takes up to 16 rays in, forgets what was hit, and returns how many there were.
    pub fn load(&mut self, rays: &mut impl Iterator<Item = Ray>) -> usize {
        self.geometry = [INVALID; 16];
        let mut count = 0;
        for (lane, ray) in rays.take(16).enumerate() {
            for axis in 0..3 {
                self.origin[axis][lane] = ray.origin[axis];
                self.direction[axis][lane] = ray.direction[axis];
            }
            self.t_near[lane] = ray.t_min;
            self.t_far[lane] = ray.t_max;
            count = lane + 1;
        }
        count
    }

    /// The `t` of this ray's hit, infinite if there is none.
    pub fn t(&self, lane: usize) -> f32 {
        if self.geometry[lane] == INVALID { f32::INFINITY } else { self.t_far[lane] }
    }
}

/// Which of 16 rays take part: -1 if they do.
#[repr(C, align(64))]
pub struct Valid([i32; 16]);

impl Valid {
    /// The first `count` of them.
    pub fn first(count: usize) -> Self {
        Self(std::array::from_fn(|lane| if lane < count { -1 } else { 0 }))
    }
}

/// How Embree 3 is asked.
#[repr(C)]
pub struct Context {
    flags: u32,
    filter: *mut c_void,
    instance: u32,
}

impl Context {
    pub fn new(coherent: bool) -> Self {
        Self { flags: u32::from(coherent), filter: ptr::null_mut(), instance: INVALID }
    }
}

/// How Embree 4 is asked.
#[repr(C)]
pub struct Arguments {
    flags: u32,
    features: u32,
    context: *mut c_void,
    filter: *mut c_void,
    intersect: *mut c_void,
}

impl Arguments {
    pub fn new(coherent: bool) -> Self {
        Self {
            flags: u32::from(coherent) << 16,
            features: u32::MAX,
            context: ptr::null_mut(),
            filter: ptr::null_mut(),
            intersect: ptr::null_mut(),
        }
    }
}
