//! Places from which the surroundings of objects are recorded.

use glam::Vec3;

/// A place from which the surroundings of some objects are recorded, for the methods that look them up from there. What is not
/// said is left to the method: its settings, and the middle of what the probe serves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Probe {
    /// Name for people.
    pub name: String,
    /// Where, metres; in the middle of what it serves when absent.
    pub position: Option<Vec3>,
    /// Half the edges of the box about it in which it serves, metres, above 0; everywhere when absent.
    pub extent: Option<Vec3>,
    /// Texels along the edge of a face.
    pub resolution: Option<u32>,
    /// Where its light comes from.
    pub source: ProbeSource,
    /// Paths for a texel of a traced one.
    pub paths: Option<u32>,
    /// Indices of the instances that it serves and does not see; those of [`Scene::served`](super::Scene::served) when empty.
    pub serves: Vec<usize>,
}

/// Where the light of a probe comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ProbeSource {
    /// All of it, traced by the path tracer; in seconds.
    #[default]
    Traced,
    /// What surfaces send of the direct light of lamps and environment, drawn in a moment.
    Raster,
}

impl ProbeSource {
    /// All of them.
    pub const ALL: [ProbeSource; 2] = [ProbeSource::Traced, ProbeSource::Raster];

    /// Name in files.
    pub const fn id(self) -> &'static str {
        match self {
            ProbeSource::Traced => "traced",
            ProbeSource::Raster => "raster",
        }
    }
}
