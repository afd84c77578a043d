use crate::{
    scene::{Named, Preset},
    units::count,
};

/// Up to this many primitives, testing all of them beats any structure.
pub const HANDFUL: u32 = 8;

/// Above this many primitives, `auto` tries nothing: to build all candidates would take longer than the best one saves.
pub const MANY: u32 = 100_000;

/// What is known of a structure that may be recommended.
#[derive(Clone, Copy, Debug)]
pub struct Candidate {
    /// Which one.
    pub named: &'static Named,
    /// Bytes per primitive once it is baked.
    pub bytes: f64,
    /// The work of a ray, in tests.
    pub work: f64,
}

/// A structure and why it is the one to take.
#[derive(Clone, Debug, PartialEq)]
pub struct Recommendation {
    /// Which one.
    pub named: &'static Named,
    /// Why, for people.
    pub why: String,
}

/// What needs no trial: a handful of primitives, and many; `compare` and `auto` agree on that.
pub fn by_number(primitives: u32) -> Option<Recommendation> {
    if primitives <= HANDFUL {
        let why = format!("for up to {HANDFUL} primitives, testing all of them beats any structure");
        return Some(Recommendation { named: Named::list(), why });
    }
    (primitives > MANY).then(|| Recommendation {
        named: Named::assumed(),
        why: format!("assumed above {} primitives, where trials would take longer than they save", count(MANY)),
    })
}

/// The candidate with the least work among those within the preset's bytes; the smallest if none is.
///
/// A function of counts and bytes alone: no clock has a say, so the answer is the same every time and everywhere.
pub fn recommend(candidates: &[Candidate], preset: Preset) -> Option<Recommendation> {
    let budget = preset.bytes_per_primitive();
    let name = preset.name();
    let within = candidates.iter().filter(|candidate| candidate.bytes <= budget);
    if let Some(Candidate { named, bytes, work }) = within.min_by(|a, b| a.work.total_cmp(&b.work)) {
        let why = format!(
            "the least work of a bounce ray, as much as {work:.1} tests, of those within {budget} bytes per primitive \
             (`{name}`); it takes {bytes:.1} when baked"
        );
        return Some(Recommendation { named, why });
    }
    let smallest = candidates.iter().min_by(|a, b| a.bytes.total_cmp(&b.bytes))?;
    let why = format!(
        "none is within {budget} bytes per primitive (`{name}`), and this is the smallest with {:.1}",
        smallest.bytes
    );
    Some(Recommendation { named: smallest.named, why })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_work_within_the_bytes_wins() {
        let [a, b, c] = [&Named::ALL[1], &Named::ALL[2], &Named::ALL[3]];
        let candidates = [
            Candidate { named: a, bytes: 100.0, work: 5.0 },
            Candidate { named: b, bytes: 30.0, work: 9.0 },
            Candidate { named: c, bytes: 20.0, work: 12.0 },
        ];
        let best = |preset| recommend(&candidates, preset).unwrap();
        assert_eq!(best(Preset::Fast).named, a);
        assert_eq!(best(Preset::Balanced).named, b);
        assert!(best(Preset::Balanced).why.contains("as much as 9.0 tests, of those within 40 bytes"));
        assert_eq!(best(Preset::Small).named, c);
        assert!(best(Preset::Small).why.contains("the smallest with 20.0"));
        assert_eq!(recommend(&[], Preset::Fast), None);
    }

    #[test]
    fn few_and_many_need_no_trial() {
        assert_eq!(by_number(HANDFUL).unwrap().named, Named::list());
        assert_eq!(by_number(HANDFUL + 1), None);
        assert_eq!(by_number(MANY), None);
        assert_eq!(by_number(MANY + 1).unwrap().named, Named::assumed());
    }
}
