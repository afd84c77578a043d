//! glTF 2.0, text and binary: the triangles of the default scene, in the order of its nodes, each
//! mesh placed by its nodes' transforms. Skins and morph targets stay at rest.

mod buffer;
mod shading;
#[cfg(test)]
mod tests;

use std::path::Path;

use glam::{DMat4, DVec3};
use gltf::accessor::{DataType, Dimensions};
use gltf::mesh::Mode;

use super::{Fault, LoadError, Material, Model, Placement};
use buffer::{load_buffer, load_image};
use shading::shading;

/// Reads the file's `bytes`; buffers of their own lie in `folder`.
pub(super) fn read(bytes: &[u8], folder: &Path) -> Result<Model, LoadError> {
    if !bytes.starts_with(b"glTF") && !bytes.trim_ascii_start().starts_with(b"{") {
        return Err(Fault::NotA("a glTF").into());
    }
    let document = gltf::Gltf::from_slice(bytes).map_err(|e| Fault::Malformed(e.to_string()))?;
    let buffers = document
        .buffers()
        .map(|buffer| load_buffer(&buffer, document.blob.as_deref(), folder))
        .collect::<Result<Vec<_>, Fault>>()?;

    let mut model = Model::default();
    for material in document.materials() {
        let texture = material.pbr_metallic_roughness().base_color_texture();
        let image = texture.map(|info| load_image(&info.texture(), &mut model.pictures, &buffers, folder));
        model.push_material(shading(&material, image))?;
    }
    let Some(scene) = document.default_scene().or_else(|| document.scenes().next()) else {
        return Err(Fault::NoTriangles.into());
    };
    // Depth first, children in the file's order; a stack of our own, as files can be deep.
    let mut stack: Vec<_> = scene.nodes().map(|node| (node, DMat4::IDENTITY)).collect();
    stack.reverse();
    let mut visits_left = document.nodes().len();
    while let Some((node, parent)) = stack.pop() {
        // A node has one parent at most, so more visits than nodes mean a loop.
        visits_left =
            visits_left.checked_sub(1).ok_or_else(|| Fault::Malformed("the nodes do not form a tree".to_owned()))?;
        let local = node.transform().matrix().map(|column| column.map(f64::from));
        let world = parent * DMat4::from_cols_array_2d(&local);
        if let Some(mesh) = node.mesh() {
            let (vertex, triangle) = (model.vertices.len(), model.triangles.len());
            for primitive in mesh.primitives() {
                push_primitive(&mut model, &primitive, &buffers, world)?;
            }
            let (vertices, triangles) = (vertex..model.vertices.len(), triangle..model.triangles.len());
            model.placements.push(Placement { part: mesh.index(), vertices, triangles });
        }
        let children: Vec<_> = node.children().map(|child| (child, world)).collect();
        stack.extend(children.into_iter().rev());
    }
    Ok(model)
}

fn push_primitive(
    model: &mut Model,
    primitive: &gltf::Primitive<'_>,
    buffers: &[Vec<u8>],
    world: DMat4,
) -> Result<(), Fault> {
    let mode = primitive.mode();
    let Some(positions) = primitive.get(&gltf::Semantic::Positions) else {
        return Ok(());
    };
    if !matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
        return Ok(());
    }
    let damaged = |what: &str, accessor: &gltf::Accessor<'_>| {
        Fault::Malformed(format!("accessor {} holds no {what}", accessor.index()))
    };
    // The reader trusts the types, and would allocate any count that no buffer view limits.
    let floats = (DataType::F32, Dimensions::Vec3);
    if (positions.data_type(), positions.dimensions()) != floats || positions.view().is_none() {
        return Err(damaged("positions in f32", &positions));
    }
    let reader = primitive.reader(|buffer| buffers.get(buffer.index()).map(Vec::as_slice));
    let first = model.vertices.len();
    for at in reader.read_positions().ok_or_else(|| damaged("positions", &positions))? {
        // A matrix would turn -0.0 into 0.0 even at rest.
        model.push_vertex(match world == DMat4::IDENTITY {
            true => at,
            false => world.transform_point3(DVec3::from(at.map(f64::from))).as_vec3().to_array(),
        })?;
    }
    let vertices = model.vertices.len() - first;
    let indices: Vec<u32> = match primitive.indices() {
        None => (0..vertices as u32).collect(),
        Some(accessor) if accessor.view().is_none() => return Err(damaged("indices", &accessor)),
        Some(accessor) => reader.read_indices().ok_or_else(|| damaged("indices", &accessor))?.into_u32().collect(),
    };

    let material = match primitive.material().index() {
        Some(index) => index as u16,
        None => neutral_id(model)?,
    };
    let before = push_coordinates(model, primitive, buffers);
    let mut push = |corners: [u32; 3]| {
        if let Some(index) = corners.into_iter().find(|index| *index as usize >= vertices) {
            let (triangle, index) = (model.triangles.len(), i64::from(index));
            return Err(Fault::IndexOutOfRange { triangle, index, vertices, first: 0 });
        }
        if let Some(before) = before {
            model.mapping.push_polygon(model.triangles.len(), &corners.map(|index| before as u32 + index));
        }
        model.push_polygon(&corners.map(|index| first as u32 + index), material);
        Ok(())
    };
    match mode {
        Mode::TriangleStrip => indices.windows(3).enumerate().try_for_each(|(n, w)| {
            // Every other triangle of a strip is turned, to keep the winding.
            push(if n % 2 == 0 { [w[0], w[1], w[2]] } else { [w[0], w[2], w[1]] })
        }),
        Mode::TriangleFan => {
            indices.get(1..).unwrap_or_default().windows(2).try_for_each(|w| push([w[0], w[1], indices[0]]))
        }
        _ => indices.chunks_exact(3).try_for_each(|w| push([w[0], w[1], w[2]])),
    }
}

/// Adds the coordinates that a primitive's vertices have in its material's picture; how many there were before, or
/// nothing if the material has none or the file has none that are usable.
fn push_coordinates(model: &mut Model, primitive: &gltf::Primitive<'_>, buffers: &[Vec<u8>]) -> Option<usize> {
    let set = primitive.material().pbr_metallic_roughness().base_color_texture()?.tex_coord();
    let accessor = primitive.get(&gltf::Semantic::TexCoords(set))?;
    // As for positions, and what lies in no buffer would be zeros without end.
    let known = matches!(accessor.data_type(), DataType::F32 | DataType::U8 | DataType::U16);
    if !known || accessor.dimensions() != Dimensions::Vec2 || accessor.view().is_none() {
        return None;
    }
    let reader = primitive.reader(|buffer| buffers.get(buffer.index()).map(Vec::as_slice));
    let before = model.mapping.coordinates.len();
    model.mapping.coordinates.extend(reader.read_tex_coords(set)?.into_f32());
    Some(before)
}

/// The material of primitives without one, made at its first use.
fn neutral_id(model: &mut Model) -> Result<u16, Fault> {
    let neutral = Material::neutral("");
    match model.materials.iter().rposition(|material| *material == neutral) {
        Some(id) => Ok(id as u16),
        None => model.push_material(neutral),
    }
}
