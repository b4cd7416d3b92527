//! What the browser lists: metals of the program, of the user and of the document, and saved materials.

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
            color: visible(metal.unclamped_f0()),
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
        let color = metal.as_ref().map_or(factors.base_color, |metal| visible(metal.unclamped_f0()));
        Item {
            key: key_of(material),
            content: Content::Material(material.clone()),
            path: Some(path),
            subject: Arc::new(Subject::new(values, metal)),
            color,
        }
    }

    /// Name for people.
    pub fn name(&self) -> &str {
        match &self.content {
            Content::Metal(metal) => &metal.name,
            Content::Material(material) => &material.name,
        }
    }

    /// True for one that does not come with the program.
    pub fn is_own(&self) -> bool {
        self.path.is_some()
    }

    /// True where every word of the search begins a word of its name, its symbol, its id or a tag.
    pub fn matches(&self, search: &str) -> bool {
        let mut texts = vec![self.name().to_lowercase()];
        match &self.content {
            Content::Metal(metal) => {
                texts.push(metal.id.to_lowercase());
                texts.extend(metal.symbol.iter().map(|symbol| symbol.to_lowercase()));
                texts.extend(metal.tags.iter().map(|tag| tag.to_lowercase()));
            }
            Content::Material(material) => {
                texts.extend(material.tags.iter().map(|tag| tag.to_lowercase()));
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
    items.sort_by(|a, b| a.name().cmp(b.name()));
    items.extend(listing.metals.iter().map(|(path, metal)| Item::metal(metal, Some(path.clone()))));
    for metal in &document.presets {
        if !items.iter().any(|item| item.key == metal.id) {
            items.push(Item::metal(metal, None));
        }
    }
    items.extend(listing.materials.iter().map(|(path, material)| Item::material(material, path.clone())));
    items
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
    fn a_metal_that_only_the_document_has_is_listed() {
        let mut document = Document::default();
        let metal = Preset { id: "Mine".into(), ..preset::find("Au").unwrap() };
        document.presets.push(Arc::new(metal));
        let items = list(&UserPresets::default(), &document);
        assert!(items.iter().any(|item| item.key == "Mine" && !item.is_own()));
    }
}
