//! Each reason for which a table is refused, with its line and remedy.

use super::*;

#[track_caller]
fn refused(text: &str, words: &[&str]) {
    let error = plain(text).expect_err(text).to_string();
    for word in words {
        assert!(error.contains(word), "`{word}` is missing in: {error}");
    }
    assert!(error.starts_with("Au.csv: "), "{error}");
    assert!(error.lines().all(|line| line.contains("; ") || line.starts_with("and ")), "no remedy in: {error}");
}

/// Rows that are sound but for one.
fn with(row: &str) -> String {
    format!("wl_nm,n,k\n380,1,2\n400,1,2\n{row}\n600,1,2\n700,1,2\n780,1,2\n")
}

#[test]
fn a_row_with_a_wrong_number_is_named_with_its_line_and_column() {
    assert!(plain(&with("500,1,2")).is_ok());
    refused(&with("500,one,2"), &["line 4: column 2: 'one' is not a number", "correct the row"]);
    refused(&with("500,nan,2"), &["line 4: column 2: 'nan' is not a finite number"]);
    refused(&with("500,1,1e999"), &["line 4: column 3", "finite"]);
    refused(&with("500,1,-inf"), &["line 4: column 3", "finite"]);
    refused(&with("500,,2"), &["line 4: column 2: is empty"]);
    refused(&with("500,1"), &["line 4: has 2 columns where 3 are expected", "decimal commas"]);
    refused(&with("500,1,2,3"), &["line 4: has 4 columns where 3"]);
    refused(&with("500,0,2"), &["line 4: n is 0; n of a metal is above 0"]);
    refused(&with("500,-1,2"), &["line 4: n is -1"]);
    refused(&with("500,1,-0.1"), &["line 4: k is -0.1; the index is n + ik"]);
    refused(&with("0,1,2"), &["line 4: the first column is 0"]);
    refused(&with("-500,1,2"), &["line 4: the first column is -500"]);
    refused(&with("and so on"), &["line 4: 'and so on' is no row of numbers", "begin remarks with #"]);
    refused(&with("5OO,1,2"), &["line 4: column 1: '5OO' is not a number"]);
}

#[test]
fn rows_out_of_order_are_named() {
    refused(&with("400,1,2"), &["line 4: repeats 400", "keep one of the two"]);
    refused(&with("390,1,2"), &["line 4: steps back from 400 to 390", "sort the rows"]);
    refused("780 1 2\n700 1 2\n720 1 2\n500 1 2\n380 1 2\n", &["line 3: steps forward from 700 to 720"]);
    assert_eq!(plain(&with("390,1,2")).unwrap_err().faults.len(), 1, "said once for n and k");
    refused(&gold(|w, n, k| format!("{w} {n} {k}")).repeat(2), &["line 15: steps back from 0.756 to 0.3679"]);
}

#[test]
fn a_range_that_does_not_fit_is_refused_with_the_unit_that_would_fit() {
    refused("800 1 2\n900 1 2\n", &["covers 800 to 900 nm, nothing of the visible range", "take a table"]);
    refused("410 1 2\n780 1 2\n", &["covers 410 to 780 nm; 400 to 700 nm are needed"]);
    refused("3800 1 2\n5000 1 2\n7800 1 2\n", &["nothing of the visible range", "--unit A"]);
    refused("wl_um n k\n380 1 2\n500 1 2\n780 1 2\n", &["if the unit is wrong, say --unit nm"]);
    refused("300 1 2\n550 1 2\n800 1 2\n", &["has 1 point from 380 to 780 nm"]);
    refused("500 1 2\n", &["holds n and k at 1 wavelength"]);
    refused("20 1 2\n500 1 2\n780 1 2\n", &["names no unit", "20 to 780", "--unit nm|um|A|eV"]);
    refused("wl,n\n0.3,1\n0.4,1\nwl,k\n0.5,1\n0.8,1\n", &["no wavelength in common"]);
}

