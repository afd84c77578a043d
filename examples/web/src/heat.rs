/// Colours of few nodes to many, in sRGB: dark means cheap. The page's legend shows the same.
const STOPS: [[f32; 3]; 5] =
    [[0.0, 0.0, 4.0], [81.0, 18.0, 124.0], [183.0, 55.0, 121.0], [252.0, 137.0, 97.0], [252.0, 253.0, 191.0]];

/// So many nodes get the last colour.
const MOST: f32 = 1024.0;

/// The colour of a pixel for which so many nodes were visited, on a logarithmic scale.
pub(crate) fn color(nodes: f32) -> [u8; 4] {
    // The logarithm in integers and a straight line between them: the same on every target.
    let log2 = |x: f32| {
        let whole = (x as u32).max(1).ilog2();
        whole as f32 + x / (1_u32 << whole.min(31)) as f32 - 1.0
    };
    let most = (STOPS.len() - 1) as f32;
    let at = (log2(nodes.clamp(0.0, MOST) + 1.0) / log2(MOST + 1.0) * most).clamp(0.0, most);
    let below = (at as usize).min(STOPS.len() - 2);
    let share = at - below as f32;
    let [r, g, b] = [0, 1, 2].map(|i| STOPS[below][i] + (STOPS[below + 1][i] - STOPS[below][i]) * share);
    [(r + 0.5) as u8, (g + 0.5) as u8, (b + 0.5) as u8, 255]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_nodes_are_brighter() {
        let brightness = |nodes| color(nodes).iter().map(|&part| u32::from(part)).sum::<u32>();
        let all: Vec<u32> = (0..=10).map(|power| brightness((1_u32 << power) as f32)).collect();
        assert!(all.is_sorted());
        assert_eq!((color(0.0), color(1.0e9)), ([0, 0, 4, 255], [252, 253, 191, 255]));
    }
}
