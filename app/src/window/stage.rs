//! Where the picture of the viewport comes from.

/// The source of the picture.
pub enum Stage {
    /// Flat grey: for tests of everything around it.
    Flat,
}
