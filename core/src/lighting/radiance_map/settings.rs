//! The settings of the method, and what bakes and frames read of them.

use std::collections::HashMap;
use std::sync::{Arc, LazyLock, PoisonError, RwLock};

use glam::Vec3;

use super::bake::Asked;
use super::directions::{Directions, FEWEST, Spread};
use super::near::Filter;
use crate::lighting::{Prepared, classical};
use crate::param::{Affects, ParamError, ParamKind, ParamSpec, ParamValue, Settings};

/// Places of a map, at least.
const FEWEST_POINTS: u32 = 64;

const POINTS: ParamSpec = ParamSpec {
    key: "points",
    label: "Points",
    unit: "",
    kind: ParamKind::Integer { min: FEWEST_POINTS as i64, max: 4_000_000, default: 10_000 },
    help: "Places on surfaces of which light is kept, spread by area.",
    affects: Affects::Prepare,
};

const DIRECTIONS: ParamSpec = ParamSpec {
    key: "directions",
    label: "Directions",
    unit: "per point",
    kind: ParamKind::Integer { min: FEWEST as i64, max: 1024, default: 64 },
    help: "Directions from which light is kept, the same for all points.",
    affects: Affects::Prepare,
};

const PATHS: ParamSpec = ParamSpec {
    key: "paths",
    label: "Paths",
    unit: "per direction",
    kind: ParamKind::Integer { min: 1, max: 65_536, default: 8 },
    help: "Paths that are traced for each direction of each point.",
    affects: Affects::Prepare,
};

const GATHER: ParamSpec = ParamSpec {
    key: "gather",
    label: "Gather",
    unit: "times",
    kind: ParamKind::Integer { min: 0, max: 4, default: 1 },
    help: "Paths end at the first surface and take the light of a map of a quarter of the points, which is baked before: less noise. With 0 they \
           go on until they end.",
    affects: Affects::Prepare,
};

const DENSER: ParamSpec = ParamSpec {
    key: "denser",
    label: "Denser",
    unit: "share",
    kind: ParamKind::Number { min: 0.0, max: 0.9, default: 0.0 },
    help: "Share of the points that lie where light varies, as a coarse map tells that is baked before; the others are spread by area.",
    affects: Affects::Prepare,
};

const SPREAD: ParamSpec = ParamSpec {
    key: "spread",
    label: "Spread",
    unit: "",
    kind: ParamKind::Choice { options: &Spread::IDS, default: 0 },
    help: "How directions are spread over the sphere.",
    affects: Affects::Prepare,
};

const SEED: ParamSpec = ParamSpec {
    key: "seed",
    label: "Seed",
    unit: "",
    kind: ParamKind::Integer { min: 0, max: u32::MAX as i64, default: 0 },
    help: "Chooses the random numbers of the paths.",
    affects: Affects::Prepare,
};

const LOBE_SAMPLES: ParamSpec = ParamSpec {
    key: "lobe-samples",
    label: "Lobe samples",
    unit: "per frame",
    kind: ParamKind::Integer { min: 0, max: 64, default: 1 },
    help: "Directions drawn from the surface beside those of the map: without them narrow highlights fall between these.",
    affects: Affects::Frame,
};

const TRACE_BELOW: ParamSpec = ParamSpec {
    key: "trace-below",
    label: "Trace below",
    unit: "roughness",
    kind: ParamKind::Number { min: 0.0, max: 1.0, default: 0.35 },
    help: "Smoother surfaces trace rays and take the map where these end.",
    affects: Affects::Frame,
};

const INTERPOLATION: ParamSpec = ParamSpec {
    key: "interpolation",
    label: "Interpolation",
    unit: "",
    kind: ParamKind::Choice { options: &["nearest", "smooth"], default: 0 },
    help: "How light is looked up between the directions of the map. smooth hides the cells in glossy metals, and takes light off \
           matt surfaces that face it.",
    affects: Affects::Frame,
};

const FILTER: ParamSpec = ParamSpec {
    key: "filter",
    label: "Filter",
    unit: "",
    kind: ParamKind::Choice { options: &["hat", "box"], default: 0 },
    help: "How places around a point are weighed: a hat over their distance, or all of them the same.",
    affects: Affects::Frame,
};

