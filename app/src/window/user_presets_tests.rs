use super::*;
use burnish_core::material::Material;

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Folder {
        let path = std::env::temp_dir().join(format!("burnish-presets-{name}-{}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Folder(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn arrived(key: &str) -> Arrival {
    Arrival { key: key.into(), assign: true }
}

fn metal(folder: &Path, id: &str) -> PathBuf {
    let path = folder.join("in.json");
    let metal = Preset { id: id.into(), name: "My gold".into(), ..preset::find("Au").unwrap() };
    fs::write(&path, serde_json::to_string(&metal).unwrap()).unwrap();
    path
}

#[test]
fn a_metal_is_copied_and_one_with_the_id_of_another_is_refused() {
    let folder = Folder::new("metal");
    assert_eq!(Task::Import(metal(&folder.0, "My-Au")).run(&folder.0), Some(Event::Imported(arrived("My-Au"))));
    let listing = Listing::read(&folder.0);
    assert_eq!(listing.metals.iter().map(|(_, m)| m.name.as_str()).collect::<Vec<_>>(), ["My gold"]);
    let Some(Event::Error(fault)) = Task::Import(metal(&folder.0, "Au")).run(&folder.0) else { panic!() };
    assert!(fault.contains("in.json") && fault.contains("another id"), "{fault}");
}

#[test]
fn an_imported_metal_is_kept_with_its_fits_and_one_without_gets_them_in_the_list() {
    let folder = Folder::new("fits");
    let bare = Preset { id: "Mine".into(), fits: None, ..preset::find("Fe").unwrap() };
    let done = Task::Add { metal: Box::new(bare.clone()), assign: false }.run(&folder.0);
    assert_eq!(done, Some(Event::Imported(Arrival { key: "Mine".into(), assign: false })));
    let kept = Listing::read(&folder.0).metals.remove(0).1;
    assert!(kept.fits.as_ref().is_some_and(|fits| fits.belong_to(&kept)));
    let other = Preset { id: "Other".into(), ..bare };
    fs::write(metals_folder(&folder.0).join("other.json"), other.to_text().unwrap()).unwrap();
    let listing = Listing::read(&folder.0).fitted(&Listing::default());
    assert!(listing.metals.iter().all(|(_, metal)| metal.fits.is_some()));
    let again = Listing::read(&folder.0).fitted(&listing);
    assert!(listing.metals.iter().zip(&again.metals).all(|(a, b)| Arc::ptr_eq(&a.1, &b.1)), "made once");
}

#[test]
fn a_metal_with_the_id_of_an_own_one_gets_another_and_the_first_stays() {
    let folder = Folder::new("clash");
    let import = |name: &str, id: &str| {
        let path = folder.0.join("in.json");
        let metal = Preset { id: id.into(), name: name.into(), ..preset::find("Au").unwrap() };
        fs::write(&path, serde_json::to_string(&metal).unwrap()).unwrap();
        Task::Import(path).run(&folder.0)
    };
    for _ in 0..2 {
        assert_eq!(import("One", "Mine"), Some(Event::Imported(arrived("Mine"))), "the same again changes nothing");
    }
    let Some(Event::ImportedAs { arrival, notice }) = import("Two", "Mine") else { panic!() };
    let key = arrival.key;
    assert!(key == "Mine-2" && notice.contains("`Mine-2`"), "{key}: {notice}");
    let listing = Listing::read(&folder.0);
    let known: Vec<_> = listing.metals.iter().map(|(_, m)| (m.name.as_str(), m.id.as_str())).collect();
    assert_eq!(known, [("One", "Mine"), ("Two", "Mine-2")]);
}

#[test]
fn a_material_is_saved_beside_its_namesake_renamed_and_removed() {
    let folder = Folder::new("material");
    let saved = |roughness| {
        let material = Material { roughness, ..Material::default() };
        SavedMaterial::new("Fine / satin", Vec::new(), &material, None)
    };
    for (roughness, words) in [(0.2, "Saved"), (0.3, "`Fine / satin 2`")] {
        let done = Task::Save(Box::new(saved(roughness))).run(&folder.0);
        assert!(matches!(&done, Some(Event::Notice(text)) if text.contains(words)), "{done:?}");
    }
    let listing = Listing::read(&folder.0);
    assert_eq!(listing.materials.len(), 2);
    let (path, known) = listing.materials[0].clone();
    assert_eq!(*known, saved(0.2));
    assert_eq!(*listing.materials[1].1, SavedMaterial { name: "Fine / satin 2".into(), ..saved(0.3) });
    Task::Remove(listing.materials[1].0.clone()).run(&folder.0);
    let renamed = Task::Rename { path: path.clone(), name: "Satin".into() }.run(&folder.0);
    assert_eq!(renamed, Some(Event::Notice("Renamed to `Satin`".into())));
    assert_eq!(Listing::read(&folder.0).materials[0].1.name, "Satin");
    Task::Remove(path).run(&folder.0);
    assert!(Listing::read(&folder.0).materials.is_empty());
}

#[test]
fn a_file_outside_the_folder_is_never_removed() {
    let folder = Folder::new("outside");
    let path = metal(&folder.0, "My-Au");
    assert!(matches!(Task::Remove(path.clone()).run(&folder.0), Some(Event::Error(_))));
    assert!(path.exists());
}

#[test]
fn files_that_cannot_be_read_are_told_and_the_others_are_there() {
    let folder = Folder::new("faults");
    Task::Import(metal(&folder.0, "My-Au")).run(&folder.0);
    fs::write(metals_folder(&folder.0).join("broken.json"), "{").unwrap();
    let listing = Listing::read(&folder.0);
    assert_eq!((listing.metals.len(), listing.faults.len()), (1, 1));
    assert!(listing.faults[0].contains("broken.json"));
}
