use std::path::Path;

use serde_json::json;

use super::*;
use crate::file::testing::Folder;
use crate::material::Reflectance;
use crate::material::finish;
use crate::material::preset;
use crate::scene::Scene;

fn workbench() -> Opened {
    open(DEFAULT_SCENE).unwrap()
}

fn gold() -> &'static Preset {
    preset::library().iter().find(|metal| metal.id == "Au").unwrap()
}

#[test]
fn a_document_is_read_as_it_was_written_with_fields_it_does_not_know() {
    let folder = Folder::new();
    let path = folder.join("a.burnish");
    let mut document = workbench().document;
    document.assign_preset(0, gold(), Assigned::KeepTextures);
    document.set_value(0, "roughness", ParamValue::Number(0.3)).unwrap();
    document.environment.source = Some(folder.join("maps/a.hdr").to_string_lossy().into_owned());
    document.save(&path).unwrap();
    assert_eq!(Document::read(&path).unwrap(), document);

    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains("\"maps/a.hdr\""), "paths are relative: {text}");
    let mut json: Value = serde_json::from_str(&text).unwrap();
    json["future"] = json!([{ "size": 256 }]);
    json["materials"][0]["new-field"] = json!(7);
    std::fs::write(&path, json.to_string()).unwrap();
    let read = Document::read(&path).unwrap();
    read.save(&path).unwrap();
    let again: Value = serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
    assert_eq!(again, json);
}

#[test]
fn what_is_no_document_is_refused_with_the_field_and_what_to_do() {
    let path = Path::new("a.burnish");
    let sound: Value = serde_json::from_str(&workbench().document.to_text(Path::new(""))).unwrap();
    assert!(Document::from_json(sound.clone(), path).is_ok());
    let broken = |change: fn(&mut Value)| {
        let mut json = sound.clone();
        change(&mut json);
        Document::from_json(json, path).unwrap_err().to_string()
    };
    assert!(broken(|j| j["format"] = json!("x")).contains("format"));
    assert!(broken(|j| j["version"] = json!(2)).contains("update Burnish"));
    assert!(broken(|j| j["view"]["exposure_ev"] = json!("x")).contains("a.burnish"));
    assert!(broken(|j| j["view"]["exposure_ev"] = json!(1e9)).contains("view.exposure_ev"));
    assert!(broken(|j| j["materials"][1]["name"] = j["materials"][0]["name"].clone()).contains("two materials"));
    assert!(broken(|j| *j = json!([])).contains("no JSON object"));
}

#[test]
fn numbers_that_no_file_can_hold_are_refused_before_anything_is_written() {
    let folder = Folder::new();
    let path = folder.join("a.burnish");
    let document = workbench().document;
    document.save(&path).unwrap();
    let refused = |change: fn(&mut Document)| {
        let mut changed = document.clone();
        let camera = changed.view.camera.clone();
        changed.save_camera("Camera", &camera);
        change(&mut changed);
        changed.save(&path).unwrap_err().to_string()
    };
    for (fault, field) in [
        (refused(|d| d.view.camera.target[1] = f64::INFINITY), "view.camera.target"),
        (refused(|d| d.view.camera.distance = 0.0), "view.camera.distance"),
        (refused(|d| d.view.camera.yfov_deg = 171.0), "view.camera.yfov_deg"),
        (refused(|d| d.view.exposure_ev = f64::NAN), "view.exposure_ev"),
        (refused(|d| d.cameras.iter_mut().for_each(|c| c.roll_deg = f64::NAN)), "cameras[0].roll_deg"),
    ] {
        assert!(
            fault.contains("a.burnish") && fault.contains(field) && fault.contains("nothing was written"),
            "{fault}"
        );
    }
    assert_eq!(Document::read(&path).unwrap(), document);
}

#[test]
fn a_new_document_resolves_to_its_model() {
    let opened = workbench();
    let model = opened.sources.models[DEFAULT_SCENE].clone();
    let resolved = resolve(&opened.document, &opened.sources, &mut Curves::default());
    assert_eq!((resolved.missing.len(), resolved.notices.len()), (0, 0));
    assert_eq!(resolved.scene.validate(), Ok(()));
    assert_eq!(resolved.scene.materials.len(), model.materials.len());
    for (instance, original) in resolved.scene.instances.iter().zip(&model.instances) {
        let (ours, theirs) = (&resolved.scene.materials[instance.material], &model.materials[original.material]);
        assert_eq!((ours.roughness, ours.base_color), (theirs.roughness, theirs.base_color));
    }
    assert!(Arc::ptr_eq(&resolved.scene.meshes[0], &model.meshes[0]), "meshes are shared, not copied");
}