const GUARDS: ParamSpec = ParamSpec {
    key: "guards",
    label: "Guards",
    unit: "",
    kind: ParamKind::Choice { options: &["on", "off"], default: 0 },
    help: "Places whose surface faces elsewhere, or lies off the plane of a point, do not light it. off shows what leaks without.",
    affects: Affects::Frame,
};

const fn strength(key: &'static str, label: &'static str, help: &'static str) -> ParamSpec {
    ParamSpec {
        key,
        label,
        unit: "",
        kind: ParamKind::Number { min: 0.0, max: 1000.0, default: 1.0 },
        help,
        affects: Affects::Frame,
    }
}

const STRENGTHS: [ParamSpec; 3] = [
    strength("environment-strength", "Environment", "Factor on the light of the environment, without another bake."),
    strength(
        "lamps-strength",
        "Lamps",
        "Factor on the light of lamps that comes over other surfaces, without another bake.",
    ),
    strength("glow-strength", "Glow", "Factor on the light of what glows, without another bake."),
];

const fn tint(key: &'static str, label: &'static str) -> ParamSpec {
    ParamSpec {
        key,
        label,
        unit: "",
        kind: ParamKind::Color { max: 4.0, default: [1.0; 3] },
        help: "Colour by which that light is multiplied, linear, without another bake.",
        affects: Affects::Frame,
    }
}

const TINTS: [ParamSpec; 3] =
    [tint("environment-tint", "Environment tint"), tint("lamps-tint", "Lamps tint"), tint("glow-tint", "Glow tint")];

/// Settings of this method: the last are those of `classical`, but for its samples.
pub const PARAMS: &[ParamSpec] = &[
    POINTS,
    DIRECTIONS,
    PATHS,
    GATHER,
    DENSER,
    SPREAD,
    SEED,
    LOBE_SAMPLES,
    TRACE_BELOW,
    INTERPOLATION,
    FILTER,
    GUARDS,
    STRENGTHS[0],
    TINTS[0],
    STRENGTHS[1],
    TINTS[1],
    STRENGTHS[2],
    TINTS[2],
    classical::PARAMS[1],
    classical::PARAMS[2],
    classical::PARAMS[3],
    classical::PARAMS[4],
    classical::PARAMS[5],
];

/// Places and directions of a draft, at most.
const DRAFT_POINTS: u32 = 2000;
pub(super) const DRAFT_DIRECTIONS: u32 = 32;

/// Settings for a draft, in a part of a second.
pub(super) fn draft(settings: &Settings) -> Result<Settings, ParamError> {
    let most = [(&POINTS, DRAFT_POINTS), (&DIRECTIONS, DRAFT_DIRECTIONS), (&PATHS, 1), (&GATHER, 0)];
    changed(settings, most.map(|(spec, most)| (spec, settings.whole(spec).min(most))))
}

/// The same with some values.
fn changed<const N: usize>(settings: &Settings, values: [(&ParamSpec, u32); N]) -> Result<Settings, ParamError> {
    let mut settings = settings.clone();
    values.into_iter().try_for_each(|(spec, value)| settings.set(spec.key, &value.to_string()))?;
    Ok(settings)
}

/// Settings of the map that a bake gathers from; `None` for one that gathers nothing.
pub(super) fn gathered(settings: &Settings) -> Option<Settings> {
    /// So that noise of the map does not come again in those that gather from it.
    const OTHER_SEED: u32 = 0x9e37_79b9;
    let times = settings.whole(&GATHER);
    let before = [
        (&GATHER, times.checked_sub(1)?),
        (&DENSER, 0),
        (&POINTS, settings.whole(&POINTS).div_ceil(4).max(FEWEST_POINTS)),
        (&SEED, settings.whole(&SEED).wrapping_add(OTHER_SEED)),
    ];
    changed(settings, before).ok()
}

