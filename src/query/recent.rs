/// How many are remembered.
const RECENT: usize = 32;

/// The triangles met last, as many of them as 64 bytes hold.
#[derive(Default)]
pub(super) struct Recent([u16; RECENT]);

impl Recent {
    /// Whether a triangle is known to be among them; it is from now on.
    #[inline(always)]
    pub(super) fn knows(&mut self, index: u32) -> bool {
        let Some(place) = self.0.get_mut(index as usize % RECENT) else { return false };
        // Those with numbers too large are forgotten at once.
        let mark = u16::try_from(index / RECENT as u32 + 1).unwrap_or(0);
        let is_known = *place == mark && mark != 0;
        *place = mark;
        is_known
    }
}
