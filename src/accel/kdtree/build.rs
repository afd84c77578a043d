//! The builder: one skeleton, depth first, without recursion.
//!
//! Dividing a cell writes the right child's items in the place of its own, the left child's on top, and postpones the
//! right child. At the end the stream is sorted into nodes and references.

use super::{
    HEADER_WORDS,
    form::{Form, reference_bytes},
    node::{MAX_LINK, Node, Side},
    open::Header,
    options::{Options, Split},
    pack::pack,
    split::{Item, Place, Plane, Rules, SCRATCH_WORDS, choose},
    stage::{ITEM_WORDS, NONE, Stage, TASKS_WORDS, Task, swap},
};
use crate::{
    arena::Full,
    error::BuildError,
    geometry::{Aabb, Lattice},
    math::{self, greatest},
    primitives::{Primitives, bounds_of},
};

/// See [`KdTree::words`](super::KdTree::words).
pub(super) const fn words(primitives: usize, options: &Options, form: Form) -> usize {
    // In the stream a reference takes a word and a node two, of which the budget may have counted half.
    let bytes = options.room(primitives, form);
    let (stream, packed) = (bytes / 2, bytes / 4);
    // Beside the stream stand first the items and what is sorted of them, then the references on their way behind the nodes.
    let sorted = primitives.saturating_mul(SCRATCH_WORDS);
    let items = most_items(primitives).saturating_mul(ITEM_WORDS).saturating_add(sorted);
    (HEADER_WORDS + TASKS_WORDS + Node::WORDS).saturating_add(stream).saturating_add(if items > packed {
        items
    } else {
        packed
    })
}

/// Items that may be pending at a time: cells become leaves where there would be more.
const fn most_items(primitives: usize) -> usize {
    primitives.saturating_mul(2).saturating_add(32)
}

/// Writes a tree over `primitives` to the front of `words`; how many it took.
pub(super) fn build<P: Primitives + ?Sized>(
    primitives: &P,
    words: &mut [u32],
    options: &Options,
    form: Form,
) -> Result<usize, BuildError> {
    let count = primitives.len();
    if count > MAX_LINK {
        return Err(BuildError::TooMany { limit: MAX_LINK });
    }
    let allowed = options.bytes(count as usize, form);
    let at_least = form.least_bytes(count as usize);
    if allowed < at_least {
        return Err(BuildError::Budget { at_least, allowed });
    }
    let bounds = bounds_of(primitives).map_err(|primitive| BuildError::Bounds { primitive })?;
    let mut attempt = |byte_cost, bytes| {
        let options = Options { byte_cost, ..*options };
        Builder::new(primitives, words, &options, bounds, form)?.run(bytes)
    };
    if !options.is_searched() {
        return attempt(options.byte_cost, allowed);
    }
    // Within more than is allowed, so that no cell becomes a leaf for want of bytes while others do not need theirs: the
    // least cost of a byte at which the whole fits.
    let room = options.room(count as usize, form);
    let built = attempt(options.byte_cost, room)?;
    if built * 4 <= allowed {
        return Ok(built);
    }
    let least = math::greatest(options.byte_cost, 1.0 / 64.0);
    let (mut exceeds, mut fits) = (least, least * 16_384.0);
    for _ in 0..9 {
        let byte_cost = math::sqrt(fits * exceeds);
        *(if attempt(byte_cost, room)? * 4 > allowed { &mut exceeds } else { &mut fits }) = byte_cost;
    }
    match attempt(fits, room)? {
        words if words * 4 <= allowed => Ok(words),
        _ => attempt(fits, allowed),
    }
}

/// The share of rays that choose where to go by the number of primitives instead of the surface of cells.
const CLOSE_UP: f32 = 0.125;

struct Builder<'w, 'p, P: ?Sized> {
    primitives: &'p P,
    options: &'p Options,
    form: Form,
    lattice: Option<Lattice>,
    bounds: Aabb,
    max_depth: u32,
    /// Half-words that the whole may take.
    most: u32,
    /// Half-words per reference.
    reference_size: u32,

    stage: Stage<'w>,
    nodes: u32,
    references: u32,
    depth: u32,
    /// Half-words that finished cells left over.
    spare: u32,
}

impl<'w, 'p, P: Primitives + ?Sized> Builder<'w, 'p, P> {
    fn new(
        primitives: &'p P,
        words: &'w mut [u32],
        options: &'p Options,
        bounds: Aabb,
        form: Form,
    ) -> Result<Self, Full> {
        let max_depth = options.depth(primitives.len());
        let reference_size = reference_bytes(primitives.len() as usize) as u32 / 2;
        Ok(Self {
            primitives,
            options,
            form,
            lattice: form.lattice(&bounds),
            bounds,
            max_depth,
            most: 0,
            reference_size,
            stage: Stage::new(words, primitives.len())?,
            nodes: 0,
            references: 0,
            depth: 0,
            spare: 0,
        })
    }

