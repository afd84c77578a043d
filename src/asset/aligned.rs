/// A value at an address that is a multiple of 16, as [`include_asset!`](crate::include_asset) needs it.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
pub struct Aligned<B: ?Sized>(
    /// The value.
    pub B,
);

/// The bytes of a file next to the source, as a `&'static [u8]` in flash, aligned for
/// [`Asset::open`](crate::asset::Asset::open).
///
/// ```ignore
/// static SCENE: &[u8] = hitscan::include_asset!("scene.hits");
/// let scene = Asset::open(SCENE)?.scene::<KdTree, Mesh>()?;
/// ```
#[macro_export]
macro_rules! include_asset {
    ($path:expr $(,)?) => {{
        // `include_bytes!` alone lands at any address.
        static BYTES: &$crate::asset::Aligned<[u8]> = &$crate::asset::Aligned(*include_bytes!($path));
        &BYTES.0
    }};
}
