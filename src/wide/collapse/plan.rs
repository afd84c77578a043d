use std::{ops::Range, vec::Vec};

use bytemuck::Zeroable;
use rayon::prelude::*;

use super::repeats::Repeats;
use crate::{
    geometry::Triangle,
    wide::{
        binary::{Binary, BinaryNode},
        block,
        node::{Node, WIDTH},
    },
};

/// The most triangles in a block.
const MOST: u32 = WIDTH as u32;

/// What a ray's visit to a node costs.
const NODE: f32 = 1.0;

/// What its visit to a block costs, however many triangles there are in it.
const BLOCK: f32 = 0.9;

/// What each triangle adds.
const TRIANGLE: f32 = 0.05;

/// Nodes below one that are left to one thread.
const ALONE: usize = 8192;

/// What is known of the part below a binary node.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Part {
    /// The least costs as at most 1, 2, … 7 children of a wide node.
    costs: [f32; WIDTH - 1],
    /// How likely a ray that meets it is blocked in it.
    chance: f32,
    /// The first reference: depth first, so that all stand together.
    first: u32,
    /// How many there are, below bits that say how many corners a block of them has, none if it becomes none.
    references: u32,
}

/// Of the binary tree, which parts become what.
#[derive(Debug)]
pub(super) struct Plan<'b> {
    pub binary: &'b Binary,
    /// That of each reference.
    pub triangles: Vec<Triangle>,
    pub repeats: Repeats,
    parts: Vec<Part>,
    /// What makes the longest edge a length of 1, so that costs neither overflow nor vanish.
    scale: f32,
}

impl Part {
    /// Where the number of corners stands.
    const CORNERS: u32 = 28;

    fn references(&self) -> u32 {
        self.references & ((1 << Self::CORNERS) - 1)
    }

    /// Which references there are.
    fn range(&self) -> Range<usize> {
        self.first as usize..(self.first + self.references()) as usize
    }
}

impl<'b> Plan<'b> {
    /// What costs least, on all threads, where a byte for each triangle costs as much as so many nodes that all rays visit.
    pub(super) fn new(binary: &'b Binary, price: f32, triangle: &(impl Fn(u32) -> Triangle + Sync)) -> Self {
        let scale = binary.nodes.first().map_or(1.0, |root| root.hull().scale());
        // All at once, because they have to be waited for.
        let numbers = binary.references.par_iter().with_min_len(ALONE);
        let triangles: Vec<Triangle> = numbers.map(|&number| triangle(number)).collect();
        let repeats = Repeats::of(&triangles);
        let mut parts: Vec<Part> = bytemuck::zeroed_vec(binary.nodes.len());
        if let Some((root, below)) = parts.split_first_mut() {
            let whole = &binary.nodes[0];
            let price = price.max(0.0) * whole.hull().weight(scale) / binary.references.len() as f32;
            let planner = Planner { binary, triangles: &triangles, repeats: &repeats, scale, price };
            *root = planner.part(whole, below, 1);
        }
        Self { binary, triangles, repeats, parts, scale }
    }

    /// How likely a ray meets a binary node.
    fn weight(&self, node: usize) -> f32 {
        self.binary.nodes[node].hull().weight(self.scale)
    }

    /// Of a binary node that becomes a block the number of its corners, else 0.
    pub(super) fn corners(&self, node: usize) -> usize {
        (self.parts[node].references >> Part::CORNERS) as usize
    }

    /// How many references are below.
    pub(super) fn references(&self, node: usize) -> u32 {
        self.parts[node].references()
    }

    /// How many rays a node blocks, for what that costs: those with more should be looked at first where any hit will do (Ize and
    /// Hansen, *RTSAH traversal order for occlusion rays*, 2011).
    fn promise(&self, node: usize) -> f32 {
        let (weight, part) = (self.weight(node), &self.parts[node]);
        weight * weight * part.chance / part.costs[0]
    }

    /// The binary nodes that become the children of the wide node in the place of `node`, those that promise most last.
    pub(super) fn children(&self, node: usize) -> heapless::Vec<usize, WIDTH> {
        let mut children = heapless::Vec::new();
        let mut open: heapless::Vec<(usize, usize), WIDTH> = heapless::Vec::new();
        let mut next = Some((node, WIDTH));
        while let Some((node, mut places)) = next {
            let costs = &self.parts[node].costs;
            while places > 1 && places < WIDTH && costs[places - 1] == costs[places - 2] {
                places -= 1;
            }
            next = if places == 1 || self.binary.nodes[node].count() > 0 {
                // No more than the places that were given away.
                let _ = children.push(node);
                open.pop()
            } else {
                let left = self.binary.nodes[node].first();
                let of_left = divided([&self.parts[left].costs, &self.parts[left + 1].costs], places).1;
                let _ = open.push((left + 1, places - of_left));
                Some((left, of_left))
            };
        }
        // As powers of two: what differs less stays as it lies in space, which is better for most rays.
        children.sort_by_key(|&child| self.promise(child).to_bits() >> 23);
        children
    }

