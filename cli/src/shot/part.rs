//! Parts of a picture as files: PNGs of some of its rows, which say in text chunks whose rows they are.

use std::{
    fs::File,
    io::{BufReader, ErrorKind},
    path::Path,
};

use super::{Settings, Tiles};
use crate::{
    failure::Failure,
    input::{InputError, InputFault},
    output::OutputError,
    picture::{self, write_png_with},
    scene::Source,
    version::version,
};

/// The keyword of the text that names the picture.
const PICTURE: &str = "hitscan:picture";

/// The keyword of the text that names the tiles.
const TILES: &str = "hitscan:tiles";

/// Which picture a part belongs to: what draws it, which scene, and how.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Identity {
    version: String,
    scene: String,
    settings: String,
}

impl Identity {
    /// That of a scene, none for the built-in one, drawn here.
    pub fn new(source: Option<&Source>, settings: &Settings) -> Result<Self, Failure> {
        let scene = source.map_or_else(|| Ok("built-in".to_owned()), Source::hash)?;
        Ok(Self { version: version(), scene, settings: settings.picture().join(" ") })
    }

    /// What is different in another one, for people.
    fn difference(&self, other: &Self) -> Option<&'static str> {
        let differs = |of: fn(&Self) -> &String| of(self) != of(other);
        [
            (differs(|identity| &identity.version), "drawn by another version"),
            (differs(|identity| &identity.scene), "of another scene"),
            (differs(|identity| &identity.settings), "drawn with other settings"),
        ]
        .into_iter()
        .find_map(|(differs, what)| differs.then_some(what))
    }
}

/// Some tiles of a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// Which picture.
    pub identity: Identity,
    /// Its size.
    pub width: u32,
    pub height: u32,
    /// Which tiles, of how many.
    pub tiles: Tiles,
    pub of: u32,
    /// Their rows.
    pub pixels: Vec<[u8; 3]>,
}

impl Part {
    /// Writes it, whole or not at all.
    pub fn write(&self, path: &Path) -> Result<(), OutputError> {
        let Identity { version, scene, settings } = &self.identity;
        let texts = [
            (PICTURE, format!("{version}\n{scene}\n{settings}")),
            (TILES, format!("{} of {} in {} rows", self.tiles, self.of, self.height)),
        ];
        let rows = self.tiles.rows(self.height, self.of);
        write_png_with(path, self.width, rows.len() as u32, &self.pixels, &texts)
    }

    /// Reads one.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let open = |path: &Path| if path.is_dir() { Err(ErrorKind::IsADirectory.into()) } else { File::open(path) };
        let file = open(path).map_err(|error| InputError { path: path.to_owned(), fault: InputFault::Io(error) })?;
        let no_part = |why: &dyn std::fmt::Display| {
            let what = format!("{}: is no part of a picture ({why})", path.display());
            Failure::new(what, "name what `hitscan render --tiles` wrote")
        };
        let image = picture::read_png(BufReader::new(file)).map_err(|why| no_part(&why))?;
        let text = |keyword| image.texts.iter().find(|(key, _)| key == keyword).map(|(_, text)| text.as_str());
        let part = text(PICTURE).zip(text(TILES)).and_then(|(picture, tiles)| {
            let mut lines = picture.lines().map(str::to_owned);
            let identity = Identity { version: lines.next()?, scene: lines.next()?, settings: lines.next()? };
            let words: Vec<&str> = tiles.split(' ').collect();
            let [tiles, "of", of, "in", height, "rows"] = words[..] else { return None };
            let (tiles, of, height): (Tiles, u32, u32) = (tiles.parse().ok()?, of.parse().ok()?, height.parse().ok()?);
            let fits = tiles.end <= of && tiles.rows(height, of).len() == image.height as usize;
            fits.then_some(Self { identity, width: image.width, height, tiles, of, pixels: image.pixels })
        });
        part.ok_or_else(|| no_part(&"it does not say of which"))
    }

    /// Whether it was drawn for the same tiles, or the first of them, of the same picture.
    pub fn begins(&self, identity: &Identity, (width, height): (u32, u32), tiles: Tiles, of: u32) -> bool {
        let same = self.identity == *identity && (self.width, self.height, self.of) == (width, height, of);
        same && self.tiles.start == tiles.start && self.tiles.end <= tiles.end
    }
}

/// The picture that all these parts, with their names, make.
pub fn merge(mut parts: Vec<(String, Part)>) -> Result<Part, Failure> {
    parts.sort_by_key(|(_, part)| part.tiles.start);
    let mut parts = parts.into_iter();
    let Some((first, mut whole)) = parts.next() else {
        return Err(Failure::new("no parts", "name what `hitscan render --tiles` wrote"));
    };
    let missing = |tiles: std::ops::Range<u32>, of| {
        let what = format!("tiles {}..{} of {of} are missing", tiles.start, tiles.end);
        Err(Failure::new(what, "render them with --tiles, and name all parts"))
    };
    if whole.tiles.start > 0 {
        return missing(0..whole.tiles.start, whole.of);
    }
    for (name, part) in parts {
        let shape = |part: &Part| (part.width, part.height, part.of);
        let other = whole.identity.difference(&part.identity);
        let other = other.or((shape(&whole) != shape(&part)).then_some("divided into other tiles"));
        if let Some(other) = other {
            return Err(Failure::new(format!("{name}: {other} than {first}"), "merge parts of one picture"));
        }
        if part.tiles.start > whole.tiles.end {
            return missing(whole.tiles.end..part.tiles.start, whole.of);
        }
        // What two parts show both must be the same in both.
        let (old, new) = (&mut whole.pixels, &part.pixels);
        let begin = part.tiles.rows(part.height, part.of).start as usize * part.width as usize;
        let common = (old.len() - begin).min(new.len());
        if old[begin..begin + common] != new[..common] {
            let what = format!("{name}: shows something else than other parts where they overlap");
            return Err(Failure::new(what, "render the parts again with one version"));
        }
        old.extend_from_slice(&new[common..]);
        whole.tiles.end = whole.tiles.end.max(part.tiles.end);
    }
    if whole.tiles.end < whole.of {
        return missing(whole.tiles.end..whole.of, whole.of);
    }
    Ok(whole)
}
