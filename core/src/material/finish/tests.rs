use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use super::*;
use crate::surface::micro_normal;

#[test]
fn every_file_is_in_the_library_and_states_every_factor_that_its_kind_sets() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../presets/finishes");
    let files: BTreeSet<String> =
        fs::read_dir(folder).unwrap().map(|file| file.unwrap().file_name().into_string().unwrap()).collect();
    assert_eq!(files, FILES.iter().map(|(file, _)| (*file).to_string()).collect());
    for (file, text) in FILES {
        let finish = Finish::parse(text, file).unwrap();
        assert_eq!(format!("{}.json", finish.id), *file);
        assert!(finish.note.len() > 20, "{file} says what it is");
        for key in finish.kind.keys() {
            assert!(finish.values.contains_key(*key), "{file} states {key}");
        }
    }
    assert_eq!((library().len(), list(Kind::Finish).count()), (FILES.len(), FILES.len() - list(Kind::Coat).count()));
}

#[test]
fn a_material_has_the_finish_that_was_put_on_it_and_none_after_a_change() {
    for finish in library() {
        let mut material = Material { roughness: 0.77, coat: 0.3, ..Material::default() };
        assert_eq!(of(&material, finish.kind), None);
        finish.apply(&mut material);
        assert_eq!(of(&material, finish.kind), Some(finish));
        material.coat += 0.01;
        material.roughness += 0.01;
        assert_eq!(of(&material, finish.kind), None, "{}", finish.id);
    }
}

#[test]
fn a_finish_takes_off_what_the_one_before_it_set_and_leaves_the_coat() {
    let mut material = Material::default();
    find(Kind::Coat, "clear-lacquer").unwrap().apply(&mut material);
    find(Kind::Finish, "hammered").unwrap().apply(&mut material);
    assert_eq!(material.micro_normal, micro_normal::Kind::Hammered);
    find(Kind::Finish, "brushed").unwrap().apply(&mut material);
    assert!(material.micro_normal == micro_normal::Kind::None && material.anisotropy > 0.0);
    find(Kind::Finish, "mirror").unwrap().apply(&mut material);
    assert_eq!((material.roughness, material.anisotropy, material.coat), (0.0, 0.0, 1.0));
}

#[test]
fn factors_that_show_nothing_do_not_count() {
    let mut material = Material::default();
    find(Kind::Finish, "satin").unwrap().apply(&mut material);
    let satin = of(&material, Kind::Finish);
    material = Material { micro_size_mm: 77.0, micro_depth: 0.9, anisotropy_rotation: 1.0, ..material };
    assert_eq!(of(&material, Kind::Finish), satin);
    assert_eq!(
        of(&Material { coat_roughness: 0.9, ..material }, Kind::Coat).map(|coat| coat.id.as_str()),
        Some("none")
    );
}

#[test]
fn a_finish_is_found_by_id_or_name_and_an_unknown_one_is_refused_with_those_there_are() {
    assert_eq!(find(Kind::Finish, "bead-blasted"), find(Kind::Finish, " BEAD-BLASTED "));
    assert_eq!(find(Kind::Coat, "Clear lacquer").unwrap().id, "clear-lacquer");
    let error = |kind, wanted| find(kind, wanted).unwrap_err().to_string();
    assert_eq!(error(Kind::Finish, "hamered"), "no finish `hamered`; did you mean hammered?");
    let text = error(Kind::Coat, "hammered");
    assert!(text.starts_with("no coat `hammered`") && text.contains("clear-lacquer, satin-lacquer"), "{text}");
}

#[test]
fn what_no_finish_has_is_refused_by_the_name_of_its_field() {
    let sound: Value = serde_json::from_str(FILES[0].1).unwrap();
    let refused = |place: &str, value: Value| {
        let mut json = sound.clone();
        *json.pointer_mut(place).unwrap() = value;
        Finish::parse(&json.to_string(), "a.json").unwrap_err().to_string()
    };
    for (place, value, part) in [
        ("/format", "burnish-metal".into(), "`format` is `burnish-metal`"),
        ("/version", 2.into(), "`version` is 2"),
        ("/id", "a/b".into(), "`id` is `a/b`"),
        ("/name", " ".into(), "`name` is empty"),
        ("/values/roughness", 2.into(), "`values.roughness` is refused"),
        ("/values", serde_json::json!({ "metallic": 1 }), "`values.metallic` is no factor of a finish"),
        ("/values", serde_json::json!({ "coat": 1 }), "`values.coat` is no factor of a finish"),
        ("/kind", "paint".into(), "unknown variant `paint`"),
        ("/values", 3.into(), "presets/README.md"),
    ] {
        let error = refused(place, value);
        assert!(error.starts_with("a.json") && error.contains(part), "{error}");
    }
}
