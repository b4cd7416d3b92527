//! The classical method against the integrals that it stands for, through the command that users run.

use std::ffi::OsString;
use std::path::PathBuf;

use burnish_tests::{Need, data_folder, trial};
use libtest_mimic::Arguments;

/// Mean |a - b| / mean b of a prefiltered level: what 128 to 2048 samples a texel leave (figures in the method's page).
const PREFILTERED: f64 = 0.02;
/// The same of a ball at 256 samples a pixel, one frame.
const SAMPLED: f64 = 0.03;

fn main() {
    let mut arguments = Arguments::from_args();
    // Each rasterises on all processors by itself.
    arguments.test_threads.get_or_insert(1);
    let both = &[Need::Gpu, Need::Data];
    let trials = vec![
        trial("levels of the studio hold their integral", &[Need::Gpu], || prefiltered(&[])),
        trial("levels of foreign maps hold their integral", both, || {
            prefiltered(&["studio_small_03_1k.hdr", "royal_esplanade_1k.hdr", "spiaggia_di_mondello_1k.hdr"]);
        }),
        trial("256 samples reach the exact reflection of the studio", &[Need::Gpu], || sampled(&[])),
        trial("256 samples reach the exact reflection of foreign studios", both, || {
            sampled(&["studio_small_03_1k.hdr", "blender-studio.exr"]);
        }),
    ];
    libtest_mimic::run(&arguments, trials).exit();
}

fn prefiltered(maps: &[&str]) {
    let rows = measure("prefilter", maps, &["--texels", "100"]);
    for row in rows.iter().filter(|row| row.roughness >= 0.1) {
        assert!(row.error <= PREFILTERED, "{row:?} is over {PREFILTERED}");
    }
}

fn sampled(maps: &[&str]) {
    let rows = measure("classical", maps, &["--samples", "256", "--pixels", "16", "--roughness", "0.1,0.2,0.3,0.6,1"]);
    for row in &rows {
        assert!(row.error <= SAMPLED, "{row:?} is over {SAMPLED}");
    }
}

#[derive(Debug)]
#[allow(dead_code, reason = "shown by a failure")]
struct Row {
    environment: String,
    roughness: f64,
    error: f64,
}

/// Runs the command and reads its rows; at least five a map.
fn measure(what: &str, maps: &[&str], more: &[&str]) -> Vec<Row> {
    let mut args: Vec<OsString> = ["measure", what, "--json"].iter().chain(more).map(OsString::from).collect();
    for map in maps {
        let folder: PathBuf = data_folder().expect("the need was checked");
        args.extend(["--env".into(), folder.join("hdri").join(map).into_os_string()]);
    }
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let exit = burnish::run(args, &mut out, &mut err);
    assert_eq!(exit, 0, "{}", String::from_utf8_lossy(&err));
    let json: serde_json::Value = serde_json::from_slice(&out).expect("JSON");
    let rows = json.as_array().expect("a list").iter().map(|row| Row {
        environment: row["environment"].to_string(),
        roughness: row["roughness"].as_f64().expect("a number"),
        error: row["error"].as_f64().expect("a number"),
    });
    let rows: Vec<Row> = rows.collect();
    assert!(rows.len() >= 5 * maps.len().max(1), "only {} rows", rows.len());
    rows
}
