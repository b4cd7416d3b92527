//! A Python process that renders with Mitsuba.

use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use burnish_core::export::mitsuba::{self, Options, View};
use burnish_core::scene::Scene;
use burnish_tests::{mitsuba_python, scratch_folder};
use glam::{UVec2, Vec3};
use serde_json::{Value, json};

/// Ends with the process when dropped.
pub struct Server {
    child: Child,
    requests: ChildStdin,
    answers: BufReader<ChildStdout>,
    folder: PathBuf,
    size: UVec2,
}

impl Server {
    /// Starts it; `name` is that of its folder, unique among all tests.
    pub fn start(name: &str) -> Server {
        let python = mitsuba_python().expect("a Python with mitsuba");
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/external/oracle/driver.py");
        let mut command = Command::new(python);
        command.arg(script).stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.spawn().expect("Python starts");
        let requests = child.stdin.take().expect("its input");
        let answers = BufReader::new(child.stdout.take().expect("its output"));
        Server { child, requests, answers, folder: scratch_folder(name), size: UVec2::ZERO }
    }

    fn ask(&mut self, request: &Value) -> Value {
        writeln!(self.requests, "{request}").expect("Python listens");
        let mut line = String::new();
        self.answers.read_line(&mut line).expect("Python answers");
        let answer: Value = serde_json::from_str(&line).unwrap_or_else(|e| panic!("{request}: {e}: {line}"));
        assert!(answer.get("error").is_none(), "{request}: {answer}");
        answer
    }

    /// Exports a scene and reads it in.
    pub fn load(&mut self, scene: &Scene, view: &View<'_>, variant: &str) {
        let options = Options { spectral: false, metal: &|_| None };
        let report = mitsuba::export(scene, view, &options, &self.folder).expect("the scene is exported");
        for note in &report.notes {
            // What is told of these is matched by the settings, or cannot be seen.
            let harmless = ["rough metals", "backs of one-sided surfaces"].contains(&note.element.as_str())
                || note.what.contains("between texels");
            assert!(harmless, "{}: {}", note.element, note.what);
        }
        self.size = view.size;
        let file = self.folder.join(mitsuba::MAIN);
        self.ask(&json!({"load": file, "variant": variant}));
    }

    /// A picture, rows from the top, and the seconds that it took.
    pub fn render(&mut self, samples: u32, seed: u32) -> (Vec<Vec3>, f64) {
        let out = self.folder.join("picture.raw");
        let answer = self.ask(&json!({"render": samples, "seed": seed, "out": out}));
        let picture = colors(&out);
        assert_eq!(picture.len() as u32, self.size.element_product());
        (picture, answer["seconds"].as_f64().expect("seconds"))
    }

    /// Radiance of the environment from directions.
    pub fn environment(&mut self, directions: &[Vec3]) -> Vec<Vec3> {
        let (asked, out) = (self.folder.join("directions.raw"), self.folder.join("radiance.raw"));
        let bytes: Vec<u8> = directions.iter().flat_map(|d| d.to_array()).flat_map(f32::to_le_bytes).collect();
        std::fs::write(&asked, bytes).expect("a writable folder");
        self.ask(&json!({"emitter": asked, "out": out}));
        colors(&out)
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn colors(file: &Path) -> Vec<Vec3> {
    let bytes = std::fs::read(file).expect("floats");
    let numbers: Vec<f32> = bytes.as_chunks::<4>().0.iter().map(|b| f32::from_le_bytes(*b)).collect();
    numbers.as_chunks::<3>().0.iter().map(|rgb| Vec3::from_array(*rgb)).collect()
}