#[test]
fn columns_that_are_missing_or_not_understood_are_told() {
    refused("", &["holds no rows of numbers"]);
    refused("# nothing\n\n", &["holds no rows"]);
    refused("wl,n,k\n", &["holds no rows"]);
    refused("Dear reader,\nno numbers here\n", &["holds no rows"]);
    refused("wl,n\n0.4,1\n0.7,1\n", &["has no column for k", "Au.eta.spd and Au.k.spd"]);
    refused("wl,k\n0.4,1\n0.7,1\n", &["has no column for n"]);
    refused("0.4 1\n0.7 1\n", &["two columns: n or k is missing"]);
    refused("400\n500\n", &["line 1: has 1 column and no header"]);
    refused("400 1 2 3\n500 1 2 3\n", &["line 1: has 4 columns and no header", "name the columns"]);
    refused("wl,T\n0.4,1\n0.7,1\n", &["has two columns"]);
    refused("wl,R,T\n0.4,1,2\n0.7,1,2\n", &["line 1: names no column for n or k"]);
    refused("wl,n,n,k\n0.4,1,2,3\n", &["line 1: names 2 columns for n"]);
    refused("x,y,z\n0.4,1,2\n0.7,1,2\n", &["line 1: the header 'x y z' is not understood"]);
    refused("wavenumber_cm-1,n,k\n20000,1,2\n", &["line 1: the first column is in a unit that is not read", "convert"]);
    refused("wl_nm,n\n400,1\nwl_um,k\n0.4,1\n", &["line 3: 'wl_um' is in um, the block above in nm"]);
}

#[test]
fn decimal_commas_between_commas_are_not_misread() {
    refused("380,5,1,46,1,95\n390,5,1,46,1,95\n", &["line 1: has 6 columns and no header"]);
    refused("wl,n,k\n0,38,1,46,1,95\n", &["line 2: has 6 columns where 3", "semicolon or a tab"]);
    refused("380,5 1,46 1,95\n", &["line 1: has 4 columns"]);
    refused("380;1,46;1.95\n", &["line 1: column 3", "another decimal sign"]);
}

#[test]
fn all_faults_are_told_together_up_to_ten() {
    let text = with("500,1,x").replace("600,1,2", "600,-1,2").replace("700,1,2", "700,1,2,3");
    let error = plain(&text).unwrap_err();
    assert_eq!(error.faults.iter().map(|f| f.line).collect::<Vec<_>>(), [Some(4), Some(5), Some(6)]);
    let many: String = (0..30).map(|i| format!("{} 1 x\n", 400 + i)).collect();
    let error = plain(&many).unwrap_err();
    assert_eq!((error.faults.len(), error.omitted), (10, 20));
    assert!(error.to_string().ends_with("\nand 20 more faults"), "{error}");
}

#[test]
fn limits_are_named() {
    refused(&format!("400 1 {}\n", "2".repeat(MAX_LINE_CHARS)), &["line 1: has more than 10000 characters"]);
    let text = format!("REFERENCES: |\n    {}\nDATA:\n", "\u{e9}".repeat(MAX_LINE_CHARS));
    refused(&text, &["line 2: has more than 10000 characters", "break long texts"]);
    let rows: String = (0..=MAX_ROWS).map(|i| format!("{i} 1 2\n")).collect();
    refused(&rows, &["more than 200000 rows", "thin the table out"]);
    let fine: String = (0..50_010).map(|i| format!("{} 1 2\n", 350.0 + 0.01 * f64::from(i))).collect();
    refused(&fine, &["has 50010 entries from 300 to 1000 nm", "thin the table out"]);
    refused(&" ".repeat(MAX_BYTES + 1), &["over the limit of 16777216"]);
}

#[test]
fn what_is_no_text_is_named() {
    assert_eq!(decode(b"\x89PNG\r\n\x1a\n12"), Err("a PNG picture"));
    assert_eq!(decode(b"PK\x03\x04 a workbook"), Err("a ZIP archive"));
    assert_eq!(decode(b"\xff\xfe1\0"), Err("UTF-16 text"));
    assert_eq!(decode(&[b"400 1 2\n".repeat(40), vec![0]].concat()), Err("binary data"));
    assert_eq!(decode(b"wl (\xb5m)"), Ok(("wl (\u{b5}m)".into(), false)));
    assert_eq!(decode("wl (\u{b5}m)".as_bytes()), Ok(("wl (\u{b5}m)".into(), true)));
}
