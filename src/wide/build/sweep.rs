use super::{bins::Rules, hull::Hull, item::Item};

/// The most items that are sorted.
pub(super) const MOST: usize = 64;

/// Items by their middles along an axis.
type Order = [u64; MOST];

/// Divides a small set between any two neighbours along an axis: puts the left part first, and says how many it has and
/// what both cost.
pub(super) fn divide(items: &mut [Item], spare: &mut [Item], rules: &Rules) -> Option<(usize, f32)> {
    let mut best: Option<(Order, usize)> = None;
    let mut least = f32::INFINITY;
    for axis in 0..3 {
        let order = sort(items, axis);
        let order = &order[..items.len().min(MOST)];
        let item = |key: u64| items[(key as u32) as usize].hull();
        let mut behind = [0.0; MOST];
        let mut hull = Hull::EMPTY;
        for (right, (&key, cost)) in (1..).zip(order.iter().zip(&mut behind).rev()) {
            hull = hull.union(item(key));
            *cost = rules.cost(hull, right);
        }
        let mut hull = Hull::EMPTY;
        let mut found = None;
        for (left, (&key, behind)) in (1..).zip(order.iter().zip(behind.iter().skip(1))) {
            hull = hull.union(item(key));
            let cost = rules.cost(hull, left) + behind;
            let right = (items.len() as u32).saturating_sub(left);
            if cost < least && rules.allow(left, right) {
                least = cost;
                found = Some(left as usize);
            }
        }
        if let Some(left) = found {
            let mut kept = [0; MOST];
            kept[..order.len()].copy_from_slice(order);
            best = Some((kept, left));
        }
    }
    let (order, left) = best?;
    for (place, &key) in spare.iter_mut().zip(&order[..items.len()]) {
        *place = items[(key as u32) as usize];
    }
    items.copy_from_slice(&spare[..items.len()]);
    Some((left, least))
}

/// The order of the middles along an axis; equal ones as they stand.
fn sort(items: &[Item], axis: usize) -> Order {
    let mut order = [u64::MAX; MOST];
    for (index, (key, item)) in order.iter_mut().zip(items).enumerate() {
        let bits = item.hull().middle().to_array()[axis].to_bits();
        // As whole numbers, negative ones run backwards and above the others.
        let rank = if bits >> 31 == 0 { bits | 1 << 31 } else { !bits };
        *key = u64::from(rank) << 32 | index as u64;
    }
    order[..items.len().min(MOST)].sort_unstable();
    order
}
