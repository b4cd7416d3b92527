//! Probes as documents store them, and how they are edited.

use glam::Vec3;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::edit::free;
use super::{Document, is_default};
use crate::scene::{Probe, ProbeSource};

/// Texels along the edge of a face that a probe may ask for.
pub const RESOLUTIONS: std::ops::RangeInclusive<u32> = 16..=1024;
/// Paths for a texel that it may ask for.
pub const PATHS: std::ops::RangeInclusive<u32> = 1..=65_536;
/// Farthest place from the origin, metres.
const FAR: f64 = 1e6;

/// A place from which the surroundings of objects are recorded, see [`Probe`]. What is absent is left to the lighting method.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ProbeEntry {
    /// Unique in the document.
    pub name: String,
    /// Metres; in the middle of what it serves when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub position: Option<[f64; 3]>,
    /// Half the edges of the box about it in which it serves, metres; everywhere when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub extent: Option<[f64; 3]>,
    /// Texels along the edge of a face, see [`RESOLUTIONS`].
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "whole")]
    pub resolution: Option<u32>,
    /// One of [`ProbeSource::id`].
    #[serde(default, skip_serializing_if = "is_default")]
    pub source: String,
    /// Paths for a texel, see [`PATHS`].
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "whole")]
    pub paths: Option<u32>,
    /// Keys of the objects that it serves; the subject when empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub serves: Vec<String>,
    /// Fields that this version does not know.
    #[serde(flatten)]
    pub other: Map<String, Value>,
}

/// Any number as the nearest whole one that there is: it is brought into its range later.
fn whole<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<Option<u32>, D::Error> {
    Ok(Option::<f64>::deserialize(deserializer)?.map(|number| number.round() as u32))
}

impl ProbeEntry {
    /// Where its light comes from; traced where this version does not know the word.
    pub fn source(&self) -> ProbeSource {
        ProbeSource::ALL.into_iter().find(|source| source.id() == self.source).unwrap_or_default()
    }

    /// Lets its light come from elsewhere.
    pub fn set_source(&mut self, source: ProbeSource) {
        self.source = if source == ProbeSource::default() { String::new() } else { source.id().into() };
    }

    /// Where it stands, if that is its own.
    pub fn place(&self) -> Option<Vec3> {
        let finite = |metres: f64| if metres.is_finite() { metres.clamp(-FAR, FAR) as f32 } else { 0.0 };
        self.position.map(|position| Vec3::from_array(position.map(finite)))
    }

    /// Half its box, if it has one.
    pub fn half(&self) -> Option<Vec3> {
        let positive = |metres: f64| if metres.is_finite() { metres.clamp(1e-3, FAR) as f32 } else { FAR as f32 };
        self.extent.map(|extent| Vec3::from_array(extent.map(positive)))
    }

    /// The probe of a scene; numbers out of range are brought into it. `keys` are those of the instances. `None` where it names objects of which
    /// there is none.
    pub fn probe(&self, keys: &[String]) -> Option<Probe> {
        let serves: Vec<usize> =
            self.serves.iter().filter_map(|key| keys.iter().position(|known| known == key)).collect();
        let is_lost = serves.is_empty() && !self.serves.is_empty();
        (!is_lost).then(|| Probe {
            name: self.name.clone(),
            position: self.place(),
            extent: self.half(),
            resolution: self.resolution.map(|texels| texels.clamp(*RESOLUTIONS.start(), *RESOLUTIONS.end())),
            source: self.source(),
            paths: self.paths.map(|paths| paths.clamp(*PATHS.start(), *PATHS.end())),
            serves,
        })
    }
}

impl Document {
    /// Adds a probe that serves some objects, the subject where `serves` is empty; returns its name.
    pub fn add_probe(&mut self, serves: Vec<String>) -> String {
        let name = self.free_probe_name("probe");
        self.probes.push(ProbeEntry { name: name.clone(), serves, ..ProbeEntry::default() });
        name
    }

    /// `name`, or `name 2`, `name 3` ... where it is taken by a probe.
    fn free_probe_name(&self, name: &str) -> String {
        free(name, |candidate| self.probes.iter().any(|probe| probe.name == candidate))
    }

    /// A probe by its name.
    pub fn probe(&self, name: &str) -> Option<&ProbeEntry> {
        self.probes.iter().find(|probe| probe.name == name)
    }

    /// A probe by its name, for editing.
    pub fn probe_mut(&mut self, name: &str) -> Option<&mut ProbeEntry> {
        self.probes.iter_mut().find(|probe| probe.name == name)
    }

    /// Adds a copy of a probe beside it; returns its name.
    pub fn duplicate_probe(&mut self, name: &str) -> Option<String> {
        let entry = self.probe(name)?.clone();
        let name = self.free_probe_name(name);
        self.probes.push(ProbeEntry { name: name.clone(), ..entry });
        Some(name)
    }

    /// Gives a probe another name, numbered where that is taken; returns the one it has then.
    pub fn rename_probe(&mut self, name: &str, new: &str) -> String {
        if name == new || new.trim().is_empty() {
            return name.into();
        }
        let others = |candidate: &str| self.probes.iter().any(|probe| probe.name == candidate && probe.name != name);
        let free = free(new.trim(), others);
        match self.probe_mut(name) {
            Some(probe) => {
                probe.name.clone_from(&free);
                free
            }
            None => name.into(),
        }
    }

