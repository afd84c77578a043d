use std::{
    fs,
    path::{Path, PathBuf},
};

use async_nats::jetstream::object_store::ObjectStore;
use hitscan_cli::Failure;
use tokio::io::AsyncReadExt;

use crate::{files, refused};

/// Why an asset is not there.
pub enum Missing {
    /// The bytes on the server are not those of its name, or gone: no worker can help that.
    Corrupt(String),
    /// The network or the disk: another try may help.
    Unreachable(Failure),
}

/// Puts bytes where workers find them under their hash, unless they are there.
pub async fn upload(store: &ObjectStore, bytes: &[u8]) -> Result<String, Failure> {
    let name = files::hash(bytes);
    if fetch(store, &name).await.is_ok() {
        return Ok(name);
    }
    let put = store.put(name.as_str(), &mut &*bytes).await;
    put.map_err(|error| refused("uploading", error))?;
    Ok(name)
}

/// The file with the bytes of this hash: the one in the folder, or a new one there, fetched from the server.
pub async fn download(store: &ObjectStore, name: &str, folder: &Path, ending: &str) -> Result<PathBuf, Missing> {
    let path = folder.join(format!("{name}.{ending}"));
    // What lies there may have been damaged since.
    if fs::read(&path).is_ok_and(|bytes| files::hash(&bytes) == name) {
        return Ok(path);
    }
    let bytes = fetch(store, name).await?;
    let failed = |error: std::io::Error| {
        Missing::Unreachable(Failure::new(format!("{}: {error}", path.display()), "choose another --cache"))
    };
    files::make(folder).map_err(Missing::Unreachable)?;
    // Several workers may share the folder: each writes its own file, the last one to finish gives it the name.
    let temporary = folder.join(format!(".{name}.{}", std::process::id()));
    fs::write(&temporary, bytes).map_err(failed)?;
    fs::rename(&temporary, &path).map_err(failed)?;
    Ok(path)
}

/// The bytes of this hash, from the server.
async fn fetch(store: &ObjectStore, name: &str) -> Result<Vec<u8>, Missing> {
    use async_nats::jetstream::object_store::GetErrorKind::NotFound;
    let mut object = match store.get(name).await {
        Ok(object) => object,
        Err(error) if error.kind() == NotFound => return Err(Missing::Corrupt(format!("the asset {name} is gone"))),
        Err(error) => return Err(Missing::Unreachable(refused("fetching the asset", error))),
    };
    let mut bytes = Vec::new();
    match object.read_to_end(&mut bytes).await {
        Ok(_) if files::hash(&bytes) == name => Ok(bytes),
        Ok(_) => Err(Missing::Corrupt(format!("the asset {name} is not what its hash says"))),
        Err(error) if error.kind() == std::io::ErrorKind::InvalidData => {
            Err(Missing::Corrupt(format!("the asset {name} is damaged: {error}")))
        }
        Err(error) => Err(Missing::Unreachable(refused("fetching the asset", error))),
    }
}
