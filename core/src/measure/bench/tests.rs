//! The bench with a method of its own: a picture that is wrong by a known factor.

use std::sync::Arc;

use glam::{UVec2, Vec3};

use super::*;
use crate::file::testing::Folder;
use crate::lighting::Reads;
use crate::lighting::method::{self, Cover, Coverage, Method, MethodInfo, Sweep};
use crate::param::{Affects, ParamKind, ParamSpec, ParamValue};
use crate::reference::{self, Control, PARAMS};
use crate::scene::gallery;

/// Shows the truth times its setting.
#[derive(Debug)]
struct Wrong;

static INFO: MethodInfo = MethodInfo {
    id: MethodId("wrong"),
    title: "Wrong",
    summary: "The truth, too bright.",
    params: &[ParamSpec {
        key: "factor",
        label: "Factor",
        unit: "",
        kind: ParamKind::Number { min: 1.0, max: 4.0, default: 1.0 },
        help: "How much too bright.",
        affects: Affects::Frame,
    }],
    coverage: Coverage {
        lamps: Cover::Approximate,
        environment: Cover::Approximate,
        indirect_diffuse: Cover::Approximate,
        indirect_glossy: Cover::Approximate,
        emission: Cover::Exact,
    },
    reads: Reads::NOTHING,
    revision: 1,
};

impl Method for Wrong {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }
}

struct WrongTimer {
    truth: Picture,
    opened: Arc<std::sync::atomic::AtomicUsize>,
}

struct WrongFrames(Picture);

type Timers = Vec<(MethodId, Box<dyn FrameTimer>)>;

impl FrameTimer for WrongTimer {
    fn open(&mut self, _: &Shot, settings: &Settings) -> Result<Box<dyn Frames>, BenchError> {
        self.opened.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        let Some(ParamValue::Number(factor)) = settings.get("factor") else { panic!("declared") };
        let mut picture = self.truth.clone();
        picture.texels.iter_mut().for_each(|t| *t = (factor as f32 * t.truncate()).extend(1.0));
        Ok(Box::new(WrongFrames(picture)))
    }
}

impl Frames for WrongFrames {
    fn preparation(&self) -> Preparation {
        Preparation { secs: 0.25, bytes: Some(1000) }
    }

    fn frame(&mut self) -> Result<f64, BenchError> {
        Ok(0.5)
    }

    fn picture(&mut self) -> Result<Picture, BenchError> {
        Ok(self.0.clone())
    }
}

/// Of the truth: enough that its noise is below that of a few paths.
const PATHS: u32 = 256;

fn shot() -> Shot {
    let mut scene = gallery::open("workbench").unwrap();
    scene.environment.get_or_insert_with(|| Arc::new(gallery::studio()));
    scene.subject = vec![0];
    let camera = scene.cameras[0].clone();
    let metals = BTreeMap::new();
    Shot {
        name: "a, \"b\"".into(),
        scene: Arc::new(scene),
        camera,
        size: UVec2::new(24, 16),
        exposure_ev: 0.0,
        compared_frames: COMPARED_FRAMES,
        metals,
    }
}

fn truth(shot: &Shot, cache: &Cache) -> Truth {
    Truth::trace(shot, &Settings::new(PARAMS), PATHS, cache, &Control::default()).unwrap()
}

/// Measures `wrong` and the reference with a list that has both.
fn records(cache: &Cache, sweeps: &[&str]) -> (Vec<Record>, usize) {
    let (shot, opened) = (shot(), Arc::new(std::sync::atomic::AtomicUsize::new(0)));
    let truth = truth(&shot, cache);
    let methods: &[&dyn Method] = &[&reference::Reference, &Wrong];
    let sweeps: Vec<Sweep> = sweeps.iter().map(|text| text.parse().unwrap()).collect();
    method::check_sweeps(methods, &sweeps).unwrap();
    let candidates: Vec<Candidate> = methods
        .iter()
        .flat_map(|m| method::combinations(*m, &sweeps).unwrap().into_iter().map(|s| (m.info().id, s)))
        .map(|(method, settings)| Candidate { method, settings })
        .collect();
    let (picture, count) = (truth.picture.clone(), opened.clone());
    let mut rig = Rig::new("test", move || {
        let wrong = WrongTimer { truth: picture.clone(), opened: count.clone() };
        let paths = Box::new(PathTimer::default());
        let timers: Timers = vec![(MethodId(reference::ID), paths), (MethodId("wrong"), Box::new(wrong))];
        Ok(Tools { timers, calibrate: Box::new(|| Ok(0.125)) })
    });
    let mut told = vec![None; candidates.len()];
    let mut hear = |news: News<'_>| {
        if let News::Done(place, record) = news {
            assert!(told[place].replace(record.clone()).is_none(), "each is told once");
        }
        Ok(())
    };
    let records = measure(&shot, &truth, &candidates, &mut rig, cache, &mut hear).unwrap();
    assert_eq!(told.into_iter().flatten().collect::<Vec<_>>(), records);
    let opened = opened.load(std::sync::atomic::Ordering::Relaxed);
    assert_eq!(rig.is_open(), opened > 0, "tools are made where something must be drawn, and only there");
    (records, opened)
}