#[test]
fn edits_show_in_the_scene_and_undo_takes_them_back_byte_for_byte() {
    let opened = workbench();
    let before = opened.document.to_text(Path::new("/"));
    let mut history = History::new(opened.document);
    let keys = resolve(history.current(), &opened.sources, &mut Curves::default()).object_keys;
    assert!(history.edit("Metal", "a", 0.0, |d| d.assign_preset(0, gold(), Assigned::ReplaceTextures)));
    assert!(history.edit("Roughness", "a", 1.0, |d| d.set_value(0, "roughness", ParamValue::Number(0.2)).unwrap()));
    assert!(history.edit("Hide", "", 2.0, |d| d.edit_object(&keys[0], |o| o.hidden = true)));
    assert!(history.edit("New material", "", 3.0, |d| {
        let index = d.duplicate_material(0).unwrap();
        let name = d.materials[index].name.clone();
        d.assign_material(&keys[1..2], &name);
    }));
    assert!(!history.edit("Nothing", "", 4.0, |_| ()));

    let resolved = resolve(history.current(), &opened.sources, &mut Curves::default());
    let gold = &resolved.scene.materials[0];
    assert!(matches!(&gold.reflectance, Reflectance::Preset { id, .. } if id == "Au"));
    assert_eq!(gold.roughness, 0.2);
    assert!(gold.textures().iter().all(Option::is_none));
    assert!(!resolved.scene.instances[0].visible);
    assert_eq!(resolved.scene.instances[1].material, resolved.scene.materials.len() - 1);
    assert_eq!(resolved.scene.validate(), Ok(()));

    let after = history.current().to_text(Path::new("/"));
    while history.undo().is_some() {}
    assert_eq!(history.current().to_text(Path::new("/")), before);
    while history.redo().is_some() {}
    assert_eq!(history.current().to_text(Path::new("/")), after);
}

#[test]
fn a_drag_is_one_step_and_two_drags_are_two() {
    let mut history = History::new(workbench().document);
    let mut drag = |at: f64| {
        for i in 0..10 {
            let now = at + 0.1 * f64::from(i);
            history.edit("Roughness", "a", now, |d| {
                d.set_value(0, "roughness", ParamValue::Number(now / 100.0)).unwrap();
            });
        }
    };
    drag(0.0);
    drag(5.0);
    assert_eq!(history.past().len(), 2);
    history.seal();
    history.edit("Roughness", "a", 5.95, |d| d.set_value(0, "roughness", ParamValue::Number(0.9)).unwrap());
    assert_eq!(history.past().len(), 3);
    for i in 0..100 {
        history.edit(VIEW_LABEL, "", 10.0 + 7.0 * f64::from(i), |d| d.view.camera.orbit(1.0, 0.0));
    }
    assert_eq!(history.past().len(), 4, "a run of camera moves is one step");
    history.go_to(1);
    assert_eq!((history.past().len(), history.future().count()), (1, 3));
    history.edit("Exposure", "", 2000.0, |d| d.view.exposure_ev = 1.0);
    assert_eq!(history.future().count(), 0, "a new edit ends the future");
}

#[test]
fn missing_files_are_listed_and_something_stands_in_for_them() {
    let mut document = workbench().document;
    document.scene = "/nowhere/a.glb".into();
    document.environment.source = Some("/nowhere/a.hdr".into());
    document.set_texture(0, TextureRole::Normal, Some(TextureChoice::File("/nowhere/a.png".into())));
    let opened = reload(document, &Sources::default());
    let kinds: Vec<MissingKind> = opened.missing.iter().map(|missing| missing.kind).collect();
    assert_eq!(kinds, [MissingKind::Model, MissingKind::Environment, MissingKind::Texture]);
    assert!(opened.missing.iter().all(|missing| !missing.reason.is_empty()));
    let resolved = resolve(&opened.document, &opened.sources, &mut Curves::default());
    assert_eq!(resolved.missing.len(), 3);
    assert_eq!(resolved.scene.validate(), Ok(()));
    assert_eq!(resolved.scene.instances.len(), opened.document.materials.len(), "a ball for each material");
}

