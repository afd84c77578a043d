use std::path::Path;

use hitscan::{Instance, Mesh, Primitives, accel::Structure, asset::Asset};

use super::{super::line, describe_sections, describe_shape};
use crate::{
    failure::Failure,
    scene::{Source, StructureArgs, broken},
    units::{count, things},
};

/// Describes scenes that are placed: all of them together, then each by itself.
pub fn describe(
    text: &mut String,
    path: &Path,
    source: &Source,
    asset: &Asset<'_>,
    structure: &StructureArgs,
) -> Result<(), Failure> {
    // This checks everything.
    source.with_subject(path, structure, false, |subject| {
        let bounds = subject.scene.bounds();
        line(text, "in all", subject.size());
        line(text, "bounds", format!("{} to {}", bounds.min, bounds.max));
        line(text, "size", bounds.size());
        Ok(())
    })?;
    let placed: &[Instance] = asset.read().map_err(broken)?;
    describe_level(text, &asset.read().map_err(broken)?, "instances", placed.len());
    for (number, part) in asset.parts().enumerate() {
        let part = part.map_err(broken)?;
        let mesh: Mesh<'_> = part.read().map_err(broken)?;
        let times = placed.iter().filter(|instance| instance.scene() as usize == number).count();
        let bytes = count(size_of_val(part.as_words()));
        line(text, &format!("part {number}"), format!("placed {}, {bytes} bytes", things(times, "time", "times")));
        describe_level(text, &part.read().map_err(broken)?, "triangles", mesh.len() as usize);
    }
    describe_sections(text, asset);
    Ok(())
}

/// One of the two levels: its structure over so many things.
fn describe_level(text: &mut String, structure: &Structure<'_>, what: &str, number: usize) {
    let name = structure.kind().map_or("list".to_owned(), |kind| kind.to_string());
    line(text, what, count(number));
    line(text, "structure", format!("{name}, {} bytes", count(size_of_val(structure.as_words()))));
    describe_shape(text, structure, number);
}
