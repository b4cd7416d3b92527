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
fn two_halves_of_a_table_are_one() {
    let halves = |a: &str, b: &str| are_halves(Path::new(a), Path::new(b));
    assert!(halves("/m/Au.eta.spd", "/m/Au.k.spd") && halves("/m/metal-Au-n.txt", "/m/metal-Au-k.txt"));
    assert!(!halves("/m/Au.eta.spd", "/m/Ag.k.spd") && !halves("/m/Au.eta.spd", "/o/Au.k.spd"));
    assert!(!halves("/m/Au.eta.spd", "/m/Au.k.txt"));
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
