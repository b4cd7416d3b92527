use glam::DVec3;

use super::library::FILES;
use super::*;
use crate::color::observer::wavelength_nm;
use crate::file::testing::Folder;
use crate::surface::fresnel::TABLE_SIZE;

/// Id; reflectance at normal incidence at 450, 550, 650 nm, computed with the published table outside of the project,
/// to four decimals; linear Rec.709 F0 (D65, CIE 1931, 5 nm) from an independent double precision computation, six
/// digits.
const KNOWN: [(&str, [f64; 3], [f64; 3]); 57] = [
    ("Ag", [0.9802, 0.9831, 0.9898], [0.989362, 0.983953, 0.977827]),
    ("Al", [0.9219, 0.9154, 0.9056], [0.907335, 0.915846, 0.922321]),
    ("Au", [0.4082, 0.7916, 0.9565], [1.0373, 0.728376, 0.364813]),
    ("Au.McPeak", [0.3904, 0.8475, 0.9679], [1.05271, 0.783669, 0.342745]),
    ("Au.Olmon-ev", [0.3836, 0.8381, 0.9577], [1.04279, 0.77395, 0.334592]),
    ("Au50Ag50", [0.6483, 0.8914, 0.9325], [0.930518, 0.897263, 0.623032]),
    ("Au70Ag30", [0.4896, 0.8713, 0.9314], [0.942786, 0.869189, 0.482057]),
    ("Be", [0.5337, 0.5338, 0.5403], [0.538964, 0.533428, 0.533733]),
    ("Bi", [0.4886, 0.5319, 0.5648], [0.561241, 0.530377, 0.484937]),
    ("Ca", [0.7538, 0.8413, 0.882], [0.883527, 0.838143, 0.742767]),
    ("Co", [0.6186, 0.6571, 0.6851], [0.683026, 0.655209, 0.615994]),
    ("Cr", [0.5548, 0.5545, 0.5556], [0.549658, 0.556014, 0.554207]),
    ("Cr.Rakic-BB", [0.6631, 0.6511, 0.6379], [0.638651, 0.652154, 0.664113]),
    ("Cs", [0.3854, 0.5817, 0.6753], [0.672662, 0.578113, 0.364027]),
    ("Cu", [0.5383, 0.6235, 0.9352], [0.931399, 0.622833, 0.522299]),
    ("Cu.McPeak", [0.5816, 0.6747, 0.9731], [1.04628, 0.687323, 0.561775]),
    ("Cu.Querry", [0.4735, 0.6064, 0.9021], [0.971179, 0.609676, 0.452099]),
    ("CuZn", [0.4339, 0.7887, 0.8872], [0.909665, 0.77829, 0.422774]),
    ("CuZn10", [0.4911, 0.745, 0.9036], [0.962621, 0.713327, 0.464044]),
    ("CuZn15", [0.4462, 0.7406, 0.871], [0.91249, 0.714128, 0.419879]),
    ("Fe", [0.4958, 0.5124, 0.5312], [0.529677, 0.513217, 0.494232]),
    ("Fe.Querry", [0.5641, 0.5671, 0.5787], [0.574525, 0.567088, 0.562636]),
    ("Ge", [0.4659, 0.5151, 0.4716], [0.500365, 0.516387, 0.464157]),
    ("Hg", [0.7787, 0.7794, 0.7814], [0.781429, 0.779486, 0.778414]),
    ("In", [0.8525, 0.8531, 0.8609], [0.860575, 0.850863, 0.851632]),
    ("Ir", [0.703, 0.7325, 0.7452], [0.745055, 0.731746, 0.700601]),
    ("K", [0.9229, 0.938, 0.9533], [0.949306, 0.937598, 0.921278]),
    ("Li", [0.8515, 0.9289, 0.9464], [0.946907, 0.927301, 0.844969]),
    ("Mg", [0.8945, 0.8832, 0.8922], [0.892437, 0.881638, 0.893996]),
    ("Mn", [0.5446, 0.5769, 0.604], [0.602608, 0.574454, 0.541005]),
    ("Mo", [0.5803, 0.5749, 0.5852], [0.57162, 0.584621, 0.582899]),
    ("Na", [0.9382, 0.9624, 0.9766], [0.977134, 0.961522, 0.93598]),
    ("Nb", [0.5017, 0.5053, 0.5027], [0.500401, 0.507192, 0.500929]),
    ("Ni", [0.5707, 0.6443, 0.7013], [0.697106, 0.640482, 0.563241]),
    ("NiFe", [0.5829, 0.6279, 0.6572], [0.656609, 0.625877, 0.578762]),
    ("Os", [0.6546, 0.5814, 0.4846], [0.48842, 0.587088, 0.657715]),
    ("Pb", [0.6904, 0.6614, 0.6578], [0.65685, 0.660842, 0.692778]),
    ("Pd", [0.6563, 0.6984, 0.7341], [0.732659, 0.696917, 0.652377]),
    ("Pt", [0.6874, 0.7324, 0.7614], [0.761308, 0.730272, 0.683362]),
    ("Pt.Rakic-BB", [0.5884, 0.6424, 0.6789], [0.678925, 0.639537, 0.583632]),
    ("Rb", [0.7893, 0.8515, 0.8813], [0.880999, 0.851271, 0.778227]),
    ("Rh", [0.7443, 0.7683, 0.7966], [0.797022, 0.764571, 0.742521]),
    ("Si", [0.4194, 0.367, 0.3438], [0.343503, 0.367692, 0.425425]),
    ("StainlessSteel-austenitic", [0.6026, 0.6408, 0.6671], [0.66938, 0.63889, 0.598425]),
    ("StainlessSteel-ferritic", [0.5699, 0.588, 0.6068], [0.604528, 0.586688, 0.567912]),
    ("Ta", [0.4089, 0.3592, 0.4536], [0.389138, 0.360355, 0.412183]),
    ("Ti", [0.5445, 0.5823, 0.6159], [0.618591, 0.579356, 0.542558]),
    ("Ti.Palm", [0.365, 0.4038, 0.4404], [0.440874, 0.400456, 0.361346]),
    ("TiN", [0.1791, 0.4646, 0.7069], [0.74392, 0.427626, 0.155094]),
    ("TiN.Schnabel", [0.1668, 0.4349, 0.6566], [0.670416, 0.408909, 0.149968]),
    ("V", [0.5655, 0.5325, 0.5277], [0.519565, 0.535004, 0.566705]),
    ("V.Palm", [0.4066, 0.4139, 0.4195], [0.418452, 0.413824, 0.405531]),
    ("VN", [0.351, 0.4147, 0.4662], [0.469449, 0.410108, 0.345102]),
    ("W", [0.4685, 0.4962, 0.5173], [0.515887, 0.496276, 0.46742]),
    ("Zn", [0.8567, 0.8694, 0.875], [0.875184, 0.868884, 0.855077]),
    ("Zr", [0.5372, 0.5738, 0.5805], [0.583707, 0.57259, 0.534406]),
    ("Zr.Palm", [0.2766, 0.3071, 0.337], [0.3359, 0.304532, 0.274098]),
];

