use super::enter::{Beam, Found, Opened, look};
use crate::geometry::{Aabb, Bundle};

/// Gives `visit` the leaves that a ray of a bundle may enter, front to back; see
/// [`Accelerator::sweep`](crate::accel::Accelerator::sweep).
///
/// One walk for all rays: it is in a cell from the earliest entry of any to the latest exit.
#[inline(always)]
pub(super) fn sweep<const HEIGHT: usize>(
    bounds: &Aabb,
    bundle: &Bundle,
    open: impl Fn(u32) -> Option<Opened>,
    mut visit: impl FnMut(u32) -> f32,
) {
    let Some((enter, exit)) = bundle.interval(bounds) else { return };
    let mut waiting: heapless::Vec<Beam, HEIGHT> = heapless::Vec::new();
    let (mut next, mut end) = (Some(Beam { node: 0, enter, exit }), f32::INFINITY);
    while let Some(beam) = next {
        // Written so that NaN visits.
        if beam.enter > end {
            next = waiting.pop();
            continue;
        }
        next = match look(bundle, beam, &open) {
            Found::Half(half, ..) => Some(half),
            Found::Halves { halves: [left, right], descends, .. } => {
                let (near, far) = if descends { (right, left) } else { (left, right) };
                // It cannot fail, because no tree is deeper than its stack.
                let _ = waiting.push(far);
                Some(near)
            }
            Found::Primitives => {
                end = visit(beam.node);
                waiting.pop()
            }
            Found::Nothing => waiting.pop(),
        };
    }
}
