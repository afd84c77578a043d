//! The bytes behind a glTF file's accessors.

use std::path::Path;

use gltf::buffer::Source;

use crate::model::{Fault, read_companion};

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

fn decode(uri: &str) -> Result<Vec<u8>, String> {
    let url = data_url::DataUrl::process(uri).map_err(|error| error.to_string())?;
    Ok(url.decode_to_vec().map_err(|error| error.to_string())?.0)
}