/// Settings of the coarse map that tells where places lie, and the share of these; `None` where all are spread by area. Its seed is the same for all, so
/// that bakes of several seeds are of the same places.
pub(super) fn coarse(settings: &Settings) -> Option<(Settings, f32)> {
    let share = settings.number(&DENSER);
    if share <= 0.0 {
        return None;
    }
    let values = [
        (&POINTS, settings.whole(&POINTS).div_ceil(8).max(FEWEST_POINTS)),
        (&DIRECTIONS, DRAFT_DIRECTIONS),
        (&PATHS, 4),
        (&GATHER, 0),
    ];
    Some((changed(&Settings::new(PARAMS), values).ok()?, share))
}

/// What is baked, from settings made of [`PARAMS`].
pub(super) fn asked(settings: &Settings) -> Asked {
    let [points, paths, seed] = [POINTS, PATHS, SEED].map(|spec| settings.whole(&spec));
    Asked { points, paths, seed }
}

/// How a map is looked up, from settings made of [`PARAMS`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// Directions drawn from the surface.
    pub lobes: u32,
    /// Width of the lobe below which rays are traced.
    pub below: f32,
    /// Light is interpolated between directions.
    pub smooth: bool,
    /// Which places count.
    pub filter: Filter,
    /// Factors on the light of each of [`super::GROUPS`], linear Rec.709.
    pub strengths: [Vec3; 3],
    /// What of it is done.
    pub part: Part,
}

/// What is done of a lookup: less than all tells what parts of a frame cost, its pictures mean nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Part {
    /// All.
    #[default]
    All,
    /// Nothing is looked up.
    Nothing,
    /// The set that lights a point is found.
    Query,
    /// The eight nearest places are searched instead.
    Search,
    /// The light of the set is summed over all directions.
    Filter,
}

impl Look {
    /// That of settings.
    pub fn new(settings: &Settings) -> Look {
        Look {
            lobes: settings.whole(&LOBE_SAMPLES),
            below: settings.number(&TRACE_BELOW).powi(2),
            smooth: settings.choice(&INTERPOLATION) == 1,
            filter: filter(settings),
            strengths: std::array::from_fn(|i| {
                settings.number(&STRENGTHS[i]) * Vec3::from_array(settings.color(&TINTS[i]))
            }),
            part: Part::All,
        }
    }
}

/// How places are weighed, from settings made of [`PARAMS`].
fn filter(settings: &Settings) -> Filter {
    Filter { box_shaped: settings.choice(&FILTER) == 1, unguarded: settings.choice(&GUARDS) == 1 }
}

/// Directions, made once for all who ask.
pub(super) fn directions(spread: Spread, count: u32) -> Arc<Directions> {
    type Made = HashMap<(Spread, u32), Arc<Directions>>;
    static MADE: LazyLock<RwLock<Made>> = LazyLock::new(RwLock::default);
    let key = (spread, count);
    if let Some(made) = MADE.read().unwrap_or_else(PoisonError::into_inner).get(&key) {
        return made.clone();
    }
    let made = Arc::new(Directions::new(spread, count));
    MADE.write().unwrap_or_else(PoisonError::into_inner).entry(key).or_insert(made).clone()
}

/// Those of the texts of settings; `None` where these are not understood.
pub(super) fn directions_of_texts(spread: &str, count: &str) -> Option<Arc<Directions>> {
    known(Spread::IDS.iter().position(|id| *id == spread)?, count.parse().ok()?)
}

/// Those of settings made of [`PARAMS`].
pub(super) fn asked_directions(settings: &Settings) -> Arc<Directions> {
    let spread = if settings.choice(&SPREAD) == 1 { Spread::Halton } else { Spread::Fibonacci };
    directions(spread, settings.whole(&DIRECTIONS))
}

/// Those of a map; `None` where there is no map.
pub fn baked_directions(prepared: &Prepared) -> Option<Arc<Directions>> {
    let [spread, count] = *prepared.whole("directions") else { return None };
    known(spread as usize, count)
}

/// Those that a file names; `None` where no settings ask for them.
fn known(spread: usize, count: u32) -> Option<Arc<Directions>> {
    let spread = *Spread::ALL.get(spread)?;
    DIRECTIONS.accepts(ParamValue::Integer(count.into())).then(|| directions(spread, count))
}