    /// The references below a node.
    pub(super) fn range(&self, node: usize) -> Range<usize> {
        self.parts[node].range()
    }

    /// Those of a block that become triangles of it, by their places: one that was cut may be back in one piece.
    pub(super) fn numbers(&self, block: Range<usize>) -> impl Iterator<Item = (usize, u32)> {
        let numbers = &self.binary.references[block];
        let places = numbers.iter().copied().enumerate();
        places.filter(|&(place, number)| !numbers[..place].contains(&number))
    }
}

/// The least cost of two parts in this many places, at least two, and how many the first one gets.
fn divided([left, right]: [&[f32; WIDTH - 1]; 2], places: usize) -> (f32, usize) {
    let split = |of_left: usize| (left[of_left - 1] + right[places - of_left - 1], of_left);
    (1..places).map(split).reduce(|a, b| if b.0 < a.0 { b } else { a }).unwrap_or((f32::INFINITY, 1))
}

/// The least cost of two parts in this many places, at least two.
#[inline(always)]
fn least([left, right]: [&[f32; WIDTH - 1]; 2], places: usize) -> f32 {
    let costs = (1..places).map(|of_left| left[of_left - 1] + right[places - of_left - 1]);
    costs.fold(f32::INFINITY, |a, b| if b < a { b } else { a })
}

/// What the threads share.
struct Planner<'p> {
    binary: &'p Binary,
    triangles: &'p [Triangle],
    repeats: &'p Repeats,
    scale: f32,
    /// What a byte costs.
    price: f32,
}

impl Planner<'_> {
    /// What a block costs.
    fn block_cost(&self, weight: f32, corners: usize, triangles: u32) -> f32 {
        weight * (BLOCK + TRIANGLE * triangles as f32)
            + self.price * (4 * block::words(corners, triangles as usize)) as f32
    }

    /// How large one side of a triangle is.
    fn surface(&self, triangle: &Triangle) -> f32 {
        let (e, f) = ((triangle.b - triangle.a) * self.scale, (triangle.c - triangle.a) * self.scale);
        e.cross(f).length() * 0.5
    }

    /// What is to be known of a node; `below` are the nodes below it, of which the first has the number `base`.
    fn part(&self, node: &BinaryNode, below: &mut [Part], base: usize) -> Part {
        let weight = node.hull().weight(self.scale);
        if node.count() > 0 {
            let mut part = Part { first: node.first() as u32, references: node.count() as u32, ..Part::zeroed() };
            let corners = self.repeats.count(part.range());
            part.costs = [self.block_cost(weight, corners, part.references); WIDTH - 1];
            let surface: f32 = self.triangles[part.range()].iter().map(|triangle| self.surface(triangle)).sum();
            // Seen from all sides, a triangle's shadow is half its surface and a box's a quarter.
            part.chance = (surface / weight).min(1.0);
            part.references |= (corners as u32) << Part::CORNERS;
            return part;
        }
        let nodes = &self.binary.nodes[base..][..2];
        let (pair, below) = below.split_at_mut(2);
        // Depth first: what is below the left one comes before what is below the right one.
        let base = base + 2;
        let border = if nodes[1].count() > 0 { below.len() } else { nodes[1].first() - base };
        let together = below.len() > ALONE;
        let (of_left, of_right) = below.split_at_mut(border);
        let mut left = || self.part(&nodes[0], of_left, base);
        let mut right = || self.part(&nodes[1], of_right, base + border);
        let (left, right) = if together { rayon::join(left, right) } else { (left(), right()) };
        pair.copy_from_slice(&[left, right]);
        let references = left.references() + right.references();
        let passes =
            |node: &BinaryNode, part: &Part| 1.0 - (node.hull().weight(self.scale) / weight).min(1.0) * part.chance;
        let chance = 1.0 - passes(&nodes[0], &left) * passes(&nodes[1], &right);
        let mut part = Part { costs: [0.0; WIDTH - 1], chance, first: left.first, references };
        let sides = [&left.costs, &right.costs];
        part.costs[0] = weight * NODE + self.price * size_of::<Node>() as f32 + least(sides, WIDTH);
        let corners = if references > MOST { usize::MAX } else { self.repeats.count(part.range()) };
        if corners <= WIDTH {
            let cost = self.block_cost(weight, corners, references);
            if cost <= part.costs[0] {
                part.costs[0] = cost;
                part.references |= (corners as u32) << Part::CORNERS;
            }
        }
        for places in 2..WIDTH {
            part.costs[places - 1] = part.costs[places - 2].min(least(sides, places));
        }
        part
    }
}
