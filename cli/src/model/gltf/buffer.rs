//! The bytes behind a glTF file's accessors.

use std::collections::BTreeMap;
use std::path::Path;

use gltf::buffer::Source;
use gltf::image;
use gltf::texture::{MagFilter, WrappingMode};

use crate::model::error::excerpt;
use crate::model::{Contents, Fault, Image, read_companion};

/// Reads a buffer from the file itself, from its own address, or from a file beside it; never from
/// a network.
pub(super) fn load_buffer(buffer: &gltf::Buffer<'_>, blob: Option<&[u8]>, folder: &Path) -> Result<Vec<u8>, Fault> {
    let (uri, data) = match buffer.source() {
        Source::Bin => ("BIN", blob.map(<[u8]>::to_vec).ok_or("no BIN chunk".to_owned())),
        Source::Uri(uri) if uri.starts_with("data:") => ("data:", decode(uri)),
        Source::Uri(uri) if uri.contains("://") => (uri, Err("not a local file".to_owned())),
        Source::Uri(uri) => {
            let name = percent_encoding::percent_decode_str(uri).decode_utf8_lossy();
            let data = read_companion(folder, &name);
            (uri, data.map_err(|error| error.to_string()))
        }
    };
    let data = data.and_then(|data| match data.len() {
        size if size < buffer.length() => Err(format!("{size} of {} bytes", buffer.length())),
        _ => Ok(data),
    });
    data.map_err(|reason| Fault::Buffer { uri: uri.to_owned(), reason })
}

/// A texture's picture: in a file beside this one, or of this one, in a buffer or in its own address; its bytes are added
/// to `pictures` then, unless they are there already.
pub(super) fn load_image(
    texture: &gltf::Texture<'_>,
    pictures: &mut BTreeMap<usize, Result<Vec<u8>, String>>,
    buffers: &[Vec<u8>],
    folder: &Path,
) -> Image {
    let number = texture.source().index();
    let mut here = |load: &dyn Fn() -> Result<Vec<u8>, String>| {
        pictures.entry(number).or_insert_with(load);
        Contents::Here(number)
    };
    let contents = match texture.source().source() {
        image::Source::View { view, .. } => here(&|| {
            let end = view.offset().checked_add(view.length());
            let bytes = end.and_then(|end| buffers.get(view.buffer().index())?.get(view.offset()..end));
            bytes.map(<[u8]>::to_vec).ok_or_else(|| "not within its buffer: export the model again".to_owned())
        }),
        image::Source::Uri { uri, .. } if uri.starts_with("data:") => {
            here(&|| decode(uri).map_err(|why| format!("{}: export the model again", excerpt(&why))))
        }
        image::Source::Uri { uri, .. } if uri.contains("://") => {
            here(&|| Err(format!("`{}` is not a local file: fetch it, and name that in the model", excerpt(uri))))
        }
        image::Source::Uri { uri, .. } => {
            let name = percent_encoding::percent_decode_str(uri).decode_utf8_lossy();
            Contents::File(folder.join(&*name))
        }
    };
    let sampler = texture.sampler();
    let clamp = [sampler.wrap_s(), sampler.wrap_t()] == [WrappingMode::ClampToEdge; 2];
    Image { contents, nearest: sampler.mag_filter() == Some(MagFilter::Nearest), clamp }
}

fn decode(uri: &str) -> Result<Vec<u8>, String> {
    let url = data_url::DataUrl::process(uri).map_err(|error| error.to_string())?;
    Ok(url.decode_to_vec().map_err(|error| error.to_string())?.0)
}
