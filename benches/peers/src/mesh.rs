use std::{collections::HashMap, fs, path::Path};

use hitscan::{glam::Vec3, primitives::Indices};

/// Triangles over shared vertices, with numbers of 16 bits where they fit.
#[derive(Debug)]
pub struct Mesh {
    /// What the table calls it.
    pub name: String,
    vertices: Vec<Vec3>,
    corners: Corners,
}

#[derive(Debug)]
enum Corners {
    Narrow(Vec<[u16; 3]>),
    Wide(Vec<[u32; 3]>),
}

impl Mesh {
    /// The mesh of these triangles.
    pub fn new(name: impl Into<String>, vertices: Vec<Vec3>, corners: Vec<[u32; 3]>) -> Self {
        let corners = if vertices.len() <= 1 << 16 {
            Corners::Narrow(corners.into_iter().map(|numbers| numbers.map(|number| number as u16)).collect())
        } else {
            Corners::Wide(corners)
        };
        Self { name: name.into(), vertices, corners }
    }

    /// The names of all meshes in `folder`.
    pub fn all(folder: &Path) -> Result<Vec<String>, String> {
        let files = fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        let mut names: Vec<String> = files
            .filter_map(|file| file.ok().map(|file| file.path()))
            .filter(|path| path.extension().is_some_and(|extension| extension == "tri"))
            .filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned()))
            .collect();
        names.sort();
        Ok(names)
    }

    /// The mesh in the file `NAME.tri` of `folder`, corners with the same bits made one vertex.
    pub fn load(folder: &Path, name: &str) -> Result<Self, String> {
        let path = folder.join(name).with_extension("tri");
        let bytes = fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let (words, rest) = bytes.as_chunks::<4>();
        let mut words = words.iter().map(|&word| u32::from_le_bytes(word));
        let count = words.next().unwrap_or(0) as usize;
        if !rest.is_empty() || words.len() != count * 9 {
            return Err(format!("{}: its length is not that of {count} triangles", path.display()));
        }
        let (mut vertices, mut numbers) = (Vec::new(), HashMap::new());
        let mut next_corner = || {
            let bits = [0; 3].map(|_: u32| words.next().unwrap_or(0));
            *numbers.entry(bits).or_insert_with(|| {
                vertices.push(Vec3::from_array(bits.map(f32::from_bits)));
                vertices.len() as u32 - 1
            })
        };
        let corners = (0..count).map(|_| [0; 3].map(|_: u32| next_corner())).collect();
        Ok(Self::new(name, vertices, corners))
    }

    /// How many triangles there are.
    pub fn len(&self) -> usize {
        self.indices().len()
    }

    /// The same as hitscan sees it.
    pub fn view(&self) -> Result<hitscan::Mesh<'_>, hitscan::Error> {
        Ok(hitscan::Mesh::new(&self.vertices, self.indices())?)
    }

    /// What it takes in memory.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.vertices[..])
            + match &self.corners {
                Corners::Narrow(list) => size_of_val(&list[..]),
                Corners::Wide(list) => size_of_val(&list[..]),
            }
    }

    /// All vertices.
    pub fn vertices(&self) -> impl Iterator<Item = Vec3> {
        self.vertices.iter().copied()
    }

    /// The numbers of each triangle's corners.
    pub fn corners(&self) -> impl Iterator<Item = [u32; 3]> {
        (0..self.len() as u32).filter_map(|number| self.indices().get(number))
    }

    /// The corners of all triangles.
    pub fn triangles(&self) -> impl Iterator<Item = [Vec3; 3]> {
        self.corners().map(|numbers| numbers.map(|number| self.vertices[number as usize]))
    }

    fn indices(&self) -> Indices<'_> {
        match &self.corners {
            Corners::Narrow(list) => Indices::Narrow(list),
            Corners::Wide(list) => Indices::Wide(list),
        }
    }
}