    /// Builds the whole within so many bytes; how many words it took.
    fn run(mut self, bytes: usize) -> Result<usize, BuildError> {
        let mut task = self.root(bytes)?;
        loop {
            task.budget = task.budget.saturating_add(core::mem::take(&mut self.spare));
            self.link(&task);
            task = match self.divide(&task)? {
                Some(left) => left,
                None => {
                    self.leaf(&task)?;
                    match self.stage.resume() {
                        Some(right) => right,
                        None => break,
                    }
                }
            };
        }
        let tree = Header {
            nodes: self.nodes,
            references: self.references,
            primitives: self.primitives.len(),
            depth: self.depth,
            bounds: self.bounds,
        };
        Ok(pack(&mut self.stage, tree, self.lattice.as_ref())?)
    }

    /// The cell of all primitives.
    fn root(&mut self, bytes: usize) -> Result<Task, Full> {
        let count = self.primitives.len();
        self.stage.top = count as usize;
        self.stage.reserve(0)?;
        let primitives = self.primitives;
        let (_, items) = self.stage.parts();
        let first = items.len().saturating_sub(count as usize);
        for (primitive, item) in items.iter_mut().skip(first).enumerate() {
            let primitive = primitive as u32;
            *item = Item { bounds: primitives.bounds(primitive), primitive };
        }
        let bytes = bytes.saturating_sub(HEADER_WORDS * 4);
        // Whole words only: an odd number of narrow references is padded.
        let budget = u32::try_from(bytes / 4 * 2).unwrap_or(u32::MAX);
        self.most = budget;
        Ok(Task { cell: self.bounds, top: count, count, depth: 0, budget, parent: NONE })
    }

    /// Tells the parent of a right child its number.
    fn link(&mut self, task: &Task) {
        let number = self.nodes;
        let place = self.stage.words.get_mut(task.parent as usize..).and_then(|stream| stream.first_chunk_mut::<2>());
        if let Some(words) = place {
            *words = Node::from_words(*words).linked_to(number).to_words();
        }
    }

    /// What a half-word costs in a cell, in steps of the rays that come to it.
    fn price(&self, cell: &Aabb, count: u32) -> f32 {
        // Sizes relative to the largest, so that nothing overflows; a little, so that nothing is divided by zero.
        let scale = greatest(self.bounds.size().max_element(), f32::MIN_POSITIVE);
        let area = |b: &Aabb| {
            let s = b.size() / scale;
            s.x * s.y + s.y * s.z + s.z * s.x + 1.0e-12
        };
        let primitives = self.primitives.len() as f32;
        // Rays from within, or of a camera close by, come more often to small cells with many primitives.
        let chance = greatest(area(cell) / area(&self.bounds), CLOSE_UP * count as f32 / primitives);
        self.options.byte_cost * 2.0 / (primitives * chance)
    }

    /// Half-words of a leaf of `count` primitives.
    fn leaf_size(&self, count: usize) -> u32 {
        self.form.leaf_size(count as u32, self.reference_size, self.most)
    }

    /// Writes an inner node, distributes the items and leaves a task for the right child if both have items; the task of
    /// the next node, or none if the cell is to be a leaf.
    fn divide(&mut self, task: &Task) -> Result<Option<Task>, BuildError> {
        self.stage.top = task.top as usize;
        if task.count <= self.options.leaf_size || task.depth >= self.max_depth {
            return Ok(None);
        }
        let options = self.options;
        self.stage.reserve(task.count as usize * SCRATCH_WORDS)?;
        let sizes = [self.form.node_size(), self.reference_size];
        let price = self.price(&task.cell, task.count);
        let (scratch, items) = self.stage.scratch(task);
        let rules = Rules { options, lattice: self.lattice.as_ref(), price, sizes };
        let Some(plane) = choose(items, &task.cell, &rules, scratch) else { return Ok(None) };

        // Sort: left, both, right.
        let (mut left, mut both_end, mut right) = (0, 0, items.len());
        while both_end < right {
            let Some(item) = items.get(both_end) else { break };
            match plane.place(&item.bounds) {
                Place::Left => {
                    swap(items, left, both_end);
                    left += 1;
                    both_end += 1;
                }
                Place::Both => both_end += 1,
                Place::Right => {
                    right -= 1;
                    swap(items, both_end, right);
                }
            }
        }
        let both = both_end - left;
        let (most_left, most_right) = (left + both, items.len() - left);
        // Without the heuristic, a plane that all items cross would be followed by more of its kind.
        if both == items.len() && task.count > 1 && options.split != Split::Sah {
            return Ok(None);
        }
        let node_size = self.form.inner_size(task.budget);
        let least = self.leaf_size(most_left).saturating_add(self.leaf_size(most_right)).saturating_add(node_size);
        let crowded = task.top as usize + both > most_items(self.primitives.len() as usize);
        let Some(excess) = task.budget.checked_sub(least).filter(|_| !crowded) else { return Ok(None) };

        // The copies of those on both sides lie on top of the cell's items.
        self.stage.top = task.top as usize + both;
        self.stage.reserve(Node::WORDS)?;
        let (left_count, right_count) = self.distribute(task, &plane, left, both);

        let (left_cell, right_cell) = plane.parts(&task.cell);
        let depth = task.depth + 1;
        let mut left = Task {
            cell: left_cell,
            // The left child's items begin behind those of the right.
            top: (task.top as usize - left + left_count) as u32,
            count: left_count as u32,
            depth,
            budget: task.budget.saturating_sub(node_size),
            parent: NONE,
        };
        let mut right = Task {
            cell: right_cell,
            // The right child's items end where the cell's did.
            top: (task.top as usize - task.count as usize + right_count) as u32,
            count: right_count as u32,
            ..left
        };
        let node = Node::inner(plane.axis, plane.position);
        let (node, next) = match (left_count, right_count) {
            // Clipping has left nothing: an empty leaf takes the cell's place.
            (0, 0) => return Ok(Some(Task { count: 0, ..*task }.without_parent())),
            (0, _) => (node.cutting(Side::Left).linked_to(self.nodes + 1), right),
            (_, 0) => (node.cutting(Side::Right).linked_to(self.nodes + 1), left),
            _ => {
                let weight = (most_left + most_right).max(1) as u64;
                let share = (u64::from(excess) * most_left as u64 / weight) as u32;
                left.budget = self.leaf_size(most_left).saturating_add(share);
                right.budget = self.leaf_size(most_right).saturating_add(excess - share);
                right.parent = self.stage.used as u32;
                self.stage.postpone(right);
                (node, left)
            }
        };
        self.node(node)?;
        self.depth = self.depth.max(depth);
        Ok(Some(next))
    }