/// Another form of the exact reflectance: real arithmetic, multiplied out so that nothing divides by the cosine.
fn exact_real(n: f64, k: f64, x: f64) -> f64 {
    let s2 = 1.0 - x * x;
    let t0 = n * n - k * k - s2;
    let ab = (t0 * t0 + 4.0 * n * n * k * k).sqrt();
    let a = (0.5 * (ab + t0)).max(0.0).sqrt();
    let (t1, t2) = (ab + x * x, 2.0 * a * x);
    let rs = (t1 - t2) / (t1 + t2);
    let (t3, t4) = (x * x * ab + s2 * s2, t2 * s2);
    0.5 * rs * (1.0 + (t3 - t4) / (t3 + t4))
}

fn preset(id: &str) -> Preset {
    find(id).unwrap()
}

#[test]
fn the_folder_and_the_library_hold_the_same_presets_under_their_ids() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../presets/metals");
    let mut names: Vec<String> =
        std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    // By id: `Au` comes before `Au.McPeak`, the file `Au.json` after `Au.McPeak.json`.
    names.sort_by_key(|name| name.trim_end_matches(".json").to_string());
    assert_eq!(names, FILES.map(|(name, _)| name));
    assert_eq!(library().len(), FILES.len(), "a file does not parse");
    for (preset, (file, _)) in library().iter().zip(FILES) {
        assert_eq!(format!("{}.json", preset.id), file);
        preset.check(file).unwrap();
    }
    assert_eq!(library().iter().map(|p| p.id.as_str()).collect::<Vec<_>>(), KNOWN.map(|(id, ..)| id));
}

