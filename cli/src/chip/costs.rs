use hitscan::asset::Kind;

use super::Chip;

/// What `examples/firmware/calibrate` measured.
const TABLE: &str = include_str!("costs.csv");

/// What a structure costs on a chip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Costs {
    /// Instructions of a ray before its first node and after its last one.
    pub setup: f64,
    /// Instructions of a node.
    pub node: f64,
    /// Instructions of a triangle's test.
    pub test: f64,
    /// Bytes of stack of a query.
    pub stack: usize,
    /// Bytes of code for closest and any hit from an asset, built for size.
    pub code: usize,
}

/// In which numbers a query is answered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arithmetic {
    /// In floating point, by a [`Scene`](hitscan::Scene).
    Floats,
    /// In whole numbers, by a [`LatticeScene`](hitscan::LatticeScene).
    Integers,
}

impl Costs {
    /// Those of a structure, or of the list if that is none, over triangles or over pairs of them.
    pub fn of(chip: Chip, structure: Option<Kind>, arithmetic: Arithmetic, in_pairs: bool) -> Option<Self> {
        let costs = |name| TABLE.lines().skip(1).find_map(|line| Self::read(line, chip, name));
        match (arithmetic, structure) {
            (Arithmetic::Floats, Some(Kind::Grid)) if in_pairs => costs("grid-quads"),
            (Arithmetic::Floats, Some(Kind::KdTree)) if in_pairs => costs("kdtree-quads"),
            _ if in_pairs => None,
            // All of its tests are in one leaf.
            (Arithmetic::Floats, None) => costs("kdtree").map(|kd| Self { node: 0.0, ..kd }),
            (Arithmetic::Floats, Some(Kind::Grid)) => costs("grid"),
            (Arithmetic::Floats, Some(Kind::Octree)) => costs("octree"),
            (Arithmetic::Floats, Some(Kind::KdTree)) => costs("kdtree"),
            (Arithmetic::Floats, Some(Kind::CompactKdTree)) => costs("kdtree-compact"),
            (Arithmetic::Floats, Some(Kind::Bvh)) => costs("bvh"),
            (Arithmetic::Floats, Some(Kind::DualSplit)) => costs("dual-split"),
            (Arithmetic::Integers, Some(Kind::CompactKdTree)) => costs("lattice-kdtree-compact"),
            (Arithmetic::Integers, Some(Kind::DualSplit)) => costs("lattice-dual-split"),
            _ => None,
        }
    }

    /// A line of the table, if it is about this.
    fn read(line: &str, chip: Chip, structure: &str) -> Option<Self> {
        let mut cells = line.split(',');
        let is_it = cells.next() == Some(chip.measured_as()) && cells.next() == Some(structure);
        let mut number = || cells.next()?.parse::<f64>().ok();
        if !is_it {
            return None;
        }
        let (setup, node, test) = (number()?, number()?, number()?);
        Some(Self { setup, node, test, stack: number()? as usize, code: number()? as usize })
    }

    /// The instructions of a ray that visits so many nodes and is tested against so many triangles.
    pub fn instructions(&self, nodes: f64, tests: f64) -> f64 {
        self.setup + nodes * self.node + tests * self.test
    }
}

#[cfg(test)]
mod tests {
    use clap::ValueEnum;

    use super::*;

    #[test]
    fn every_structure_was_measured_on_every_chip() {
        let kinds = [Kind::Grid, Kind::Octree, Kind::KdTree, Kind::CompactKdTree, Kind::Bvh, Kind::DualSplit];
        for chip in Chip::value_variants() {
            for kind in kinds.map(Some).into_iter().chain([None]) {
                let costs = Costs::of(*chip, kind, Arithmetic::Floats, false);
                let costs = costs.unwrap_or_else(|| panic!("{chip:?} {kind:?}"));
                assert!(costs.setup > 100.0 && costs.test > 50.0 && costs.node >= 0.0, "{chip:?} {kind:?} {costs:?}");
                assert!((200..4096).contains(&costs.stack) && (2048..65536).contains(&costs.code), "{costs:?}");
            }
            for kind in [Kind::Grid, Kind::KdTree] {
                let [single, pairs] = [false, true]
                    .map(|in_pairs| Costs::of(*chip, Some(kind), Arithmetic::Floats, in_pairs).expect("measured, too"));
                assert!(pairs.test > single.test && pairs.test < 2.0 * single.test, "{chip:?} {single:?} {pairs:?}");
            }
        }
    }

    #[test]
    fn a_float_costs_more_without_an_fpu_and_an_integer_does_not() {
        let test = |chip, arithmetic| Costs::of(chip, Some(Kind::DualSplit), arithmetic, false).unwrap().test;
        for (without, with) in [(Chip::M3, Chip::M4), (Chip::M0, Chip::M33), (Chip::Rv32imac, Chip::Rv32imafc)] {
            assert!(test(without, Arithmetic::Floats) > 10.0 * test(with, Arithmetic::Floats), "{without:?} {with:?}");
            assert!(
                test(without, Arithmetic::Integers) < 3.0 * test(with, Arithmetic::Integers),
                "{without:?} {with:?}"
            );
        }
        assert_eq!(Costs::of(Chip::M0, Some(Kind::Grid), Arithmetic::Integers, false), None);
    }
}
