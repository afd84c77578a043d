//! [`write_atomically`]: a file that is there whole or not at all.

use std::fmt;
use std::fs::{self, File, Permissions};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

use crate::{failure::Failure, interrupt};

/// Why an output could not be written, printed as `PATH: WHAT: HOW TO MEND IT`.
#[derive(Debug)]
pub struct OutputError {
    /// The file; `-` for standard output.
    pub path: PathBuf,
    /// What the system said.
    pub error: io::Error,
}

impl fmt::Display for OutputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: ", self.path.display())?;
        match self.error.kind() {
            ErrorKind::NotFound => f.write_str("its directory does not exist: create it first"),
            ErrorKind::NotADirectory => {
                f.write_str("a file stands where the path has a directory: choose another path")
            }
            ErrorKind::IsADirectory => f.write_str("is a directory: name a file in it"),
            ErrorKind::PermissionDenied => f.write_str("may not be written: check permissions or choose another path"),
            ErrorKind::ReadOnlyFilesystem => f.write_str("the disk is read-only: choose another path"),
            ErrorKind::StorageFull | ErrorKind::QuotaExceeded => {
                f.write_str("the disk is full: free some space or choose another disk")
            }
            _ => write!(f, "cannot be written ({}): check the path and the disk", self.error),
        }
    }
}

impl std::error::Error for OutputError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.error)
    }
}

/// Refuses a path that [`write_atomically`] could not serve, before hours of work are spent on what goes there.
pub fn check(path: &Path) -> Result<(), OutputError> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let outcome = match fs::metadata(folder) {
        Err(error) => Err(error),
        Ok(folder) if !folder.is_dir() => Err(ErrorKind::NotADirectory.into()),
        Ok(_) if path.is_dir() => Err(ErrorKind::IsADirectory.into()),
        Ok(_) => Ok(()),
    };
    outcome.map_err(|error| OutputError { path: path.to_owned(), error })
}

/// Refuses a path, given with `option`, that is one of the inputs of the same command: a slip would cost that file.
///
/// Devices can be both, and another name of the same bytes keeps them.
pub fn spare<'a>(option: &str, output: &Path, inputs: impl IntoIterator<Item = &'a Path>) -> Result<(), Failure> {
    let file = |path: &Path| match path == Path::new("-") {
        true => None,
        false => fs::canonicalize(path).ok().filter(|path| path.is_file()),
    };
    let Some(target) = file(output) else { return Ok(()) };
    match inputs.into_iter().any(|input| file(input).as_ref() == Some(&target)) {
        true => {
            Err(Failure::new(format!("{}: is read and written", output.display()), format!("give another {option}")))
        }
        false => Ok(()),
    }
}

/// Writes a file through `write`, or standard output for `-`.
///
/// The bytes go to a temporary file beside the target, which takes the target's name only when all
/// of them are on disk; an error leaves whatever was there before. A reader that closes its end of
/// standard output early (`| head`) has had enough, which is no error.
pub fn write_atomically(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), OutputError> {
    let outcome = if path == Path::new("-") {
        match through(io::stdout().lock(), write) {
            Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
            outcome => outcome.map(drop),
        }
    } else {
        write_file(path, write)
    };
    outcome.map_err(|error| OutputError { path: path.to_owned(), error })
}

fn write_file(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    // Follow a link, so that its target is replaced and not the link.
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let permissions = match fs::metadata(&target) {
        Ok(old) if old.is_dir() => return Err(ErrorKind::IsADirectory.into()),
        // Renaming onto /dev/null or a pipe would replace the device by a file.
        Ok(old) if !old.is_file() => return through(File::create(&target)?, write).map(drop),
        // Renaming needs no right to the old file itself, but its owner's wish counts.
        Ok(old) if old.permissions().readonly() => return Err(ErrorKind::PermissionDenied.into()),
        Ok(old) => Some(old.permissions()),
        Err(_) => usual_permissions(),
    };
    let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty());
    let mut temporary = tempfile::Builder::new();
    temporary.prefix(".hitscan-");
    if let Some(permissions) = permissions {
        temporary.permissions(permissions);
    }
    let mut file = interrupt::undisturbed(|unfinished| {
        let file = temporary.tempfile_in(folder.unwrap_or(Path::new(".")))?;
        unfinished.push(file.path().to_owned());
        io::Result::Ok(file)
    })?;
    let written = through(file.as_file_mut(), write).and_then(|file| file.sync_all());
    interrupt::undisturbed(|unfinished| {
        unfinished.retain(|path| path != file.path());
        written?;
        file.persist(&target)?;
        Ok(())
    })
}