#[test]
fn a_changed_model_keeps_the_edits_of_materials_by_name() {
    let opened = workbench();
    let model = &opened.sources.models[DEFAULT_SCENE];
    let mut document = opened.document.clone();
    let last = document.materials.len() - 1;
    let name = document.materials[last].source.clone().unwrap();
    document.assign_preset(last, gold(), Assigned::KeepTextures);
    let mut changed = Scene::clone(model);
    changed.materials.insert(0, crate::material::Material { name: "added".into(), ..Default::default() });
    changed.instances.iter_mut().for_each(|instance| instance.material += 1);
    document.sync(&changed);
    let sources = Sources { models: BTreeMap::from([(DEFAULT_SCENE.into(), Arc::new(changed))]), ..Sources::default() };
    let resolved = resolve(&document, &sources, &mut Curves::default());
    let gold: Vec<&str> = (resolved.scene.materials.iter())
        .filter(|m| matches!(m.reflectance, Reflectance::Preset { .. }))
        .map(|m| m.name.as_str())
        .collect();
    assert_eq!(gold, [name.as_str()]);
    assert!(document.materials.iter().any(|entry| entry.name == "added"));
}

#[test]
fn a_nonsense_value_is_noticed_and_left_out() {
    let mut document = workbench().document;
    Arc::make_mut(&mut document.materials[0]).values.insert("roughness".into(), json!("rough"));
    Arc::make_mut(&mut document.materials[0]).preset = Some(PresetUse { id: "Xx".into(), ..PresetUse::default() });
    let resolved = resolve(&document, &workbench().sources, &mut Curves::default());
    assert_eq!(resolved.notices.len(), 2);
    assert!(resolved.notices[0].contains("roughness") && resolved.notices[1].contains("Xx"));
}

#[test]
fn a_method_or_tone_map_of_another_version_is_noticed() {
    let mut document = workbench().document;
    document.lighting.method = "radiosity".into();
    document.view.tone = "film".into();
    let notices = resolve(&document, &workbench().sources, &mut Curves::default()).notices;
    assert_eq!(notices.len(), 2);
    assert!(notices[0].contains("`radiosity`") && notices[0].contains("classical is shown"), "{notices:?}");
    assert!(notices[1].contains("`film`"), "{notices:?}");
}

#[test]
fn own_metals_travel_with_the_document() {
    let mut document = workbench().document;
    let mut own = gold().clone();
    own.id = "My-gold".into();
    document.assign_preset(0, &own, Assigned::KeepTextures);
    assert_eq!(document.presets.len(), 1);
    let resolved = resolve(&document, &workbench().sources, &mut Curves::default());
    assert!(resolved.notices.is_empty());
}

/// Id and n at the first wavelength of what each of the first materials has.
fn metals(document: &Document, count: usize) -> Vec<(&str, f64)> {
    let ids = document.materials.iter().take(count).filter_map(|entry| Some(entry.preset.as_ref()?.id.as_str()));
    ids.map(|id| (id, document.metal(id).unwrap().n[0])).collect()
}

/// Gold with other constants.
fn other_gold(id: &str, factor: f64) -> Preset {
    let n = gold().n.iter().map(|n| factor * n).collect();
    Preset { id: id.into(), name: "Other gold".into(), n, ..gold().clone() }
}

#[test]
fn a_metal_of_the_program_is_itself_also_where_the_document_has_its_id() {
    let mut document = workbench().document;
    let (n, own) = (gold().n[0], other_gold("Au", 2.0));
    document.presets.push(Arc::new(own.clone()));
    Arc::make_mut(&mut document.materials[0]).preset = Some(PresetUse { id: "Au".into(), ..PresetUse::default() });
    document.assign_preset(1, gold(), Assigned::KeepTextures);
    assert_eq!(metals(&document, 2), [("Au-2", 2.0 * n), ("Au", n)]);
    // One that came with the id of a metal of the program never takes its place.
    document.assign_preset(2, &own, Assigned::KeepTextures);
    document.assign_preset(0, gold(), Assigned::KeepTextures);
    assert_eq!(metals(&document, 3), [("Au", n), ("Au", n), ("Au-2", 2.0 * n)]);
    assert_eq!(document.presets.len(), 1);
}

