use super::{
    LatticePath, LatticeSpace,
    projection::Projection,
    ray::{LAST, LatticeRay, MIDDLE, Passing, View, parameter},
    sight::{Line, Sight},
    space::Planes,
};
use crate::geometry::{Axis, Pencil, Ray};

/// The rays of a [`Pencil`] in whole numbers: what a structure and triangles are to all of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LatticePencil {
    /// The eye.
    start: Planes,
    major: Axis,
    descends: bool,
    descending: u32,
    inside: (u16, u16),
    /// The depth of the eye, in 2^-8.
    from: i32,
    /// Per axis, the earliest entries of any ray, and the latest exits.
    views: [[Passing; 2]; 3],
    /// Where triangles are in the tile.
    pub(crate) projection: Projection,
}

/// What planes may be off by beyond what a ray's view allows for, in steps: the rays are within one and a bit of their lines, and
/// so are those at the corners, of which flat ones may go the other way.
const APART: i32 = 8;

/// How far from the middle lines may cross the middle plane: as anywhere in half a lattice around it, in 2^-14.
const FARTHEST: u32 = (3 * MIDDLE as u32) << LatticeRay::FRACTION;

impl LatticeSpace {
    /// The rays of a pencil; `None` if they are to be looked at one by one.
    ///
    /// What bounds the rays through the outer corners of the tile bounds those in between, because along a line through the
    /// picture slopes only rise or only fall.
    #[inline(never)]
    pub(crate) fn pencil(&self, pencil: &Pencil) -> Option<LatticePencil> {
        let start = self.from(pencil.eye())?;
        let projection = self.projection(pencil, &start)?;
        let [first, others @ ..] = pencil.corners();
        let Line { major, descends, crossings } = self.line(&start, first)?;
        let mut fans = crossings.map(|crossing| Fan { least: crossing, most: crossing });
        for corner in others {
            let line = self.line(&start, corner)?;
            if line.major != major || line.descends != descends {
                return None;
            }
            for (fan, crossing) in fans.iter_mut().zip(line.crossings) {
                fan.add(crossing);
            }
        }
        let from = Line { major, descends, crossings }.depth_of(&start);
        let mut inside = ((from >> 8).max(0), LAST);
        let along = View::along(descends);
        let mut views = [[along.entries(0), along.exits(0)]; 3];
        let mut descending = u32::from(descends) << major as u32;
        for (axis, fan) in [major.next(), major.next().next()].into_iter().zip(fans) {
            let (both, falls) = fan.views(descends)?;
            let [entry, exit] = both;
            let (first, last) = if falls { (LAST, 0) } else { (0, LAST) };
            inside.0 = inside.0.max(entry.depth(first as u32));
            inside.1 = inside.1.min(exit.depth(last as u32));
            descending |= u32::from(falls) << axis as u32;
            if let Some(place) = views.get_mut(axis as usize) {
                *place = both;
            }
        }
        // Where nothing is met, the end is before the beginning.
        let inside = if inside.0 > inside.1 { (1, 0) } else { (inside.0 as u16, inside.1 as u16) };
        let descending = descending * 0x1111_1111;
        Some(LatticePencil { start, major, descends, descending, inside, from, views, projection })
    }

    /// How a ray of a pencil, by its number, sees triangles; `None` if it sees none.
    #[inline(never)]
    pub(crate) fn sight(&self, rays: &LatticePencil, pencil: &Pencil, number: u32) -> Option<Sight> {
        Sight::new(&self.line(&rays.start, pencil.numbered(number).direction)?)
    }

    /// The parameter of a ray of a pencil at a depth in 2^-8.
    #[inline]
    pub(crate) fn parameter(&self, pencil: &LatticePencil, ray: &Ray, depth: i32) -> f32 {
        let plane = if pencil.descends { (LAST << 8) - depth } else { depth };
        let along = (pencil.major.of(ray.origin), pencil.major.of(ray.direction));
        let t = parameter(plane, self.planes_of(pencil.major), along);
        if t < ray.t_min { ray.t_min } else { t }
    }
}

impl LatticePencil {
    /// Whether a ray's depths are those of all.
    #[inline(always)]
    pub(crate) fn is_along(&self, sight: &Sight) -> bool {
        let [.., major] = sight.axes;
        major == self.major && sight.descends == self.descends
    }

    /// The depths between which hits count, in 2^-8.
    #[inline(always)]
    pub(crate) const fn depths(&self) -> (i32, i32) {
        (self.from, LAST << 8)
    }

    /// The depth of a triangle's nearest corner, in 2^-8: no ray hits it before.
    #[inline(always)]
    pub(crate) fn nearest(&self, corners: [&[u16; 3]; 3]) -> i32 {
        let [a, b, c] = corners.map(|corner| i32::from(corner.get(self.major as usize).copied().unwrap_or(0)));
        (if self.descends { LAST - a.max(b).max(c) } else { a.min(b).min(c) }) << 8
    }
}

impl LatticePath for LatticePencil {
    #[inline(always)]
    fn inside(&self) -> (u16, u16) {
        self.inside
    }

    #[inline(always)]
    fn descending(&self) -> u32 {
        self.descending
    }

    #[inline(always)]
    fn entry(&self, axis: u32, plane: u32) -> Option<i32> {
        let [entry, _] = self.views.get(axis as usize)?;
        Some(entry.depth(plane))
    }

    #[inline(always)]
    fn exit(&self, axis: u32, plane: u32) -> Option<i32> {
        let [_, exit] = self.views.get(axis as usize)?;
        Some(exit.depth(plane))
    }
}

/// Lines from one point, as a minor axis sees them: where they cross the middle plane and their slopes, in 2^-14.
#[derive(Clone, Copy)]
struct Fan {
    /// That of the least slope.
    least: (i32, i32),
    /// That of the greatest.
    most: (i32, i32),
}

impl Fan {
    fn add(&mut self, crossing: (i32, i32)) {
        if crossing.1 < self.least.1 {
            self.least = crossing;
        }
        if crossing.1 > self.most.1 {
            self.most = crossing;
        }
    }

    /// The earliest entries and the latest exits, and whether higher numbers are met first; none if the lines are far off.
    #[inline(never)]
    fn views(&self, descends: bool) -> Option<([Passing; 2], bool)> {
        let is_near = |(middle, _): (i32, i32)| middle.unsigned_abs() < FARTHEST;
        if !(is_near(self.least) && is_near(self.most)) {
            return None;
        }
        // Along the ray.
        let (down, up) = if descends { (self.most, self.least) } else { (self.least, self.most) };
        let turned = |slope: i32| if descends { -slope } else { slope };
        let entries = |(middle, _), slope| View::across(middle, turned(slope), descends).entries(APART);
        let exits = |(middle, _), slope| View::across(middle, turned(slope), descends).exits(APART);
        let (falling, rising) = (turned(down.1), turned(up.1));
        Some(if falling >= 0 {
            ([entries(up, rising.max(2)), exits(down, falling.max(2))], false)
        } else if rising <= 0 {
            ([entries(down, falling.min(-2)), exits(up, rising.min(-2))], true)
        } else {
            // What some rise to the others leave for good; below where the lowest ends there is nothing.
            let lowest = (down.0 + falling * MIDDLE) >> LatticeRay::FRACTION;
            ([entries(up, rising.max(2)), Passing::above(lowest)], false)
        })
    }
}
