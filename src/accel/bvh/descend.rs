use super::MAX_DEPTH;

/// Consecutive positions to be divided: the two parts of the pair `pair`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Range {
    pub(super) pair: u32,
    pub(super) first: u32,
    pub(super) count: u32,
    /// The most positions that a part may have, so that it can be divided further within the depth.
    pub(super) most: u32,
    depth: u32,
    halving: bool,
}

/// Divides the positions from 0 to `count` until each is alone, depth first and in order; pairs are numbered as they
/// come, so that a part of k positions has k - 1 of them in a row.
///
/// `divide` says how many positions go to the left, `emit` is told. Where the depth runs out, ranges are
/// halved: below `most`, and all ranges within them, whatever `divide` would say.
pub(super) fn descend(count: u32, mut divide: impl FnMut(&Range) -> u32, mut emit: impl FnMut(&Range, u32)) {
    let mut stack: heapless::Vec<Range, MAX_DEPTH> = heapless::Vec::new();
    let whole = Range { pair: 0, first: 0, count, most: u32::MAX, depth: 0, halving: false };
    let mut next = (count > 1).then_some(whole);
    while let Some(mut range) = next {
        range.most = 1_u32.checked_shl(MAX_DEPTH as u32 - 1 - range.depth).unwrap_or(u32::MAX);
        let wanted = if range.halving { 0 } else { divide(&range) };
        let fits = wanted > 0 && wanted < range.count && wanted.max(range.count - wanted) <= range.most;
        let left = if fits { wanted } else { range.count / 2 };
        emit(&range, left);

        let (depth, halving) = (range.depth + 1, !fits);
        let part = |pair, first, count| Range { pair, first, count, depth, halving, ..range };
        let right = part(range.pair + left, range.first + left, range.count - left);
        let left = part(range.pair + 1, range.first, left);
        next = match (left.count > 1, right.count > 1) {
            (true, true) => {
                // Cannot fail: one for each level above.
                let _ = stack.push(right);
                Some(left)
            }
            (true, false) => Some(left),
            (false, true) => Some(right),
            (false, false) => stack.pop(),
        };
    }
}

/// The way back: lists what is at the leaves from left to right and, by pair as they come, how many are on its left.
///
/// `children` tells of a node what is at it, if it is a leaf, and otherwise its children and how many leaves are below
/// each. The smaller part goes to the left, so that a stack as high as a number has bits suffices.
pub(super) fn flatten<N: Copy>(
    root: N,
    children: impl Fn(N) -> Result<Option<[(N, u32); 2]>, u32>,
    list: &mut [u32],
    lefts: &mut [u32],
) {
    let (mut list, mut lefts) = (list.iter_mut(), lefts.iter_mut());
    let mut stack: heapless::Vec<N, 32> = heapless::Vec::new();
    let mut next = Some(root);
    while let Some(node) = next {
        next = match children(node) {
            Ok(Some([a, b])) => {
                let (small, large) = if b.1 < a.1 { (b, a) } else { (a, b) };
                if let Some(left) = lefts.next() {
                    *left = small.1;
                }
                let _ = stack.push(large.0);
                Some(small.0)
            }
            Ok(None) => None,
            Err(number) => {
                if let Some(place) = list.next() {
                    *place = number;
                }
                stack.pop()
            }
        };
    }
}
