//! What the browser lists: metals of the program, of the user and of the document, and saved materials.

use std::cmp::Reverse;
use std::collections::{BTreeMap, HashMap};
use std::path::PathBuf;
use std::sync::{Arc, LazyLock};

use burnish_core::document::Document;
use burnish_core::material::params::Values;
use burnish_core::material::preset::{self, Preset};
use burnish_core::material::saved::SavedMaterial;
use burnish_core::material::{Material, params};
use burnish_core::param::ParamValue;
use glam::{DVec3, Vec3};

use crate::window::session::Session;
use crate::window::thumbnails::Subject;
use crate::window::user_presets::{UserPresets, key_of};

/// Roughness of the balls of metals: the lamps are seen, the pixels are not.
const BALL_ROUGHNESS: f64 = 0.25;

/// Tag of another measurement of a metal that is there already; its id is that of the metal, a dot and more.
const ALTERNATIVE: &str = "alternative";

/// Tags in the list of filters; more would be a list to search in.
const MAX_TAGS: usize = 20;

/// The metals that come with the program, shared.
static LIBRARY: LazyLock<Vec<Arc<Preset>>> =
    LazyLock::new(|| preset::library().iter().cloned().map(Arc::new).collect());

/// A preset in the browser.
#[derive(Clone, Debug)]
pub struct Item {
    /// By which it is assigned and remembered: the id of a metal, or `material:NAME`.
    pub key: String,
    /// What it is.
    pub content: Content,
    /// Its file, for the user's own.
    pub path: Option<PathBuf>,
    /// What its ball shows.
    pub subject: Arc<Subject>,
    /// Linear colour of the flat ball that stands in for it.
    pub color: Vec3,
    /// Name of the metal of which this is another measurement.
    pub primary: Option<String>,
}

/// What a preset is.
#[derive(Clone, Debug)]
pub enum Content {
    /// A metal.
    Metal(Arc<Preset>),
    /// Factors and a metal.
    Material(Arc<SavedMaterial>),
}

impl Item {
    fn metal(metal: &Arc<Preset>, path: Option<PathBuf>) -> Item {
        let values = Values::from([("roughness", ParamValue::Number(BALL_ROUGHNESS))]);
        Item {
            key: metal.id.clone(),
            content: Content::Metal(metal.clone()),
            path,
            subject: Arc::new(Subject::new(values, Some(metal.clone()))),
            color: visible(f0(metal)),
            primary: None,
        }
    }

    fn material(material: &Arc<SavedMaterial>, path: PathBuf) -> Item {
        let metal = material.constants().cloned().map(Arc::new);
        let stored = |spec: &burnish_core::param::ParamSpec| {
            material.values.get(spec.key).and_then(|json| spec.from_json(json).ok())
        };
        let values: Values = params::PARAMS.iter().filter_map(|spec| Some((spec.key, stored(spec)?))).collect();
        let mut factors = Material::default();
        params::apply(&mut factors, &values);
        let color = metal.as_ref().map_or(factors.base_color, |metal| visible(f0(metal)));
        Item {
            key: key_of(material),
            content: Content::Material(material.clone()),
            path: Some(path),
            subject: Arc::new(Subject::new(values, metal)),
            color,
            primary: None,
        }
    }

    /// Name for people.
    pub fn name(&self) -> &str {
        match &self.content {
            Content::Metal(metal) => &metal.name,
            Content::Material(material) => &material.name,
        }
    }

    /// Words to find it by.
    pub fn tags(&self) -> &[String] {
        match &self.content {
            Content::Metal(metal) => &metal.tags,
            Content::Material(material) => &material.tags,
        }
    }

    /// What speaks against trusting it.
    pub fn warning(&self) -> Option<&str> {
        match &self.content {
            Content::Metal(metal) => metal.warning.as_deref(),
            Content::Material(_) => None,
        }
    }

    /// True for one that does not come with the program.
    pub fn is_own(&self) -> bool {
        self.path.is_some()
    }

    /// True where every word of the search begins a word of its name, its symbol, its id or a tag; another measurement
    /// is found by the name of its metal too.
    pub fn matches(&self, search: &str) -> bool {
        let mut texts = vec![self.name().to_lowercase()];
        texts.extend(self.primary.iter().chain(self.tags()).map(|text| text.to_lowercase()));
        match &self.content {
            Content::Metal(metal) => {
                texts.push(metal.id.to_lowercase());
                texts.extend(metal.symbol.iter().map(|symbol| symbol.to_lowercase()));
            }
            Content::Material(material) => {
                texts.extend(material.metal.iter().map(|metal| metal.id.to_lowercase()));
            }
        }
        let begins = |word: &str| {
            let separate = |c: char| !c.is_alphanumeric();
            texts.iter().any(|text| text.starts_with(word) || text.split(separate).any(|part| part.starts_with(word)))
        };
        search.to_lowercase().split_whitespace().all(begins)
    }
}