#[test]
fn a_method_from_outside_is_measured_beside_the_reference() {
    let (records, _) = records(&Cache::none(), &["factor=1,2", "samples=1,4"]);
    let name = |r: &Record| (r.method.clone(), r.settings_text());
    assert_eq!(records.len(), 4);
    assert!(name(&records[0]).0 == "reference" && name(&records[0]).1.starts_with("samples=1 "));
    assert_eq!(name(&records[3]), ("wrong".into(), "factor=2".into()));
    // The truth itself has no error; that is under every floor, which says so.
    let exact = records[2].of(Region::Frame).unwrap();
    assert_eq!(exact.0.relmse, 0.0);
    assert!(exact.1.relmse > 0.0 && records[2].is_under_floor() && !records[3].is_under_floor());
    assert!((records[3].of(Region::Subject).unwrap().0.bias - 1.0).abs() < 1e-6);
    assert_eq!((records[3].ratio(), records[3].prepare_secs, records[3].bytes), (4.0, 0.25, Some(1000)));
    // More paths cost more and err less.
    let error = |r: &Record| r.of(Region::Frame).unwrap().0.relmse;
    assert!(error(&records[1]) < error(&records[0]), "{} {}", error(&records[1]), error(&records[0]));
}

#[test]
fn errors_are_bit_identical_from_run_to_run_and_kept_records_are_not_measured_again() {
    let folder = Folder::new();
    let cache = Cache::within(&folder.join("cache"));
    let (first, opened) = records(&cache, &["samples=1", "factor=1,3"]);
    assert_eq!(opened, 2);
    let (again, opened) = records(&cache, &["samples=1", "factor=1,3"]);
    assert_eq!((&first, opened), (&again, 0));
    // One more setting measures that alone.
    assert_eq!(records(&cache, &["samples=1", "factor=1,3,4"]).1, 1);
    let (fresh, opened) = records(&cache.fresh(), &["samples=1", "factor=1,3"]);
    assert_eq!(opened, 2);
    for (a, b) in first.iter().zip(&fresh) {
        assert_eq!((&a.errors, &a.floors), (&b.errors, &b.floors));
    }
}

#[test]
fn settings_of_the_truth_are_told_and_part_of_what_is_kept() {
    let folder = Folder::new();
    let (cache, shot) = (Cache::within(&folder.join("cache")), shot());
    let with = |bounces: &str| {
        let mut settings = Settings::new(PARAMS);
        settings.set("bounces", bounces).unwrap();
        Truth::trace(&shot, &settings, 2, &cache, &Control::default()).unwrap()
    };
    let [usual, direct, again] = [with("64"), with("1"), with("1")];
    assert_eq!((usual.settings.len(), direct.settings.as_slice()), (0, &[("bounces".into(), "1".into())][..]));
    assert!(usual.key != direct.key && direct.key == again.key);
    assert!(usual.picture.texels != direct.picture.texels && direct.picture.texels == again.picture.texels);
}

#[test]
fn the_regions_are_parts_of_each_other() {
    let truth = truth(&shot(), &Cache::none());
    let [frame, subject, interior] = &truth.masks;
    let count = |mask: &[bool]| mask.iter().filter(|on| **on).count();
    assert_eq!(count(frame), 24 * 16);
    assert!(count(interior) < count(subject) && count(subject) < count(frame) && count(subject) > 10);
    assert!((0..frame.len()).all(|i| !interior[i] || subject[i]));
    assert_eq!(truth.samples, PATHS);
    assert!(truth.picture.texels.iter().any(|t| t.truncate() != Vec3::ZERO));
}

#[test]
fn tables_have_a_cell_for_every_column() {
    let (records, _) = records(&Cache::none(), &["samples=1"]);
    let text = csv(&records);
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 1 + records.len());
    assert!(lines[1].starts_with("\"a, \"\"b\"\"\",reference,samples=1 "), "{}", lines[1]);
    let columns = lines[0].split(',').count();
    assert_eq!(columns, COLUMNS.len() + 36);
    // The quoted name has one comma of its own.
    assert!(lines[1..].iter().all(|line| line.split(',').count() == columns + 1));
}

#[test]
fn a_method_that_nothing_draws_is_told() {
    let shot = shot();
    let truth = truth(&shot, &Cache::none());
    let candidate = Candidate { method: MethodId("wrong"), settings: Settings::new(INFO.params) };
    let mut rig = Rig::new("", || Ok(Tools { timers: Vec::new(), calibrate: Box::new(|| Ok(1.0)) }));
    let error = measure(&shot, &truth, &[candidate], &mut rig, &Cache::none(), &mut |_| Ok(())).unwrap_err();
    assert!(error.to_string().contains("wrong"), "{error}");
}
