use crate::failure::Failure;

/// The bytes that an asset may have, and how many of them are not for its structure.
#[derive(Debug)]
pub struct Fit {
    /// The most in all.
    pub most: usize,
    /// Those of everything else.
    pub rest: usize,
    /// What could take fewer.
    pub mend: String,
}

impl Fit {
    /// What the structure may take.
    pub fn room(&self) -> Result<usize, Failure> {
        let Self { most, rest, mend } = self;
        let what = || format!("--fit {most}: all but the structure takes {rest} bytes");
        most.checked_sub(*rest).ok_or_else(|| Failure::new(what(), mend))
    }

    /// The same failure, but for one about the structure's bytes: nobody knows yet whose these are.
    pub fn explain(&self, failure: Failure) -> Failure {
        match failure {
            Failure::Crowded { least, .. } => Failure::new(self.shares(least), &self.mend),
            other => other,
        }
    }

    /// A structure that cannot be made smaller takes so many bytes.
    pub fn refuse(&self, name: &str, bytes: usize) -> Failure {
        let mend = format!("{}, or choose another structure than {name}, such as kdtree", self.mend);
        Failure::new(self.shares(bytes), mend)
    }

    fn shares(&self, least: usize) -> String {
        let Self { most, rest, .. } = self;
        let room = most.saturating_sub(*rest);
        format!(
            "--fit {most}: all but the structure takes {rest} bytes, which leaves {room} to a structure that needs {least}"
        )
    }
}