#[test]
fn every_preset_names_its_source_and_covers_the_visible_range() {
    for p in library() {
        let Source { author, year, journal, doi, title, table, licence, other } = &p.source;
        assert!(author.is_some() && title.is_some() && journal.is_some() && table.is_some(), "{}", p.id);
        // The table of tantalum names a handbook only, and stands in a collection that states no licence.
        let known = p.id != "Ta";
        assert_eq!(year.is_some(), known, "{}", p.id);
        assert_eq!(licence.as_deref(), known.then_some("CC0-1.0"), "{}", p.id);
        // Reports and some journals have no identifier, but an address.
        assert_eq!(doi.is_some() || other.contains_key("url"), known, "{}", p.id);
        assert!(known || p.warning.is_some(), "{}", p.id);
        assert_eq!((p.wavelength_nm.first(), p.wavelength_nm.last()), (Some(&380.0), Some(&780.0)), "{}", p.id);
        assert!(p.other.is_empty(), "{} has a misspelt field", p.id);
    }
}

#[test]
fn reflectance_at_three_wavelengths_is_that_of_the_published_tables() {
    for (id, expected, _) in KNOWN {
        for (nm, expected) in [450.0, 550.0, 650.0].into_iter().zip(expected) {
            let found = preset(id).reflectance(nm, 1.0);
            // Half of the last decimal.
            assert!((found - expected).abs() < 5.1e-5, "{id} {nm}: {found} {expected}");
        }
    }
}

#[test]
fn integrated_f0_is_that_of_an_independent_computation() {
    for (id, _, expected) in KNOWN {
        let found = preset(id).unclamped_f0();
        // Half of the sixth digit, and for the red of gold, above 1, of the fifth decimal.
        assert!((found - DVec3::from_array(expected)).abs().max_element() < 6e-6, "{id}: {found}");
    }
}

#[test]
fn the_exact_reflectance_agrees_with_another_form_of_it() {
    for p in library() {
        for i in 0..81 {
            let (n, k) = p.index_at(wavelength_nm(i));
            for x in [0.0, 1e-3, 0.05, 0.1, 1.0 / 7.0, 0.5, 0.9, 1.0] {
                let difference = p.reflectance(wavelength_nm(i), x) - exact_real(n, k, x);
                assert!(difference.abs() < 1e-12, "{} {x}: {difference}", p.id);
            }
        }
    }
}

#[test]
fn the_spectral_curve_runs_from_one_at_grazing_to_f0_within_the_unit_interval() {
    for p in library() {
        let Fresnel::Spectral { table } = p.fresnel(Form::Spectral) else { panic!("another form") };
        assert!((table[0] - Vec3::ONE).abs().max_element() < 1e-6, "{}", p.id);
        assert_eq!(table[TABLE_SIZE - 1], clamped(p.unclamped_f0()), "{}", p.id);
        assert!(table.iter().all(|f| f.min_element() >= 0.0 && f.max_element() <= 1.0), "{}", p.id);
        let middle = clamped(p.unclamped(100.0 / 255.0));
        assert_eq!(table[100], middle, "{}", p.id);
    }
}

#[test]
fn gold_reflects_more_red_than_the_space_holds_and_is_clamped_for_rendering() {
    let gold = preset("Au");
    assert!((gold.unclamped_f0().x - 1.0373).abs() < 1e-5);
    let Fresnel::Rescaled { f0 } = gold.fresnel(Form::Rescaled) else { panic!("another form") };
    assert_eq!(f0.x, 1.0);
    assert!((f0.y - 0.728_376).abs() < 1e-6);
}

#[test]
fn schlick_f0_leaves_the_extinction_out() {
    // ((n - 1) / (n + 1))^2 of silver, n about 0.05, is near 0.82 where the metal reflects 0.98.
    let Fresnel::Schlick { f0 } = preset("Ag").fresnel(Form::Schlick) else { panic!("another form") };
    assert!(f0.max_element() < 0.85 && f0.min_element() > 0.75, "{f0}");
    // With k = 0 nothing is left out.
    let mut glass = preset("Ag");
    glass.n.iter_mut().for_each(|n| *n = 1.5);
    glass.k.iter_mut().for_each(|k| *k = 0.0);
    let Fresnel::Schlick { f0 } = glass.fresnel(Form::Schlick) else { panic!("another form") };
    assert!((f0 - Vec3::splat(0.04)).abs().max_element() < 1e-7, "{f0}");
    assert!((glass.unclamped_f0() - DVec3::splat(0.04)).abs().max_element() < 1e-14);
}

#[test]
fn little_light_lies_outside_of_the_range_that_a_table_must_cover() {
    let (from, to) = REQUIRED_RANGE_NM;
    let outside = rgb::integrate(|nm| if (from..=to).contains(&nm) { 0.0 } else { 1.0 });
    assert!(outside.abs().max_element() < 0.005, "{outside}");
}