/// Puts the preset of a key on materials as one step that undo takes back. Returns the name of the preset, or why not.
pub fn assign(session: &mut Session, own: &UserPresets, key: &str, materials: &[usize]) -> Result<String, String> {
    let items = list(own, session.document());
    let Some(item) = items.into_iter().find(|item| item.key == key) else {
        return Err(format!("There is no preset `{key}`; it may have been removed"));
    };
    let names: Vec<String> =
        (materials.iter()).filter_map(|index| Some(session.document().materials.get(*index)?.name.clone())).collect();
    let target = match names.as_slice() {
        [] => return Err("There is no material to put a preset on".into()),
        [one] => one.clone(),
        many => format!("{} materials", many.len()),
    };
    let bases: Vec<Material> =
        materials.iter().map(|index| session.resolved().base.get(*index).cloned().unwrap_or_default()).collect();
    let textures = own.textures;
    let name = item.name().to_string();
    session.seal();
    session.edit(&format!("Assign {name}"), &target, |document| {
        for (index, base) in materials.iter().zip(&bases) {
            match &item.content {
                Content::Metal(metal) => document.assign_preset(*index, metal, textures),
                Content::Material(saved) => document.assign_saved(*index, saved, base, textures),
            }
        }
    });
    session.seal();
    Ok(name)
}

/// All presets: metals of the program, the user's, those that only the document has, saved materials.
pub fn list(own: &UserPresets, document: &Document) -> Vec<Item> {
    let listing = own.listing();
    let mut items: Vec<Item> = LIBRARY.iter().map(|metal| Item::metal(metal, None)).collect();
    behind_their_primaries(&mut items);
    items.extend(listing.metals.iter().map(|(path, metal)| Item::metal(metal, Some(path.clone()))));
    for metal in &document.presets {
        if !items.iter().any(|item| item.key == metal.id) {
            items.push(Item::metal(metal, None));
        }
    }
    items.extend(listing.materials.iter().map(|(path, material)| Item::material(material, path.clone())));
    items
}

/// By name, other measurements of a metal behind it: `Au.McPeak` behind `Au`.
fn behind_their_primaries(items: &mut [Item]) {
    let names: HashMap<String, String> = items.iter().map(|item| (item.key.clone(), item.name().into())).collect();
    for item in items.iter_mut().filter(|item| item.tags().iter().any(|tag| tag == ALTERNATIVE)) {
        item.primary = item.key.split_once('.').and_then(|(primary, _)| names.get(primary)).cloned();
    }
    items.sort_by_cached_key(|item| {
        let name = item.name().to_string();
        (item.primary.clone().unwrap_or_else(|| name.clone()), item.primary.is_some(), name)
    });
}

/// Tags that at least two presets have, the most frequent first.
pub fn common_tags(items: &[Item]) -> Vec<String> {
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for tag in items.iter().flat_map(|item| item.tags()) {
        *counts.entry(tag).or_default() += 1;
    }
    let mut tags: Vec<(&str, usize)> = counts.into_iter().filter(|(_, count)| *count > 1).collect();
    // Stable: those that are as frequent stay in the order of the alphabet.
    tags.sort_by_key(|(_, count)| Reverse(*count));
    tags.into_iter().take(MAX_TAGS).map(|(tag, _)| tag.to_string()).collect()
}

/// Reflectance at normal incidence, linear Rec.709, not clamped. The stored one saves an integral.
pub fn f0(metal: &Preset) -> DVec3 {
    metal.stored_fits().map_or_else(|| metal.unclamped_f0(), |fits| fits.f0.into())
}

fn visible(reflectance: DVec3) -> Vec3 {
    reflectance.clamp(DVec3::ZERO, DVec3::ONE).as_vec3()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(search: &str) -> Vec<String> {
        let items = list(&UserPresets::default(), &Document::default());
        items.iter().filter(|item| item.matches(search)).map(|item| item.key.clone()).collect()
    }

    #[test]
    fn metals_are_found_by_name_symbol_and_tag() {
        assert_eq!(found("gold"), ["Au", "Au.McPeak", "Au.Olmon-ev", "Au50Ag50", "Au70Ag30"]);
        assert_eq!(found("AU").last().map(String::as_str), Some("StainlessSteel-austenitic"), "it is austenitic");
        assert_eq!(found("steel stain"), ["StainlessSteel-austenitic", "StainlessSteel-ferritic"]);
        assert!(found("noble").contains(&"Ag".to_string()));
        assert_eq!(found("").len(), preset::library().len());
        assert!(found("unobtainium").is_empty());
    }

    #[test]
    fn another_measurement_stands_behind_its_metal_and_is_found_by_its_name() {
        let items = list(&UserPresets::default(), &Document::default());
        let place = |key: &str| items.iter().position(|item| item.key == key).unwrap();
        assert_eq!([place("Fe.Querry"), place("Pt.Rakic-BB")], [place("Fe") + 1, place("Pt") + 1]);
        let alternatives: Vec<&Item> = items.iter().filter(|item| item.primary.is_some()).collect();
        assert_eq!(alternatives.len(), 11);
        assert!(alternatives.iter().all(|item| item.matches(item.primary.as_deref().unwrap())));
    }

    #[test]
    fn tags_are_listed_by_how_many_have_them() {
        let items = list(&UserPresets::default(), &Document::default());
        let tags = common_tags(&items);
        let count = |tag: &String| items.iter().filter(|item| item.tags().contains(tag)).count();
        assert_eq!(tags.first().map(String::as_str), Some("element"));
        assert!(tags.is_sorted_by_key(|tag| Reverse(count(tag))) && tags.iter().all(|tag| count(tag) > 1), "{tags:?}");
    }

    #[test]
    fn a_metal_that_only_the_document_has_is_listed() {
        let mut document = Document::default();
        let metal = Preset { id: "Mine".into(), ..preset::find("Au").unwrap() };
        document.presets.push(Arc::new(metal));
        let items = list(&UserPresets::default(), &document);
        assert!(items.iter().any(|item| item.key == "Mine" && !item.is_own()));
    }
}
