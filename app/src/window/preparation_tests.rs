use super::*;
use burnish_core::lighting::{Coverage, MethodInfo, impostor};
use burnish_core::scene::gallery;
use glam::Vec3;

/// Counts lamps, unless there are none.
#[derive(Debug)]
struct Lamps;

static INFO: MethodInfo = MethodInfo {
    id: MethodId("lamps"),
    title: "Lamps",
    summary: "",
    params: &[],
    coverage: Coverage::NONE,
    reads: Reads { lights: true, ..Reads::NOTHING },
    revision: 1,
};

impl Method for Lamps {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }

    fn prepare(&self, world: &World, _: &Settings, _: &Handle) -> Result<Prepared, MethodError> {
        match world.scene().lights.len() {
            0 => Err(MethodError::Unfit("no lamps".into())),
            count => Ok(Prepared::nothing().with("count", vec![count as u32])),
        }
    }
}

/// Follows a scene until no thread works on it.
fn settle(preparation: &mut Preparation, scene: &Arc<Scene>) -> State {
    let ctx = egui::Context::default();
    loop {
        preparation.follow(&Lamps, Settings::new(INFO.params), scene, &ctx);
        if !preparation.is_busy() {
            return preparation.state();
        }
        std::thread::yield_now();
    }
}

#[test]
fn what_took_long_is_used_while_stale_and_made_again_on_demand() {
    let scene = Arc::new(gallery::open("workbench").unwrap());
    let mut preparation = Preparation { quick: Duration::ZERO, ..Preparation::default() };
    assert_eq!(settle(&mut preparation, &scene), State::Fresh);
    let first = preparation.prepared(&Lamps).unwrap();
    // An edit of what is not read.
    let mut edited = Scene::clone(&scene);
    edited.materials[0].roughness = 0.9;
    let edited = Arc::new(edited);
    assert_eq!(settle(&mut preparation, &edited), State::Fresh);
    assert!(Arc::ptr_eq(&first, &preparation.prepared(&Lamps).unwrap()));
    // And of what is.
    let mut brighter = Scene::clone(&edited);
    brighter.lights[0].intensity *= 2.0;
    let brighter = Arc::new(brighter);
    assert_eq!(settle(&mut preparation, &brighter), State::Stale);
    assert!(Arc::ptr_eq(&first, &preparation.prepared(&Lamps).unwrap()));
    preparation.again(&egui::Context::default());
    assert_eq!(settle(&mut preparation, &brighter), State::Fresh);
    assert!(!Arc::ptr_eq(&first, &preparation.prepared(&Lamps).unwrap()));
    // Back again: stale, not lost.
    assert_eq!(settle(&mut preparation, &scene), State::Stale);
    let mut preparation = preparation.always_anew();
    assert_eq!(settle(&mut preparation, &brighter), State::Fresh);
    assert_eq!(settle(&mut preparation, &scene), State::Fresh, "it took too long, and is made all the same");
    // Another method has none of it, and always the same nothing.
    let nothing = || preparation.prepared(&burnish_core::reference::Reference).unwrap();
    assert!(nothing().is_nothing() && Arc::ptr_eq(&nothing(), &nothing()));
}

/// Counts lamps; a draft says that there is one.
#[derive(Debug)]
struct Drafting;

impl Method for Drafting {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }

    fn prepare(&self, world: &World, settings: &Settings, job: &Handle) -> Result<Prepared, MethodError> {
        Lamps.prepare(world, settings, job)
    }

    fn drafts(&self) -> bool {
        true
    }

    fn draft(&self, _: &World, _: &Settings, _: &Handle) -> Result<Prepared, MethodError> {
        Ok(Prepared::nothing().with("count", vec![1_u32]))
    }
}

#[test]
fn a_draft_comes_first_and_the_whole_when_the_scene_rests() {
    let ctx = egui::Context::default();
    let mut scene = gallery::open("workbench").unwrap();
    scene.lights.push(scene.lights[0].clone());
    scene.lights.push(scene.lights[0].clone());
    let (scene, mut preparation) = (Arc::new(scene), Preparation::default());
    let count = |preparation: &Preparation| preparation.prepared(&Drafting).map(|prepared| prepared.whole("count")[0]);
    let until = |preparation: &mut Preparation, scene: &Arc<Scene>, state: State| {
        while preparation.state() != state {
            preparation.follow(&Drafting, Settings::new(INFO.params), scene, &ctx);
            std::thread::yield_now();
        }
    };
    until(&mut preparation, &scene, State::Draft);
    assert!(count(&preparation) == Some(1) && preparation.is_busy(), "the whole is still to come");
    let held = preparation.prepared(&Drafting).unwrap();
    // An edit of what is not read leaves the draft in use.
    let mut edited = Scene::clone(&scene);
    edited.materials[0].roughness = 0.9;
    let edited = Arc::new(edited);
    preparation.follow(&Drafting, Settings::new(INFO.params), &edited, &ctx);
    until(&mut preparation, &edited, State::Draft);
    assert!(Arc::ptr_eq(&held, &preparation.prepared(&Drafting).unwrap()));
    until(&mut preparation, &edited, State::Fresh);
    assert!(count(&preparation) >= Some(3) && !preparation.is_busy());
    // Sides of a comparison show no drafts.
    let mut always = Preparation::default().always_anew();
    until(&mut always, &scene, State::Fresh);
    assert!(count(&always) >= Some(3));
}