#[test]
fn a_metal_with_the_id_of_another_changes_no_other_material() {
    let mut document = workbench().document;
    let n = gold().n[0];
    document.assign_preset(0, &other_gold("Mine", 2.0), Assigned::KeepTextures);
    for _ in 0..2 {
        document.assign_preset(1, &other_gold("Mine", 4.0), Assigned::KeepTextures);
    }
    assert_eq!(metals(&document, 2), [("Mine", 2.0 * n), ("Mine-2", 4.0 * n)]);
    assert_eq!(document.presets.len(), 2, "each is stored once");
    let long = "x".repeat(64);
    document.assign_preset(0, &other_gold(&long, 2.0), Assigned::KeepTextures);
    document.assign_preset(1, &other_gold(&long, 8.0), Assigned::KeepTextures);
    assert!(document.presets.iter().all(|metal| metal.check("it").is_ok()));
}

#[test]
fn a_material_in_use_is_not_removed() {
    let mut document = workbench().document;
    assert!(!document.remove_material(0), "it belongs to the model");
    let index = document.add_material("own");
    document.assign_material(&["x".into()], "own");
    assert!(!document.remove_material(index));
    document.rename_material(index, "mine");
    assert_eq!(document.assignments[0].material, "mine");
    document.assignments.clear();
    assert!(document.remove_material(index));
}

#[test]
fn a_saved_material_brings_its_factors_and_metal_to_any_material() {
    use crate::material::saved::{SavedMaterial, SavedMetal};
    let Opened { mut document, sources, .. } = workbench();
    let mut curves = Curves::default();
    let base = resolve(&document, &sources, &mut curves).base;
    let saved = |material: &crate::material::Material, metal| SavedMaterial::new("s", Vec::new(), material, metal);
    let own = Preset { id: "Mine".into(), ..gold().clone() };
    let metal =
        SavedMetal { id: "Mine".into(), fresnel: Some("schlick".into()), constants: Some(Box::new(own.clone())) };
    for (index, start) in base.iter().enumerate() {
        let other = (index + 1) % base.len();
        document.assign_saved(index, &saved(&base[other], Some(metal.clone())), start, Assigned::KeepTextures);
    }
    let scene = resolve(&document, &sources, &mut curves).scene;
    for (index, material) in scene.materials.iter().take(base.len()).enumerate() {
        let other = &base[(index + 1) % base.len()];
        for spec in crate::material::params::PARAMS {
            let key = spec.key;
            let (now, then) = (crate::material::params::get(material, key), crate::material::params::get(other, key));
            assert_eq!(now, then, "{key} of {}", material.name);
        }
        assert!(matches!(&material.reflectance, Reflectance::Preset { id, .. } if id == "Mine"));
    }
    assert_eq!(document.presets.len(), 1, "the metal is stored once");
    assert_eq!(document.materials[0].preset.as_ref().unwrap().fresnel.as_deref(), Some("schlick"));
    document.assign_saved(0, &saved(&base[0], None), &base[0], Assigned::KeepTextures);
    assert_eq!((&document.materials[0].preset, document.materials[0].values.len()), (&None, 0));
}

#[test]
fn a_finish_is_one_step_and_takes_off_the_one_before_it() {
    let opened = workbench();
    let base = resolve(&opened.document, &opened.sources, &mut Curves::default()).base;
    let mut history = History::new(opened.document);
    let finish = |id| finish::find(finish::Kind::Finish, id).unwrap();
    let clear = finish::find(finish::Kind::Coat, "clear-lacquer").unwrap();
    assert!(history.edit("Finish", "a", 0.0, |d| d.assign_finish(0, finish("hammered"), &base[0])));
    assert!(history.edit("Coat", "a", 1.0, |d| d.assign_finish(0, clear, &base[0])));
    let of = |document: &Document| {
        let scene = resolve(document, &opened.sources, &mut Curves::default()).scene;
        finish::Kind::ALL.map(|kind| finish::of(&scene.materials[0], kind).map(|finish| finish.id.clone()).unwrap())
    };
    assert_eq!(of(history.current()), ["hammered", "clear-lacquer"]);
    assert!(history.edit("Finish", "a", 2.0, |d| d.assign_finish(0, finish("mirror"), &base[0])));
    assert_eq!(of(history.current()), ["mirror", "clear-lacquer"]);
    let stored: Vec<&String> = history.current().materials[0].values.keys().collect();
    assert!(!stored.iter().any(|key| *key == "micro-normal"), "what the source has is not stored: {stored:?}");
    history.undo();
    assert_eq!(of(history.current()), ["hammered", "clear-lacquer"]);
    assert!(!history.edit("Finish", "a", 3.0, |d| d.assign_finish(99, finish("mirror"), &base[0])));
}

