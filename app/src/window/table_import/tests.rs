use super::*;

#[test]
fn rows_of_numbers_are_a_table_and_prose_is_none() {
    for text in [
        "wavelength_nm,n,k\n400,1.4,1.9\n500,0.9,1.8\n700,0.1,4.0\n",
        "0.4 1.4 1.9\n0.5 0.9 1.8\n0.7 0.1 4.0",
        "# gold\n400;1.4\n500;0.9\n\n700;0.1",
        "REFERENCES: none\nDATA:\n  - type: tabulated nk\n",
        " {\"format\": \"burnish-metal\"}",
    ] {
        assert!(looks_like_table(text), "{text}");
    }
    for text in ["", "gold", "400,1.4,1.9\n500,0.9,1.8", "1. first\n2. second\n3. third", "{\"a\": 1}"] {
        assert!(!looks_like_table(text), "{text}");
    }
}

#[test]
fn the_other_half_of_a_table_is_one_file_and_no_other() {
    let text = "wavelength_nm,n,k\n380,1.4,1.9\n550,0.9,1.8\n780,0.1,4.0\n";
    let mut found = optical::parse(text, "eta.spd", &Options::default()).unwrap();
    let origin = Origin::File("/m/eta.spd".into());
    assert_eq!(other_half(&origin, &found), None);
    found.report.other = Some("k.spd".into());
    let half = other_half(&origin, &found).unwrap();
    assert_eq!(half, Origin::File("/m/k.spd".into()));
    for stays in ["/m/Ag.spd", "/m/iron.spd", "/m/n.spd", "/o/k.spd", "/m/k.txt"] {
        assert_ne!(half, Origin::File(stays.into()), "{stays}");
    }
    assert_eq!(other_half(&Origin::Text(text.into()), &found), None);
}

#[test]
fn a_table_is_opened_once_and_the_next_after_it() {
    let mut import = TableImport::default();
    for name in ["a.csv", "b.csv", "a.csv"] {
        import.open(Origin::File(name.into()));
    }
    assert_eq!(import.waiting.len(), 2);
    assert!(import.is_busy());
}