#[test]
fn presets_are_found_by_id_name_or_file_and_near_ones_are_named() {
    assert_eq!(preset("Au").id, "Au");
    assert_eq!(preset(" cuzn ").id, "CuZn");
    assert_eq!(preset("tungsten").id, "W");
    let text = |wanted: &str| find(wanted).unwrap_err().to_string();
    assert!(text("StainlessSteel").contains("did you mean StainlessSteel-austenitic or StainlessSteel-ferritic?"));
    assert!(text("golt").contains("did you mean Au?"), "{}", text("golt"));
    assert!(text("unobtainium").contains("there are Ag, Al, Au"), "{}", text("unobtainium"));
    assert!(text("").contains("there are"));
    assert!(text("my-gold.csv").contains("burnish fit FILE --out"), "{}", text("my-gold.csv"));
    assert!(text("missing.json").contains("missing.json: cannot be read"));
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../presets/metals/Ti.json");
    assert_eq!(preset(file), preset("Ti"));
}

#[test]
fn fields_of_other_versions_are_kept() {
    let mut value: Value = serde_json::from_str(FILES[0].1).unwrap();
    value["finish"] = "polished".into();
    value["source"]["pages"] = 10.into();
    let read: Preset = serde_json::from_value(value).unwrap();
    let written = serde_json::to_value(&read).unwrap();
    assert_eq!((&written["finish"], &written["source"]["pages"]), (&"polished".into(), &10.into()));
    assert_eq!(serde_json::from_value::<Preset>(written).unwrap(), read);
}

#[test]
fn a_faulty_file_is_refused_with_file_field_and_remedy() {
    let folder = Folder::new();
    let refuse = |edit: &dyn Fn(&mut Preset)| {
        let mut p = preset("Fe");
        edit(&mut p);
        let path = folder.join("p.json");
        std::fs::write(&path, serde_json::to_string(&p).unwrap()).unwrap();
        let text = Preset::read(&path).unwrap_err().to_string();
        assert!(text.contains("p.json"), "{text}");
        text
    };
    assert!(refuse(&|p| p.format = "gltf".into()).contains("`format` is `gltf`; set it to `burnish-metal`"));
    assert!(refuse(&|p| p.version = 9).contains("`version` is 9"));
    assert!(refuse(&|p| p.id = "../../x".into()).contains("`id`"));
    assert!(refuse(&|p| p.name = " ".into()).contains("`name` is empty"));
    assert!(refuse(&|p| p.k.truncate(3)).contains("`k` has 3 values for 41 wavelengths"));
    assert!(refuse(&|p| p.wavelength_nm[4] = 410.0).contains("`wavelength_nm` is 410 at entry 4, after 410"));
    assert!(refuse(&|p| p.n[2] = 0.0).contains("`n` is 0 at entry 2"));
    assert!(refuse(&|p| p.n[2] = 1e200).contains("at entry 2; give values above 0, at most 1000"));
    assert!(refuse(&|p| p.k[2] = 1e4).contains("`k` is 10000 at entry 2"));
    assert!(refuse(&|p| p.k[2] = -0.5).contains("`k` is -0.5 at entry 2"));
    let short = |p: &mut Preset| {
        p.wavelength_nm.truncate(10);
        p.n.truncate(10);
        p.k.truncate(10);
    };
    assert!(refuse(&short).contains("covers 380 to 470 nm"));
    let empty = |p: &mut Preset| {
        p.wavelength_nm.clear();
        p.n.clear();
        p.k.clear();
    };
    assert!(refuse(&empty).contains("`wavelength_nm`"));

    let path = folder.join("q.json");
    for (text, reason) in
        [("{", "EOF"), ("[1]", "invalid type"), ("{}", "missing field `format`"), ("\u{0}", "expected value")]
    {
        std::fs::write(&path, text).unwrap();
        let message = Preset::read(&path).unwrap_err().to_string();
        assert!(message.contains("q.json") && message.contains(reason) && message.contains("README"), "{message}");
    }
    std::fs::write(&path, [0xff, 0xfe]).unwrap();
    assert!(Preset::read(&path).unwrap_err().to_string().contains("not UTF-8"));
}

#[test]
fn a_table_that_was_not_checked_gives_numbers_and_no_panic() {
    let mut p = preset("Fe");
    p.n.truncate(3);
    p.k.clear();
    assert!(p.unclamped_f0().is_finite());
    p.wavelength_nm.clear();
    assert!(Form::ALL.iter().all(|form| p.fresnel(*form).eval(0.3).is_finite()));
}