    /// Turns the items on both sides, which lie behind the `left` ones, into parts: the left ones on top of all, the right
    /// ones against those of the right. How many there are on each side.
    fn distribute(&mut self, task: &Task, plane: &Plane, left: usize, both: usize) -> (usize, usize) {
        let (left_cell, right_cell) = plane.parts(&task.cell);
        let (primitives, clip) = (self.primitives, self.options.clip);
        let part = |item: &Item, cell: &Aabb| {
            let clipped = if clip && primitives.is_certified(item.primitive) {
                primitives.clip(item.primitive, cell)?.intersection(&item.bounds)
            } else {
                item.bounds.intersection(cell)
            };
            (!clipped.is_empty()).then_some(Item { bounds: clipped, ..*item })
        };
        let (_, items) = self.stage.parts();
        let first = items.len().saturating_sub(task.top as usize);
        let right_only = task.count as usize - left - both;
        let (mut left_count, mut right_count) = (left, right_only);
        for index in (0..both).rev() {
            let Some(item) = items.get(first + left + index).copied() else { continue };
            if let Some(part) = part(&item, &right_cell)
                && let Some(place) = items.get_mut(first + task.count as usize - right_count - 1)
            {
                *place = part;
                right_count += 1;
            }
            if let Some(part) = part(&item, &left_cell)
                && let Some(place) = items.get_mut((first + left).wrapping_sub(left_count + 1))
            {
                *place = part;
                left_count += 1;
            }
        }
        (left_count, right_count)
    }

    /// Adds a node to the stream.
    fn node(&mut self, node: Node) -> Result<(), BuildError> {
        if self.nodes >= MAX_LINK || self.stage.used >= NONE as usize {
            return Err(BuildError::TooMany { limit: MAX_LINK });
        }
        node.to_words().into_iter().for_each(|word| self.stage.append(word));
        self.nodes += 1;
        Ok(())
    }

    /// Writes a leaf of the cell's items and takes them off the stack.
    fn leaf(&mut self, task: &Task) -> Result<(), BuildError> {
        let count = task.count;
        let size = self.leaf_size(count as usize);
        self.spare = task.budget.saturating_sub(size);
        if count <= 1 {
            let primitive = self.stage.items(task).first().map_or(0, |item| item.primitive);
            self.stage.top = (task.top - count) as usize;
            self.stage.reserve(Node::WORDS)?;
            return self.node(Node::leaf(primitive, count));
        }
        let first = self.references;
        self.references = first.checked_add(count).ok_or(BuildError::TooMany { limit: u32::MAX })?;
        // The node stands where an item was at the most; read before they are overwritten.
        self.stage.top = task.top as usize;
        self.stage.reserve(Node::WORDS + count as usize)?;
        self.node(Node::leaf(first, count))?;
        for index in 0..count {
            let rest = Task { top: task.top - index, count: 1, ..*task };
            let primitive = self.stage.items(&rest).first().map_or(0, |item| item.primitive);
            self.stage.append(primitive);
        }
        self.stage.top = (task.top - count) as usize;
        Ok(())
    }
}
