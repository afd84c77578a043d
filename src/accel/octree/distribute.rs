//! A cell's items into its octants, in the memory they take.

use super::{
    division::Division,
    node::MAX_PRIMITIVES,
    stage::{Item, swap},
};
use crate::geometry::Aabb;

/// Where the octant stands in an item's number for a while.
const TAG: u32 = MAX_PRIMITIVES.trailing_zeros();

/// Replaces the items from `first` on, those of a cell, by their parts in the octants, in the order of these and up to the
/// end of `items`; how many are in each octant.
///
/// There is room for each item in each octant that it has part in; `clip` gives the part of an item in an octant's cell.
pub(super) fn distribute(
    items: &mut [Item],
    first: usize,
    division: &Division,
    cell: &Aabb,
    clip: impl Fn(&Item, &Aabb) -> Option<Aabb>,
) -> [u32; 8] {
    // What is written stays behind what is read: for each item to come there is room for one part at least.
    let (mut written, mut counts) = (0, [0_u32; 8]);
    for read in first..items.len() {
        let Some(item) = items.get(read).copied() else { continue };
        let octants = division.octants(&item.bounds);
        for (octant, count) in counts.iter_mut().enumerate() {
            if octants >> octant & 1 == 0 {
                continue;
            }
            let part = if octants == 1 << octant {
                Some(item.bounds)
            } else {
                clip(&item, &division.point.octant(cell, octant as u32)).filter(|part| !part.is_empty())
            };
            if let (Some(bounds), Some(place)) = (part, items.get_mut(written)) {
                *place = Item { bounds, primitive: item.primitive | (octant as u32) << TAG };
                written += 1;
                *count += 1;
            }
        }
    }
    sort(items, &counts);
    // Against the end, without tags.
    let gap = items.len() - written;
    for index in (0..written).rev() {
        let Some(item) = items.get(index).copied() else { continue };
        if let Some(place) = items.get_mut(index + gap) {
            *place = Item { primitive: item.primitive & (MAX_PRIMITIVES - 1), ..item };
        }
    }
    counts
}

/// Sorts tagged items by their octants, in place: McIlroy, Bostic and McIlroy, *Engineering radix sort*, 1993.
fn sort(items: &mut [Item], counts: &[u32; 8]) {
    let (mut next, mut ends, mut sum) = ([0; 8], [0; 8], 0);
    for ((next, end), &count) in next.iter_mut().zip(&mut ends).zip(counts) {
        *next = sum;
        sum += count as usize;
        *end = sum;
    }
    for octant in 0..8 {
        while next[octant] < ends[octant] {
            let Some(item) = items.get(next[octant]) else { break };
            let home = (item.primitive >> TAG) as usize & 7;
            if home != octant {
                swap(items, next[octant], next[home]);
            }
            next[home] += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use glam::Vec3;

    use super::{super::node::Point, *};
    use crate::testing::Random;

    #[test]
    fn items_come_in_the_order_of_their_octants_and_keep_to_them() {
        let mut random = Random::new(4);
        let cell = Aabb::new(Vec3::ZERO, Vec3::splat(8.0));
        let division = Division { point: Point([3.0, 4.0, f32::INFINITY]), ..Division::NONE };
        for len in [0, 1, 2, 50, 300] {
            let mut point = || Vec3::from_array([0; 3].map(|_| random.below(9) as f32));
            let originals: Vec<Item> =
                (0..len).map(|primitive| Item { bounds: Aabb::around([point(), point()]), primitive }).collect();
            let most = originals.iter().map(|item| division.octants(&item.bounds).count_ones()).sum::<u32>() as usize;
            let first = most - originals.len();
            let mut items = std::vec![Item { bounds: Aabb::EMPTY, primitive: 0 }; first];
            items.extend(&originals);
            let part = |item: &Item, cell: &Aabb| Some(item.bounds.intersection(cell));
            let counts = distribute(&mut items, first, &division, &cell, part);
            assert_eq!(counts.iter().sum::<u32>() as usize, most);
            let mut parts = items.iter();
            for (octant, &count) in counts.iter().enumerate() {
                let inside = division.point.octant(&cell, octant as u32);
                let mut expected: Vec<u32> = originals
                    .iter()
                    .filter(|item| division.octants(&item.bounds) >> octant & 1 != 0)
                    .map(|item| item.primitive)
                    .collect();
                let mut found: Vec<u32> = (0..count)
                    .map(|_| parts.next().unwrap())
                    .inspect(|item| assert_eq!(item.bounds.union(&inside), inside))
                    .map(|item| item.primitive)
                    .collect();
                expected.sort_unstable();
                found.sort_unstable();
                assert_eq!(found, expected);
            }
        }
    }
}
