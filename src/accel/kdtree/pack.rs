//! The end of a build: the stream, sorted into nodes and references behind the header.

use super::{
    HEADER_WORDS, MAX_DEPTH,
    compact::Node as Compact,
    form::{may_be_long, reference_bytes},
    node::{Kind, Node},
    open::Header,
    stage::Stage,
};
use crate::{arena::Full, geometry::Lattice};

/// Packs the nodes of `tree`, on a lattice in 4 bytes each; the length of all.
pub(super) fn pack(stage: &mut Stage<'_>, tree: Header, lattice: Option<&Lattice>) -> Result<usize, Full> {
    let narrow = reference_bytes(tree.primitives as usize) == 2;
    let packed = if narrow { tree.references.div_ceil(2) } else { tree.references } as usize;
    stage.top = 0;
    stage.reserve(packed)?;
    // References to the far end, nodes together: these move forward only.
    let shelf = stage.words.len() - packed;
    if let Some(shelf) = stage.words.get_mut(shelf..) {
        shelf.fill(0);
    }
    let (mut read, mut reference) = (HEADER_WORDS, 0);
    let mut nodes = Nodes { write: HEADER_WORDS, pending: heapless::Vec::new() };
    for number in 0..tree.nodes {
        let node = Node::from_words([stage.word(read), stage.word(read + 1)]);
        read += Node::WORDS;
        match lattice {
            None => node.to_words().into_iter().for_each(|word| nodes.append(stage, word)),
            Some(lattice) => nodes.append_compact(stage, lattice, number, node),
        }
        if let Kind::Leaf { count, .. } = node.kind()
            && count > 1
        {
            for _ in 0..count {
                let primitive = stage.word(read);
                read += 1;
                if narrow {
                    let place = shelf + reference / 2;
                    stage.set(place, stage.word(place) | primitive << (16 * (reference % 2)));
                } else {
                    stage.set(shelf + reference, primitive);
                }
                reference += 1;
            }
        }
    }
    let end = nodes.write;
    for index in 0..packed {
        stage.set(end + index, stage.word(shelf + index));
    }
    let nodes = if lattice.is_some() { (end - HEADER_WORDS) as u32 } else { tree.nodes };
    for (index, word) in (Header { nodes, ..tree }).to_words().into_iter().enumerate() {
        stage.set(index, word);
    }
    Ok(end + packed)
}

/// Nodes on their way to the front.
struct Nodes {
    write: usize,
    /// Right children to come, by number, and where the node is that waits to be told the distance.
    pending: heapless::Vec<(u32, usize), MAX_DEPTH>,
}

impl Nodes {
    fn append(&mut self, stage: &mut Stage<'_>, word: u32) {
        stage.set(self.write, word);
        self.write += 1;
    }

    /// Writes the node of this number in a word, and what does not fit into it in words behind.
    fn append_compact(&mut self, stage: &mut Stage<'_>, lattice: &Lattice, number: u32, node: Node) {
        if let Some(&(right, parent)) = self.pending.last()
            && right == number
        {
            self.pending.pop();
            let distance = (self.write - parent) as u32;
            let node = Compact::from_word(stage.word(parent));
            if node.is_long() {
                stage.set(parent + 1, distance);
            } else {
                stage.set(parent, node.linked_by(distance).to_word());
            }
        }
        match node.kind() {
            Kind::Inner { axis, position, right, empty } => {
                let plane = Compact::inner(axis, lattice.below(axis, position));
                if let Some(side) = empty {
                    return self.append(stage, plane.cutting(side).to_word());
                }
                // Cannot fail: the tree is no deeper.
                let _ = self.pending.push((right, self.write));
                if may_be_long(right - number) {
                    self.append(stage, plane.long().to_word());
                    self.append(stage, 0);
                } else {
                    self.append(stage, plane.to_word());
                }
            }
            Kind::Leaf { first, count } => {
                let leaf = Compact::leaf(first, count);
                self.append(stage, leaf.to_word());
                if leaf.is_far() {
                    self.append(stage, first);
                }
                if leaf.is_large() {
                    self.append(stage, count);
                }
            }
        }
    }
}
