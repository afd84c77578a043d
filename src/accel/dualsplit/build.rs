//! The builder: one skeleton, depth first, without recursion.

use super::{
    HEADER_WORDS, MAX_DEPTH,
    block::Block,
    node::Head,
    open::{Form, Header},
    options::Options,
    split::{Metric, Survey, carve, choose},
    stage::{NONE, SPARE, Stage, Task},
};
use crate::{
    error::BuildError,
    geometry::{Aabb, Axis, Lattice},
    primitives::{Primitives, bounds_of},
};

/// Writes a tree over `primitives` to the front of `words`; how many it took.
// Out of line, so that the stack holds one builder, not two.
#[inline(never)]
pub(super) fn build<P: Primitives + ?Sized>(
    primitives: &P,
    words: &mut [u32],
    options: &Options,
) -> Result<usize, BuildError> {
    let count = primitives.len();
    if count > Head::MAX_PRIMITIVES {
        return Err(BuildError::TooMany { limit: Head::MAX_PRIMITIVES });
    }
    let stage = Stage::new(words, count)?;
    let bounds = bounds_of(primitives).map_err(|primitive| BuildError::Bounds { primitive })?;
    let metric = Metric::new(&bounds, count, options.intersection_cost);
    let mut builder = Builder { options, metric, stage, done: 0, leaves: 0, carves: 0, depth: 0 };
    if count > 0 {
        builder.enter(primitives, &bounds);
        builder.run(count);
    }
    Ok(builder.finish(count, bounds))
}

struct Builder<'w, 'o> {
    options: &'o Options,
    metric: Metric,
    stage: Stage<'w>,
    /// Primitives in leaves.
    done: u32,
    leaves: u32,
    carves: u32,
    depth: u32,
}

impl Builder<'_, '_> {
    /// Puts blocks and numbers where they are to be sorted.
    fn enter<P: Primitives + ?Sized>(&mut self, primitives: &P, bounds: &Aabb) {
        let lattice = Lattice::over(bounds, [Block::LAST; 3]);
        let (count, numbers) = (primitives.len(), self.stage.numbers());
        for (number, place) in (0..count).zip(self.stage.blocks(0, count)) {
            *place = Block::around(&primitives.bounds(number), &lattice);
        }
        for number in 0..count {
            self.stage.set(numbers + number as usize, number);
        }
    }

    fn run(&mut self, count: u32) {
        let mut task = Task { implied: Block::WHOLE, first: 0, count, depth: 0, parent: NONE };
        loop {
            self.link(&task);
            task = match self.divide(task) {
                Some(left) => left,
                None => {
                    self.leaf(&task);
                    match self.stage.resume() {
                        Some(right) => right,
                        None => return,
                    }
                }
            };
        }
    }

    /// Tells the parent of a right child where it begins.
    fn link(&mut self, task: &Task) {
        if task.parent != NONE {
            let (place, right) = (task.parent as usize, self.stage.used - HEADER_WORDS);
            let head = Head::from_word(self.stage.word(place)).linked_to(right as u32);
            self.stage.set(place, head.to_word());
        }
    }

    /// Writes what stands above the children, and puts the right one aside; the left one, or none if it is to be a leaf.
    fn divide(&mut self, mut task: Task) -> Option<Task> {
        let most = self.options.most();
        let survey = Survey::of(self.stage.blocks(task.first, task.count));

        // Cut off empty space, unless nodes could then reach the blocks of primitives that are not in leaves.
        if 2 * self.carves < 2 * SPARE + 3 * (self.done - self.leaves)
            && let Some((faces, carved)) =
                carve(&survey.tight, &task.implied, &self.metric, task.count, self.options.carve_threshold)
        {
            let [first, second] = faces.map(|face| carved.plane(face));
            self.node(Head::carve(faces), first, second);
            self.carves += 1;
            task.implied = carved;
        }

        // Divide so that what levels remain suffice.
        let depth = task.depth + 1;
        let levels = (MAX_DEPTH as u32).checked_sub(depth)?;
        if task.count <= 1 {
            return None;
        }
        let bound = u64::from(most) << levels;
        let bound = u32::try_from(bound).unwrap_or(u32::MAX);
        let blocks = self.stage.blocks(task.first, task.count);
        let cut = choose(blocks, &survey, &task.implied, &self.metric, bound);
        let cost = |work: f32| self.options.intersection_cost * work;
        let pays = cut.is_some_and(|cut| 1.0 + cost(cut.work) < cost(task.count as f32));
        if task.count <= most && !pays {
            return None;
        }
        let (axis, left_count, left_max, right_min) = match cut {
            Some(cut) => {
                self.stage.partition(&task, &cut);
                (cut.axis, cut.left, cut.left_max, cut.right_min)
            }
            // All are in one place, or levels run out: in the middle.
            None => {
                let half = task.count / 2;
                let left = Survey::of(self.stage.blocks(task.first, half)).tight;
                let right = Survey::of(self.stage.blocks(task.first + half, task.count - half)).tight;
                (Axis::X, half, left.max(Axis::X), right.min(Axis::X))
            }
        };
        let parent = self.stage.used as u32;
        self.node(Head::split(axis, 0), left_max, right_min);
        let (min, max) = (task.implied.min(axis), task.implied.max(axis));
        let left =
            Task { implied: task.implied.between(axis, min, left_max), count: left_count, depth, parent: NONE, ..task };
        self.stage.postpone(Task {
            implied: task.implied.between(axis, right_min, max),
            first: task.first + left_count,
            count: task.count - left_count,
            parent,
            ..left
        });
        self.depth = self.depth.max(depth);
        Some(left)
    }

    /// Writes a node of two planes.
    fn node(&mut self, head: Head, low: u32, high: u32) {
        self.stage.append(head.to_word());
        self.stage.append(low | high << 16);
    }

    /// Writes a leaf.
    fn leaf(&mut self, task: &Task) {
        self.stage.append(Head::leaf(task.first, task.count).to_word());
        self.done += task.count;
        self.leaves += 1;
    }

    /// Puts the header before the nodes and the numbers behind them; the length of all.
    fn finish(mut self, primitives: u32, bounds: Aabb) -> usize {
        let (numbers, end) = (self.stage.numbers(), self.stage.used);
        let narrow = super::is_narrow(primitives);
        for index in 0..primitives as usize {
            let number = self.stage.word(numbers + index);
            if !narrow {
                self.stage.set(end + index, number);
            } else if index % 2 == 0 {
                self.stage.set(end + index / 2, number);
            } else {
                let other = self.stage.word(end + index / 2);
                self.stage.set(end + index / 2, other | number << 16);
            }
        }
        let nodes = (end - HEADER_WORDS) as u32;
        let header = Header { nodes, primitives, depth: self.depth, form: Form::Numbered, bounds };
        for (index, word) in header.to_words().into_iter().enumerate() {
            self.stage.set(index, word);
        }
        end + super::number_words(primitives)
    }
}