    /// Puts probes for some objects, the subject where `serves` is empty, in these places instead of those that serve the same; returns
    /// the name of the first. Without places all stays.
    pub fn place_probes(&mut self, serves: &[String], places: &[Vec3]) -> String {
        if places.is_empty() {
            return String::new();
        }
        let kept = self.probes.iter().find(|probe| probe.serves == serves).cloned().unwrap_or_default();
        self.probes.retain(|probe| probe.serves != serves);
        let mut first = None;
        for place in places {
            let name = self.free_probe_name("probe");
            first.get_or_insert_with(|| name.clone());
            let position = Some(place.to_array().map(f64::from));
            // How the former ones were recorded stays.
            self.probes.push(ProbeEntry { name, position, extent: None, serves: serves.into(), ..kept.clone() });
        }
        first.unwrap_or_default()
    }

    /// Takes a probe away.
    pub fn remove_probe(&mut self, name: &str) {
        if let Some(place) = self.probes.iter().position(|probe| probe.name == name) {
            self.probes.remove(place);
        }
    }
}

/// What the probes of a document ask for that this version does not know.
pub(super) fn unknown(probes: &[ProbeEntry], keys: &[String]) -> Vec<String> {
    let mut notices = Vec::new();
    for probe in probes {
        let source = &probe.source;
        if !source.is_empty() && ProbeSource::ALL.iter().all(|known| known.id() != source) {
            notices.push(format!("probe `{}`: source `{source}` is not in this version; it is traced", probe.name));
        }
        let is_lost = !probe.serves.is_empty() && probe.serves.iter().all(|key| !keys.contains(key));
        let then = if is_lost { "it is left out: let it serve another" } else { "it serves the others" };
        for key in probe.serves.iter().filter(|key| !keys.contains(key)) {
            notices.push(format!("probe `{}`: there is no object `{key}`; {then}", probe.name));
        }
    }
    notices
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Curves, open, resolve};

    #[test]
    fn probes_go_into_a_document_and_to_the_scene() {
        let opened = open("gallery:room").unwrap();
        let mut document = opened.document.clone();
        let name = document.add_probe(Vec::new());
        let copy = document.duplicate_probe(&name).unwrap();
        assert_ne!(name, copy);
        let probe = document.probe_mut(&copy).unwrap();
        (probe.position, probe.resolution, probe.serves) = (Some([0.0, -1e30, 1e30]), Some(9), vec!["gone".into()]);
        probe.extent = Some([-1.0, 1e300, 2.0]);
        probe.set_source(ProbeSource::Raster);
        assert_eq!(document.rename_probe(&copy, &name), format!("{name} 2"), "a name stands for one probe");
        let text = serde_json::to_string(&document).unwrap();
        assert_eq!(serde_json::from_str::<Document>(&text).unwrap(), document);
        // JSON has no word for it.
        document.probe_mut(&format!("{name} 2")).unwrap().position = Some([0.0, f64::NAN, 1e30]);
        let resolved = resolve(&document, &opened.sources, &mut Curves::default());
        assert!(resolved.notices.len() == 1 && resolved.notices[0].contains("left out"), "{:?}", resolved.notices);
        assert_eq!(resolved.scene.probes.len(), 1, "one whose objects are gone serves nothing");
        let there = crate::document::object_keys(&resolved.scene).pop().unwrap();
        document.probe_mut(&format!("{name} 2")).unwrap().serves.push(there);
        let resolved = resolve(&document, &opened.sources, &mut Curves::default());
        assert!(resolved.notices.len() == 1 && resolved.notices[0].contains("the others"), "{:?}", resolved.notices);
        assert!(resolved.scene.validate().is_ok());
        let [plain, other] = &resolved.scene.probes[..] else { panic!("two probes") };
        assert_eq!((plain.position, plain.source), (None, ProbeSource::Traced));
        assert_eq!((other.resolution, other.source), (Some(16), ProbeSource::Raster));
        assert_eq!(other.position, Some(Vec3::new(0.0, 0.0, 1e6)));
        document.remove_probe(&name);
        assert_eq!(document.probes.len(), 1);
        document.probes[0].serves.clear();
        assert_eq!((document.place_probes(&[], &[]), document.probes.len()), (String::new(), 1));
        let first = document.place_probes(&[], &[Vec3::X, Vec3::Y]);
        assert_eq!(document.probes.len(), 2);
        let probe = document.probe(&first).unwrap();
        assert_eq!((probe.place(), probe.extent, probe.source()), (Some(Vec3::X), None, ProbeSource::Raster));
        let odd = r#"{"name":"odd","resolution":-5,"paths":1e300}"#;
        let odd = serde_json::from_str::<ProbeEntry>(odd).unwrap().probe(&[]).unwrap();
        assert_eq!((odd.resolution, odd.paths), (Some(16), Some(65_536)));
        let twice = document.probes[0].clone();
        document.probes.push(twice.clone());
        document.remove_probe(&twice.name);
        assert_eq!(document.probes.last(), Some(&twice), "only one goes");
        document.probes[0].source = "painted".into();
        let notices = resolve(&document, &opened.sources, &mut Curves::default()).notices;
        assert!(notices.iter().any(|notice| notice.contains("painted")), "{notices:?}");
    }
}