#[test]
fn the_tolerances_of_the_scene_count_for_every_material_that_takes_the_cheapest_form() {
    let Opened { mut document, sources, .. } = workbench();
    let mut curves = Curves::default();
    let mut form = |document: &Document| match &resolve(document, &sources, &mut curves).scene.materials[0].reflectance
    {
        Reflectance::Preset { fresnel, .. } => fresnel.form(),
        Reflectance::BaseColor => panic!("no metal"),
    };
    document.assign_preset(0, gold(), Assigned::KeepTextures);
    use crate::surface::fresnel::{RESCALED, SERIES2, SPECTRAL};
    for own in [None, Some("cheapest")] {
        document.set_fresnel(0, own);
        document.lighting.settings.clear();
        assert_eq!(form(&document), SERIES2, "{own:?}");
        document.lighting.settings.insert("fresnel-error".into(), 5.into());
        document.lighting.settings.insert("fresnel-delta-e".into(), 5.into());
        assert_eq!(form(&document), RESCALED, "{own:?}");
    }
    document.set_fresnel(0, Some("spectral"));
    assert_eq!(form(&document), SPECTRAL);
    document.set_fresnel(0, Some("shiny"));
    assert_eq!(form(&document), RESCALED, "an unknown form is that of the scene");
}

#[test]
fn the_reference_keeps_its_own_settings_and_shares_those_of_the_surface() {
    let mut document = workbench().document;
    assert!(!document.to_text(Path::new("/")).contains("reference"), "nothing is stored of defaults");
    for key in SHARED_SETTINGS {
        let of = |specs| param::find(specs, key).unwrap();
        assert_eq!(of(classical::PARAMS).kind, of(crate::reference::PARAMS).kind, "{key}");
    }
    document.set_reference("bounces", ParamValue::Integer(3)).unwrap();
    document.set_reference("masking", ParamValue::Choice(1)).unwrap();
    document.lighting.reference.insert("of-tomorrow".into(), json!([1]));
    let read = |document: &Document| {
        let settings = document.lighting.reference_settings();
        ["bounces", "masking", "clamp"].map(|key| settings.text(key).unwrap())
    };
    assert_eq!(read(&document), ["3", "separable", "0"]);
    assert_eq!(document.lighting.settings().text("masking").as_deref(), Some("separable"));
    let json = serde_json::from_str(&document.to_text(Path::new("/"))).unwrap();
    let again = Document::from_json(json, Path::new("/a.burnish")).unwrap();
    assert_eq!((&again, read(&again)), (&document, read(&document)));
    assert!(document.set_reference("bounces", ParamValue::Integer(-1)).is_err());
    document.set_reference("bounces", crate::reference::PARAMS[0].default()).unwrap();
    assert_eq!(document.lighting.reference.keys().collect::<Vec<_>>(), ["of-tomorrow"]);
}

#[test]
fn the_reference_traces_spectral_curves_unless_told_otherwise() {
    let mut document = workbench().document;
    assert_eq!(document.lighting.reference_form(), FormChoice::Of(Form::Spectral));
    let place = FormChoice::IDS.iter().position(|id| *id == Form::Schlick.id()).unwrap();
    document.set_reference("fresnel", ParamValue::Choice(place)).unwrap();
    assert_eq!(document.lighting.reference_form(), FormChoice::Of(Form::Schlick));
    document.set_reference("fresnel", ParamValue::Choice(0)).unwrap();
    document.lighting.settings.insert("fresnel-error".into(), 5.into());
    let tolerance = classical::tolerance(&document.lighting.settings());
    assert_eq!(document.lighting.reference_form(), FormChoice::Cheapest(tolerance));
}
