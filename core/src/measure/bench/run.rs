//! Measuring: candidates in turns, so that a busy machine slows all alike.

use super::{BenchError, Cache, FrameTimer, Frames, Record, Region, Rig, Shot, Tools, Truth};
use crate::lighting::method::MethodId;
use crate::measure::{errors, median};
use crate::param::Settings;

/// Seconds of frames of a candidate that are enough, within [`ROUNDS`].
const ENOUGH_SECS: f64 = 2.0;
/// Fewest and most frames of a candidate that are timed.
const ROUNDS: [usize; 2] = [3, 60];

/// A method with settings.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// Which method.
    pub method: MethodId,
    /// Made of its parameters.
    pub settings: Settings,
}

/// What is heard of a measurement.
#[derive(Clone, Copy, Debug)]
pub enum News<'a> {
    /// What comes next, for people; the same words may come many times.
    Next(&'a str),
    /// The candidate at this place has a record.
    Done(usize, &'a Record),
}

/// Hears the news, and ends the measurement by an error.
pub type Listener<'a> = &'a mut dyn FnMut(News<'_>) -> Result<(), BenchError>;

/// A candidate on its way.
struct Entry {
    index: usize,
    frames: Box<dyn Frames>,
    /// Seconds of its frames, and of the calibration pass before each.
    secs: Vec<f64>,
    calibration: Vec<f64>,
}

impl Entry {
    fn is_done(&self) -> bool {
        let total: f64 = self.secs.iter().sum();
        self.secs.len() >= ROUNDS[1] || (self.secs.len() >= ROUNDS[0] && total >= ENOUGH_SECS)
    }
}

/// Records of the candidates in their order. Those that the cache holds are told at once and not measured again, and the
/// rig stays closed where it holds all; each new one is kept and told as soon as all are timed and it is compared.
///
/// Times are medians over frames that the candidates draw in turns, each after a pass of the rig's calibration; one frame
/// before them warms up and does not count.
pub fn measure(
    shot: &Shot,
    truth: &Truth,
    candidates: &[Candidate],
    rig: &mut Rig<'_>,
    cache: &Cache,
    tell: Listener<'_>,
) -> Result<Vec<Record>, BenchError> {
    let keys: Vec<String> =
        candidates.iter().map(|c| cache.key(shot, truth, c, &rig.machine)).collect::<Result<_, _>>()?;
    let mut records: Vec<Option<Record>> = keys.iter().map(|key| cache.record(key)).collect();
    for (index, record) in records.iter().enumerate() {
        record.as_ref().map_or(Ok(()), |record| tell(News::Done(index, record)))?;
    }
    if records.iter().all(Option::is_some) {
        return Ok(records.into_iter().flatten().collect());
    }
    if !rig.is_open() {
        tell(News::Next(&format!("{}: opening the graphics device", shot.name)))?;
    }
    let Tools { timers, calibrate } = rig.tools()?;
    let mut entries = Vec::new();
    for (index, candidate) in candidates.iter().enumerate().filter(|(index, _)| records[*index].is_none()) {
        tell(News::Next(&format!("{}: preparing {}", shot.name, candidate.label())))?;
        let timer = timers.iter_mut().find(|(id, _)| *id == candidate.method);
        let (_, timer) = timer.ok_or(BenchError::NoTimer(candidate.method))?;
        entries.push(open(timer.as_mut(), index, shot, &candidate.settings)?);
    }
    let timing = format!("{}: timing {} candidates in turns", shot.name, entries.len());
    while !entries.iter().all(Entry::is_done) {
        for entry in entries.iter_mut().filter(|entry| !entry.is_done()) {
            tell(News::Next(&timing))?;
            entry.calibration.push(calibrate()?);
            entry.secs.push(entry.frames.frame()?);
        }
    }
    for mut entry in entries {
        let candidate = &candidates[entry.index];
        tell(News::Next(&format!("{}: comparing {}", shot.name, candidate.label())))?;
        let picture = entry.frames.picture()?;
        let masks = truth.masks.each_ref().map(Vec::as_slice);
        let found = errors(&truth.picture, &picture, shot.exposure_ev, &masks)?;
        let mut by_region = [None; Region::ALL.len()];
        by_region.copy_from_slice(&found);
        let preparation = entry.frames.preparation();
        let record = Record {
            scene: shot.name.clone(),
            method: candidate.method.to_string(),
            settings: candidate.texts(),
            width: shot.size.x,
            height: shot.size.y,
            prepare_secs: preparation.secs,
            bytes: preparation.bytes,
            frame_secs: median(&mut entry.secs),
            calibration_secs: median(&mut entry.calibration),
            frames: entry.secs.len(),
            compared_frames: shot.compared_frames,
            errors: by_region,
            floors: truth.floors,
            truth_samples: truth.samples,
            truth_settings: truth.settings.clone(),
        };
        cache.keep(&keys[entry.index], &record)?;
        tell(News::Done(entry.index, &record))?;
        records[entry.index] = Some(record);
    }
    Ok(records.into_iter().flatten().collect())
}

fn open(timer: &mut dyn FrameTimer, index: usize, shot: &Shot, settings: &Settings) -> Result<Entry, BenchError> {
    let mut frames = timer.open(shot, settings)?;
    frames.frame()?;
    Ok(Entry { index, frames, secs: Vec::new(), calibration: Vec::new() })
}

impl Candidate {
    /// The settings as text, all of them.
    pub fn texts(&self) -> Vec<(String, String)> {
        let text = |key: &'static str| (key.to_string(), self.settings.text(key).unwrap_or_default());
        self.settings.iter().map(|(spec, _)| text(spec.key)).collect()
    }

    /// For people: the method and what is not default.
    pub fn label(&self) -> String {
        let changed = changed(&self.settings).into_iter().map(|(key, value)| format!("{key}={value}"));
        [vec![self.method.to_string()], changed.collect()].concat().join(" ")
    }
}

/// The settings that are not default, as text.
pub(super) fn changed(settings: &Settings) -> Vec<(String, String)> {
    let changed = settings.iter().filter(|(spec, value)| spec.default() != *value);
    changed.map(|(spec, _)| (spec.key.to_string(), settings.text(spec.key).unwrap_or_default())).collect()
}
