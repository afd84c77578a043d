use std::fmt::Write as _;

use hitscan::{Mesh, asset::Kind, bake};

use super::Bake;
use crate::{
    chip::{self, Chip, Prediction},
    failure::Failure,
    scene::{Choice, Named, broken},
    trial::Rays,
    units::hundreds,
};

/// The structures that answer in whole numbers.
const IN_WHOLE_NUMBERS: [&str; 2] = ["kdtree-compact", "dual-split"];

impl Bake {
    /// What an asset cannot do, or not as well as another one, a line each; its triangles may stand in another order than
    /// those of the model.
    pub fn notes(&self, model: &Mesh<'_>, kind: Option<Kind>, is_ordered: bool) -> String {
        let mut text = String::new();
        if self.quads {
            text += "triangles stand in pairs, for a `QuadMesh`: numbers are not the model's\n";
        } else if is_ordered && !self.keep_numbers {
            text +=
                "triangles stand in the order of the leaves: numbers are not the model's (--keep-numbers keeps them)\n";
        }
        if self.lattice && !matches!(kind, Some(Kind::CompactKdTree | Kind::DualSplit)) {
            let [first, second] = IN_WHOLE_NUMBERS;
            let _ = writeln!(
                text,
                "no `LatticeScene` can be made of this structure: for queries in whole numbers choose -s {first} or -s {second}"
            );
        }
        match self.target {
            Some(chip) if !chip.has_fpu() && !self.lattice => text += &self.without_fpu(model, chip),
            _ => {}
        }
        text
    }

    /// What whole numbers would spare a chip.
    fn without_fpu(&self, model: &Mesh<'_>, chip: Chip) -> String {
        let can_stay = IN_WHOLE_NUMBERS.into_iter().any(|name| self.allows(name));
        let tried = IN_WHOLE_NUMBERS.into_iter().filter(|name| self.allows(name) || !can_stay);
        // A mesh that cannot be put on a lattice is no reason to fail after its asset was made.
        let tried = tried.filter_map(|name| Some((typical(model, chip, name).ok()??, name)));
        let Some((least, name)) = tried.min_by(|(a, _), (b, _)| a.total_cmp(b)) else { return String::new() };
        let structure = if can_stay { String::new() } else { format!(" -s {name}") };
        // Fewer bytes for the structure are more instructions.
        let about = if self.fit.is_some() { "far fewer".to_owned() } else { format!("about {}", hundreds(least)) };
        let chip = chip.phrase();
        format!(
            "{chip} has no FPU: with --lattice{structure}, for a `LatticeScene`, a ray takes {about} instructions\n"
        )
    }

    /// Whether this structure may be taken.
    fn allows(&self, name: &str) -> bool {
        match self.structure {
            Some(Choice::Named(named)) => named.name == name,
            _ => true,
        }
    }
}

/// The instructions that a ray takes on a chip where the vertices stand on a lattice, if that is known.
fn typical(model: &Mesh<'_>, chip: Chip, name: &str) -> Result<Option<f64>, Failure> {
    let Some(named) = Named::find(name) else { return Ok(None) };
    let snapped = bake::lattice(model);
    let mesh = snapped.mesh(model.indices()).map_err(broken)?;
    let built = chip::choose(&mesh, chip, Choice::Named(named), None)?;
    let rays = Rays::around(&*built.scene(&mesh)?);
    Ok(Prediction::new(chip, &built, &mesh, &rays)?.map(|prediction| prediction.typical))
}