/// Runs `write` through a buffer and flushes it.
fn through<W: Write>(sink: W, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<W> {
    let mut buffer = BufWriter::with_capacity(1 << 16, sink);
    write(&mut buffer)?;
    // Standard output has a buffer of its own, which only `flush` reaches.
    buffer.flush()?;
    buffer.into_inner().map_err(io::IntoInnerError::into_error)
}

/// What the user's mask leaves of rw-rw-rw-, as for any new file; temporary ones are private.
#[cfg(unix)]
fn usual_permissions() -> Option<Permissions> {
    use std::os::unix::fs::PermissionsExt;
    Some(Permissions::from_mode(0o666))
}

#[cfg(not(unix))]
fn usual_permissions() -> Option<Permissions> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    }

    #[test]
    fn a_file_is_replaced_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out");
        for text in ["a long first text", "second"] {
            write_atomically(&path, |w| w.write_all(text.as_bytes())).unwrap();
            assert_eq!(fs::read_to_string(&path).unwrap(), text);
        }
        assert_eq!(names(folder.path()), ["out"]);
    }

    #[test]
    fn an_error_leaves_the_old_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out");
        fs::write(&path, "old").unwrap();
        let half = |w: &mut dyn Write| {
            w.write_all(&[0; 100_000])?;
            Err(ErrorKind::StorageFull.into())
        };
        let error = write_atomically(&path, half).unwrap_err().to_string();
        assert!(error.ends_with("out: the disk is full: free some space or choose another disk"));
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(names(folder.path()), ["out"]);
    }

    #[test]
    fn bad_places_are_refused_in_one_line() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("file"), "").unwrap();
        let complaint = |path: &Path| write_atomically(path, |_| Ok(())).unwrap_err().to_string();
        assert!(complaint(&folder.path().join("no/out")).contains("directory does not exist"));
        assert!(complaint(&folder.path().join("file/out")).contains("a file stands where"));
        assert!(complaint(folder.path()).contains("is a directory"));
        for bad in [folder.path().join("no/out"), folder.path().join("file/out"), folder.path().to_owned()] {
            assert_eq!(check(&bad).unwrap_err().to_string(), complaint(&bad));
        }
        check(Path::new("-")).and(check(Path::new("out"))).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn links_devices_and_masks_are_respected() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let [target, link, fresh] = ["target", "link", "fresh"].map(|name| folder.path().join(name));
        fs::write(&target, "old").unwrap();
        let usual = fs::metadata(&target).unwrap().permissions();
        symlink(&target, &link).unwrap();
        write_atomically(&link, |w| w.write_all(b"new")).unwrap();
        write_atomically(&fresh, |w| w.write_all(b"new")).unwrap();
        assert_eq!(fs::metadata(&fresh).unwrap().permissions(), usual);
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(&target).unwrap(), "new");
        assert_eq!(fs::metadata(&target).unwrap().permissions(), usual);

        fs::set_permissions(&target, Permissions::from_mode(0o600)).unwrap();
        write_atomically(&target, |_| Ok(())).unwrap();
        let mode = fs::metadata(&target).unwrap().permissions().mode();
        assert_eq!(mode & 0o777, 0o600, "a private file stays private");

        fs::set_permissions(&target, Permissions::from_mode(0o444)).unwrap();
        let error = write_atomically(&target, |_| Ok(())).unwrap_err();
        assert_eq!(error.error.kind(), ErrorKind::PermissionDenied);

        let null = folder.path().join("null");
        symlink("/dev/null", &null).unwrap();
        write_atomically(&null, |w| w.write_all(b"gone")).unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
    }
}
