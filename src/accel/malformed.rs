use core::fmt;

use crate::asset::Kind;

/// Why words are not a structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Malformed {
    /// What they were to be.
    pub structure: Kind,
    /// The word at which it was found out.
    pub word: usize,
    /// What is wrong there.
    pub reason: Reason,
}

/// What can be wrong with the words of a structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Reason {
    /// There are more or fewer words than the header says.
    Length,
    /// A number in the header is out of its range.
    Header,
    /// The bounds are not finite or not in order.
    Bounds,
    /// A plane is not finite or not in order.
    Plane,
    /// A node's child is not the node that must follow.
    Link,
    /// It is deeper than it says, or than a walk's stack.
    Depth,
    /// A leaf's references are not those after the leaf before.
    References,
    /// A leaf names a primitive that does not exist, or one twice that can be named once.
    Primitive,
}

impl fmt::Display for Malformed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = match self.reason {
            Reason::Length => "its length is not what its header says",
            Reason::Header => "a number in the header is out of range",
            Reason::Bounds => "its bounds are not finite or not in order",
            Reason::Plane => "a plane is not finite or not in order",
            Reason::Link => "a node's child is not where it must be",
            Reason::Depth => "it is deeper than it says or than a walk's stack",
            Reason::References => "a leaf's references are not where they must be",
            Reason::Primitive => "a leaf names a primitive that does not exist, or once too often",
        };
        write!(f, "no {}: at word {} {what}", self.structure, self.word)
    }
}

impl core::error::Error for Malformed {}