/// Reads lamps and materials, and stays in use when the latter change.
#[derive(Debug)]
struct Lasting;

static LASTING: MethodInfo = MethodInfo {
    id: MethodId("lasting"),
    title: "Lasting",
    summary: "",
    params: &[],
    coverage: Coverage::NONE,
    reads: Reads { lights: true, materials: true, ..Reads::NOTHING },
    revision: 1,
};

impl Method for Lasting {
    fn info(&self) -> &'static MethodInfo {
        &LASTING
    }

    fn prepare(&self, world: &World, settings: &Settings, job: &Handle) -> Result<Prepared, MethodError> {
        Lamps.prepare(world, settings, job)
    }

    fn drafts(&self) -> bool {
        true
    }

    fn draft(&self, _: &World, _: &Settings, _: &Handle) -> Result<Prepared, MethodError> {
        Ok(Prepared::nothing().with("count", vec![77_u32]))
    }

    fn outlives(&self) -> Reads {
        Reads { materials: true, ..Reads::NOTHING }
    }

    fn age(&self, then: &World, now: &World, _: &Settings) -> Option<f32> {
        Some(now.scene().materials[0].roughness - then.scene().materials[0].roughness)
    }
}

#[test]
fn what_outlives_an_edit_stays_in_use_until_another_is_there() {
    let ctx = egui::Context::default();
    let mut scene = gallery::open("workbench").unwrap();
    scene.materials[0].roughness = 0.25;
    let (scene, mut preparation) = (Arc::new(scene), Preparation::default());
    let until = |preparation: &mut Preparation, scene: &Arc<Scene>, is: &dyn Fn(State) -> bool| {
        while !is(preparation.state()) {
            preparation.follow(&Lasting, Settings::new(LASTING.params), scene, &ctx);
            std::thread::yield_now();
        }
    };
    let is_fresh = |state: State| state == State::Fresh;
    until(&mut preparation, &scene, &is_fresh);
    let first = preparation.prepared(&Lasting).unwrap();
    let mut edited = Scene::clone(&scene);
    edited.materials[0].roughness = 0.75;
    let edited = Arc::new(edited);
    until(&mut preparation, &edited, &|state| state == State::Aged(Some(0.5)));
    // No draft takes its place.
    assert!(Arc::ptr_eq(&first, &preparation.prepared(&Lasting).unwrap()));
    until(&mut preparation, &edited, &is_fresh);
    let second = preparation.prepared(&Lasting).unwrap();
    assert!(!Arc::ptr_eq(&first, &second) && second.whole("count") == first.whole("count"));
    // Lamps are another thing.
    let mut brighter = Scene::clone(&edited);
    brighter.lights[0].intensity *= 2.0;
    let brighter = Arc::new(brighter);
    until(&mut preparation, &brighter, &|state| state == State::Draft);
    assert_eq!(preparation.prepared(&Lasting).unwrap().whole("count"), [77]);
}

#[test]
fn what_is_quick_follows_every_edit_and_a_fault_is_told() {
    let mut preparation = Preparation { quick: Duration::MAX, ..Preparation::default() };
    let mut scene = gallery::open("workbench").unwrap();
    assert_eq!(settle(&mut preparation, &Arc::new(scene.clone())), State::Fresh);
    scene.lights[0].intensity *= 2.0;
    assert_eq!(settle(&mut preparation, &Arc::new(scene.clone())), State::Fresh);
    scene.lights.clear();
    assert_eq!(settle(&mut preparation, &Arc::new(scene)), State::Stale);
    assert_eq!(preparation.fault(), Some("no lamps"));
}

/// Draws even light.
#[derive(Debug)]
struct Even;

impl Raster for Even {
    fn faces(&self, _: &World, _: Vec3, edge: u32, _: &Handle) -> Result<Vec<Vec3>, MethodError> {
        Ok(vec![Vec3::splat(3.0); 6 * (edge * edge) as usize])
    }
}

#[test]
fn drafts_are_drawn_by_whom_the_window_names() {
    let (scene, ctx) = (Arc::new(gallery::open("room").unwrap()), egui::Context::default());
    let settings = || {
        let mut settings = Settings::new(impostor::PARAMS);
        settings.set("resolution", "16").unwrap();
        settings
    };
    let irradiance = |raster: Option<Arc<dyn Raster>>| {
        let mut preparation = Preparation::default();
        preparation.draw_probes_by(raster);
        let start = Instant::now();
        while preparation.state() != State::Draft {
            assert!(start.elapsed().as_secs() < 60, "{:?}", preparation.state());
            preparation.follow(&impostor::Impostor, settings(), &scene, &ctx);
            std::thread::yield_now();
        }
        preparation.held.as_ref().unwrap().prepared.parts()[0].halves("irradiance")[0].to_f32()
    };
    let even = 3.0 * std::f32::consts::PI;
    assert!((irradiance(Some(Arc::new(Even))) / even - 1.0).abs() < 2e-3);
    assert!((irradiance(None) / even - 1.0).abs() > 0.1);
}
