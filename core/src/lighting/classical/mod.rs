//! Environment maps, infinitely far.

use crate::param::{Affects, ParamKind, ParamSpec};

/// Settings of this method.
pub const PARAMS: &[ParamSpec] = &[
    ParamSpec {
        key: "samples",
        label: "Samples",
        unit: "per pixel and frame",
        kind: ParamKind::Integer { min: 0, max: 1024, default: 0 },
        help: "0 looks up the prefiltered map once (split sum); more draws that many visible normals per pixel and \
               reads the map at the level of each sample's footprint.",
        affects: Affects::Frame,
    },
    ParamSpec {
        key: "masking",
        label: "Masking",
        unit: "",
        kind: ParamKind::Choice { options: &["correlated", "separable"], default: 0 },
        help: "Smith masking-shadowing: height-correlated, or the product of both sides.",
        affects: Affects::Frame,
    },
    ParamSpec {
        key: "multiple-scattering",
        label: "Multiple scattering",
        unit: "",
        kind: ParamKind::Choice { options: &["on", "off"], default: 0 },
        help: "Light that bounces between microfacets (reciprocal Kulla-Conty form).",
        affects: Affects::Frame,
    },
    ParamSpec {
        key: "fresnel",
        label: "Fresnel form",
        unit: "",
        kind: ParamKind::Choice { options: &["spectral", "rescaled", "schlick"], default: 0 },
        help: "Form in which metal presets are rendered.",
        affects: Affects::Frame,
    },
];
