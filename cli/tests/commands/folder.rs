//! A folder with small models, and the program run in it.

use std::{
    fs,
    path::PathBuf,
    process::{Command, Output, Stdio},
};

/// A closed mesh.
pub const TETRAHEDRON: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

/// A folder of its own for a test.
pub struct Folder(tempfile::TempDir);

impl Folder {
    /// A folder that holds `tetrahedron.obj`.
    pub fn new() -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        folder.write("tetrahedron.obj", TETRAHEDRON);
        folder
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, contents: impl AsRef<[u8]>) {
        fs::write(self.path(name), contents).unwrap();
    }

    pub fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap()
    }

    /// The names of what is in it, in order.
    pub fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path()).unwrap();
        let mut names: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// The program in this folder, its arguments separated by blanks.
    pub fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_hitscan"));
        command.current_dir(self.0.path()).args(arguments.split_whitespace()).stdin(Stdio::null());
        command
    }

    /// Runs the program to its end.
    pub fn run(&self, arguments: &str) -> Output {
        self.command(arguments).output().unwrap()
    }

    /// Runs the program, which must succeed; what it printed.
    pub fn succeed(&self, arguments: &str) -> String {
        let output = self.run(arguments);
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{arguments}: {errors}");
        String::from_utf8(output.stdout).unwrap()
    }

    /// Runs the program, which must refuse with code 2 and one line, leaving the folder as it was; that line.
    pub fn refuse(&self, arguments: &str) -> String {
        let before = self.names();
        let output = self.run(arguments);
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments}: {errors}");
        assert!(errors.starts_with("hitscan: ") && errors.matches(": ").count() >= 2, "{arguments}: {errors:?}");
        assert!(errors.ends_with('\n') && errors.lines().count() == 1, "{arguments}: {errors:?}");
        assert!(output.stdout.is_empty(), "{arguments}");
        assert_eq!(self.names(), before, "{arguments}");
        errors
    }

    /// Writes a file of rays of any number of f32 each.
    pub fn write_rays<const N: usize>(&self, name: &str, rays: &[[f32; N]]) {
        let bytes: Vec<u8> = rays.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
        self.write(name, bytes);
    }
}
