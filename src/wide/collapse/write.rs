use super::{
    plan::{NODE, Plan, block_cost},
    sketch::Sketch,
};
use crate::{
    geometry::Triangle,
    wide::{
        block,
        node::{Child, Node, WIDTH},
    },
};

/// What an any-hit ray has to expect of a part that it enters.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Outlook {
    /// How likely it is blocked there.
    chance: f32,
    /// What looking for that costs.
    cost: f32,
}

impl Outlook {
    /// Of a block of triangles of so much surface, in a box that is met as likely as `weight` says.
    fn of_block(surface: f32, weight: f32, triangles: usize) -> Self {
        // Seen from all sides, a triangle's shadow is half its surface and a box's a quarter.
        Self { chance: (surface / weight).min(1.0), cost: block_cost(triangles as u32) }
    }

    /// Of a node whose `children` are looked at in this order, if the ray meets them.
    fn of_node<'p>(children: impl Iterator<Item = &'p Part>, weight: f32) -> Self {
        let (mut passes, mut cost) = (1.0, NODE);
        for &Part { weight: of_child, outlook, .. } in children {
            let met = (of_child / weight).min(1.0);
            cost += passes * met * outlook.cost;
            passes *= 1.0 - met * outlook.chance;
        }
        Self { chance: 1.0 - passes, cost }
    }
}

/// A child of a node.
#[derive(Clone, Copy, Debug)]
struct Part {
    place: usize,
    /// How likely a ray meets it.
    weight: f32,
    outlook: Outlook,
}

impl Part {
    /// How many rays it blocks for what it costs.
    fn promise(&self) -> f32 {
        self.weight * self.outlook.chance / self.outlook.cost
    }
}

/// The places of a part of the tree.
pub(super) struct Places<'t> {
    pub nodes: &'t mut [Node],
    pub outlooks: &'t mut [Outlook],
    pub words: &'t mut [u32],
    /// The numbers of the first node and word.
    pub first_node: usize,
    pub first_word: usize,
}

impl<'t> Places<'t> {
    /// The first of them, as many as a part needs.
    pub(super) fn split_off(&mut self, part: &Sketch) -> Self {
        let (count, words) = (part.nodes.len(), part.words);
        let first = Self {
            nodes: self.nodes.split_off_mut(..count).unwrap_or_default(),
            outlooks: self.outlooks.split_off_mut(..count).unwrap_or_default(),
            words: self.words.split_off_mut(..words).unwrap_or_default(),
            ..*self
        };
        self.first_node += count;
        self.first_word += words;
        first
    }

    /// Writes nodes and blocks; `others` is what is to be expected of the nodes behind.
    pub(super) fn write(
        &mut self,
        plan: &Plan<'_>,
        sketch: &Sketch,
        triangle: &impl Fn(u32) -> Triangle,
        others: &[Outlook],
    ) {
        let mut all = &sketch.triangles[..];
        let mut words = &mut self.words[..];
        // Of each node the surfaces in its blocks.
        let mut surfaces = std::vec![[0.0; WIDTH]; sketch.nodes.len()];
        for ((node, sketched), surfaces) in self.nodes.iter_mut().zip(&sketch.nodes).zip(&mut surfaces) {
            *node = Node::empty(Child::block(0));
            for (place, &child) in sketched.children.iter().enumerate() {
                let named = sketched.named[place];
                let bounds = &plan.binary.nodes[child].bounds;
                if !named.is_block() {
                    node.set(place, bounds, Child::node(named.0 + self.first_node as u32));
                    continue;
                }
                node.set(place, bounds, Child::block((named.first() + self.first_word) as u32));
                let (numbers, rest) = all.split_at(usize::from(sketched.counts[place]));
                let (block, behind) = words.split_at_mut(block::words(plan.corners(child), numbers.len()));
                let triangles: heapless::Vec<Triangle, WIDTH> =
                    numbers.iter().map(|&number| triangle(number)).collect();
                block::write(block, numbers, &triangles);
                surfaces[place] = triangles.iter().map(|triangle| surface(triangle, plan.scale)).sum();
                (all, words) = (rest, behind);
            }
        }
        self.order(plan, sketch, &surfaces, others);
    }

    /// Puts the children of each node into the order in which any-hit rays look at them, from the last to the first: those early
    /// that are likely to block a ray at little cost (Ize and Hansen, *RTSAH traversal order for occlusion rays*, 2011).
    fn order(&mut self, plan: &Plan<'_>, sketch: &Sketch, surfaces: &[[f32; WIDTH]], others: &[Outlook]) {
        for (index, (sketched, surfaces)) in sketch.nodes.iter().zip(surfaces).enumerate().rev() {
            let mut parts: heapless::Vec<Part, WIDTH> = heapless::Vec::new();
            for (place, &child) in sketched.children.iter().enumerate() {
                let named = sketched.named[place];
                let weight = plan.weight(child);
                let outlook = if named.is_block() {
                    Outlook::of_block(surfaces[place], weight, usize::from(sketched.counts[place]))
                } else {
                    let (own, number) = (&self.outlooks, named.0 as usize);
                    own.get(number).or_else(|| others.get(number - own.len())).copied().unwrap_or_default()
                };
                let _ = parts.push(Part { place, weight, outlook });
            }
            parts.sort_by(|a, b| a.promise().total_cmp(&b.promise()));
            self.nodes[index].permute(parts.iter().map(|part| part.place));
            self.nodes[index].order();
            self.outlooks[index] = Outlook::of_node(parts.iter().rev(), plan.weight(sketched.root));
        }
    }
}

/// The surface of a triangle, of lengths multiplied by `scale`.
fn surface(triangle: &Triangle, scale: f32) -> f32 {
    let [e, f] = [triangle.b, triangle.c].map(|corner| (corner - triangle.a) * scale);
    e.cross(f).length() * 0.5
}
