//! The viewport against the renderer: whatever changed in between, both show the same scene.

use std::sync::Arc;

use burnish_core::color::tone::{ToneMap, exposure_factor, tone_map};
use burnish_core::lighting::classical::PARAMS;
use burnish_core::material::{AlphaMode, Material, Reflectance, preset};
use burnish_core::measure::view::{DisplayMode, displayed};
use burnish_core::param::Settings;
use burnish_core::picture::Picture;
use burnish_core::reference::Contribution;
use burnish_core::scene::gallery::shape;
use burnish_core::scene::{Environment, Image, LightKind, Scene, Texels};
use burnish_core::surface::fresnel::Form;
use burnish_render::readback::read_texture;
use burnish_render::{Drawn, Frame, Gpu, Passes, RenderError, Renderer, View, Viewport};
use burnish_tests::{Need, scenes, trial};
use glam::{Affine3A, UVec2, Vec2, Vec3};
use libtest_mimic::Trial;

const SIZE: UVec2 = UVec2::new(90, 60);
/// Frames of a settled picture.
const FRAMES: u32 = 16;
const TONE: ToneMap = ToneMap::AgX;
const EXPOSURE: f32 = -0.5;

pub fn trials() -> Vec<Trial> {
    let gpu: &[Need] = &[Need::Gpu];
    vec![
        trial("after any change the viewport settles on what the renderer draws", gpu, changes),
        trial("every display transform of the viewport is the one of the file", gpu, transforms),
        trial("false colours, marks and the light of one source are those of the renderer", gpu, aids),
        trial("an edit shows in the next frame, a moving view is never settled", gpu, next_frame),
        trial("a pick finds what is seen, a readout what is summed", gpu, pick_and_radiance),
        trial("a hidden instance is not seen and casts no shadow", gpu, hidden),
        trial("a refused scene leaves the old one", gpu, refused),
        trial("an environment that was prepared is there at once", gpu, environment_again),
        trial("a viewport without a scene or of no size says so", gpu, nothing_to_show),
        trial("a viewport on a lost device is an error from then on", gpu, lost_device),
    ]
}

struct Bench {
    gpu: Gpu,
    passes: Arc<Passes>,
    viewport: Viewport,
}

impl Bench {
    fn new() -> Bench {
        let gpu = Gpu::new().unwrap_or_else(|e| panic!("{e}"));
        let passes = Arc::new(Passes::new(&gpu));
        let viewport = Viewport::with_passes(&passes);
        Bench { gpu, passes, viewport }
    }

    fn set(&mut self, scene: &Arc<Scene>) {
        self.viewport.set_scene(scene).unwrap_or_else(|e| panic!("{e}"));
    }

    fn draw(&mut self, frame: &Frame) -> Drawn {
        self.viewport.draw(frame).unwrap_or_else(|e| panic!("{e}"))
    }

    fn settle(&mut self, frame: &Frame) -> Drawn {
        for _ in 0..5000 {
            let drawn = self.draw(frame);
            if drawn.settled {
                return drawn;
            }
        }
        panic!("the picture does not settle");
    }

    fn radiance(&mut self, at: Vec2) -> Vec3 {
        self.viewport.radiance(at).unwrap_or_else(|e| panic!("{e}")).expect("a picture")
    }

    /// What the screen shows, against a picture in its display transform.
    fn assert_shows(&self, picture: &Picture, tone: ToneMap, what: &str) {
        let output = self.viewport.output().expect("a picture").texture();
        assert_eq!((output.width(), output.height()), (picture.width, picture.height));
        let bytes = read_texture(&self.gpu, output, 0, 0).unwrap_or_else(|e| panic!("{e}"));
        let shown = bytes.as_chunks::<4>().0;
        let factor = exposure_factor(EXPOSURE);
        for (i, (shown, texel)) in shown.iter().zip(&picture.texels).enumerate() {
            let expected = tone_map(tone, factor * texel.truncate()).to_array().map(|v| v * 255.0);
            for (shown, expected) in shown.iter().zip(expected) {
                // Rounding to a byte, and the other order of the sum.
                let apart = (f32::from(*shown) - expected).abs();
                assert!(apart <= 1.0, "{what}: {shown} instead of {expected} at pixel {i}");
            }
        }
    }
}

fn frame(scene: &Scene) -> Frame {
    let settings = Settings::new(PARAMS);
    let camera = scene.cameras[0].clone();
    Frame {
        size: SIZE,
        camera,
        settings,
        lighting: Default::default(),
        tone: TONE,
        exposure_ev: EXPOSURE,
        mode: Default::default(),
        contribution: Default::default(),
        moving: false,
    }
}

fn reference(passes: &Arc<Passes>, scene: &Arc<Scene>) -> Picture {
    light_of(passes, scene, Contribution::All)
}

fn light_of(passes: &Arc<Passes>, scene: &Arc<Scene>, contribution: Contribution) -> Picture {
    let mut renderer = Renderer::with_passes(passes, scene).unwrap_or_else(|e| panic!("{e}"));
    renderer.show(contribution);
    let camera = scene.cameras[0].clone();
    let view = View { size: SIZE, camera, settings: Settings::new(PARAMS), jitter_frames: FRAMES };
    renderer.render(&view).unwrap_or_else(|e| panic!("{e}"))
}

/// No two directions are alike, and it is quick to prepare.
fn sky(tint: Vec3) -> Environment {
    let texel = |i: u32| tint * Vec3::new((i % 16) as f32, (i / 16) as f32, 4.0) * 0.1;
    Environment::new("sky", 16, 8, (0..16 * 8).map(texel).collect())
}

/// Lamps of all kinds, masks, panes and textures.
fn base() -> Scene {
    let mut scene = scenes::lights_and_alpha();
    scene.environment = Some(Arc::new(sky(Vec3::ONE)));
    scene
}

fn environment(scene: &mut Scene) -> &mut Environment {
    Arc::make_mut(scene.environment.as_mut().expect("the base has one"))
}

/// The first material that fits, by a rule.
fn material(scene: &mut Scene, fits: fn(&Material) -> bool) -> &mut Material {
    scene.materials.iter_mut().find(|m| fits(m)).expect("a material of the base")
}

fn masked(m: &Material) -> bool {
    matches!(m.alpha_mode, AlphaMode::Mask { .. })
}

type Change = (&'static str, fn(&mut Scene));

/// Kinds of changes, each to the base scene.
const CHANGES: &[Change] = &[
    ("nothing", |_| {}),
    ("factors", |s| {
        for m in &mut s.materials {
            m.roughness = 0.5 * m.roughness + 0.3;
            m.base_color *= Vec3::new(0.4, 0.7, 1.0);
        }
    }),
    ("presets", |s| {
        for (m, id) in s.materials.iter_mut().zip(["Au", "Cu", "Ag", "Au"]) {
            let metal = preset::find(id).expect("a preset");
            let fresnel = Arc::new(metal.fresnel(Form::Spectral));
            m.reflectance = Reflectance::Preset { id: id.into(), fresnel };
        }
    }),
    ("opaque becomes blended", |s| {
        let m = material(s, |m| m.alpha_mode == AlphaMode::Opaque && m.metallic == 1.0);
        (m.alpha_mode, m.opacity) = (AlphaMode::Blend, 0.4);
    }),
    ("blended becomes opaque", |s| material(s, |m| m.alpha_mode == AlphaMode::Blend).alpha_mode = AlphaMode::Opaque),
    ("masked becomes opaque", |s| material(s, masked).alpha_mode = AlphaMode::Opaque),
    ("a mask cuts all", |s| material(s, masked).opacity = 0.2),
    ("sides", |s| s.materials.iter_mut().for_each(|m| m.double_sided = !m.double_sided)),
    ("a texture is taken off", |s| material(s, |m| m.normal_texture.is_some()).normal_texture = None),
    ("an image is added and used", |s| {
        let texels = (0..4 * 16).map(|i| if i % 4 == 3 { 255 } else { (i * 37 % 256) as u8 }).collect();
        let image = Image { name: "new".into(), width: 4, height: 4, texels: Texels::Unorm8(texels) };
        s.images.insert(0, Arc::new(image));
        for m in &mut s.materials {
            let textures = [&mut m.base_color_texture, &mut m.normal_texture];
            textures.into_iter().flatten().for_each(|t| t.image += 1);
        }
        let texture = s.materials.iter().find_map(|m| m.base_color_texture).expect("a texture");
        for m in s.materials.iter_mut().filter(|m| m.base_color_texture.is_none()) {
            m.base_color_texture = Some(burnish_core::material::TextureRef { image: 0, ..texture });
        }
    }),
    ("images change places", |s| {
        let last = s.images.len() - 1;
        s.images.swap(0, last);
    }),
    ("an instance is hidden", |s| s.instances[1].visible = false),
    ("another material", |s| s.instances[2].material = s.instances[1].material),
    ("instances move", |s| {
        for i in &mut s.instances[1..4] {
            i.world_from_local = Affine3A::from_translation(Vec3::new(0.1, 0.05, 0.1)) * i.world_from_local;
        }
    }),
    ("an instance is mirrored", |s| {
        let instance = &mut s.instances[3];
        instance.world_from_local *= Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0));
    }),
    ("another mesh", |s| s.meshes[1] = Arc::new(shape::sphere(0.2, 24))),
    ("an instance is removed", |s| {
        s.instances.remove(1);
    }),
    ("everything is removed", |s| s.instances.clear()),
    ("lights move", |s| s.lights.iter_mut().for_each(|l| l.position += Vec3::new(0.3, 0.0, 0.1))),
    ("lights dim", |s| s.lights.iter_mut().for_each(|l| l.intensity *= 0.3)),
    ("a light becomes another kind", |s| s.lights[0].kind = LightKind::PARALLEL),
    ("lights go out", |s| s.lights.clear()),
    ("another environment", |s| s.environment = Some(Arc::new(sky(Vec3::new(2.0, 0.5, 0.1))))),
    ("a turned and stronger environment", |s| {
        environment(s).rotation = 1.3;
        environment(s).strength = 2.5;
    }),
];

fn changes() {
    let mut bench = Bench::new();
    let base = Arc::new(base());
    let unchanged = reference(&bench.passes, &base);
    for (name, change) in CHANGES {
        bench.set(&base);
        bench.draw(&frame(&base));
        let mut changed = Scene::clone(&base);
        change(&mut changed);
        assert_eq!(changed.validate(), Ok(()), "{name}");
        let changed = Arc::new(changed);
        bench.set(&changed);
        let drawn = bench.settle(&frame(&changed));
        assert_eq!((drawn.size, drawn.frames, drawn.preparing), (SIZE, FRAMES, None), "{name}");
        let expected = reference(&bench.passes, &changed);
        bench.assert_shows(&expected, TONE, name);
        let visible = expected.texels != unchanged.texels;
        assert_eq!(visible, *name != "nothing", "{name}: does it show?");
    }
}

fn transforms() {
    let mut bench = Bench::new();
    let scene = Arc::new(base());
    bench.set(&scene);
    let picture = reference(&bench.passes, &scene);
    let mut frame = frame(&scene);
    bench.settle(&frame);
    for tone in ToneMap::ALL {
        frame.tone = tone;
        assert!(bench.draw(&frame).settled, "a display transform draws nothing anew");
        bench.assert_shows(&picture, tone, tone.id());
    }
}

fn aids() {
    let mut bench = Bench::new();
    let scene = Arc::new(base());
    bench.set(&scene);
    let picture = reference(&bench.passes, &scene);
    let mut frame = frame(&scene);
    bench.settle(&frame);
    for mode in [DisplayMode::FalseColor, DisplayMode::Clipping] {
        frame.mode = mode;
        assert!(bench.draw(&frame).settled, "a mode of the display draws nothing anew");
        // Bands end at a luminance: the other order of the sum may put a texel into the next.
        let wanted = displayed(&picture, mode, TONE, EXPOSURE);
        let output = bench.viewport.output().expect("a picture").texture();
        let bytes = read_texture(&bench.gpu, output, 0, 0).unwrap_or_else(|e| panic!("{e}"));
        let pairs = bytes.as_chunks::<4>().0.iter().zip(&wanted.texels);
        let other = pairs.filter(|(shown, texel)| {
            let encoded = burnish_core::color::rgb::srgb_from_linear(texel.truncate()).to_array();
            shown.iter().zip(encoded).any(|(shown, wanted)| (f32::from(*shown) - 255.0 * wanted).abs() > 1.5)
        });
        let other = other.count();
        assert!(other * 500 <= wanted.texels.len(), "{}: {other} pixels differ", mode.id());
    }
    frame.mode = DisplayMode::Picture;
    for contribution in Contribution::each(scene.lights.len()) {
        frame.contribution = contribution;
        assert!(!bench.draw(&frame).settled, "{contribution:?} is another picture");
        bench.settle(&frame);
        let wanted = light_of(&bench.passes, &scene, contribution);
        assert_ne!(wanted.texels, picture.texels);
        bench.assert_shows(&wanted, TONE, &format!("{contribution:?}"));
    }
}

/// A square before the camera, which emits light of this colour only.
fn glowing(color: Vec3) -> Arc<Scene> {
    let mut scene = scenes::bent_square(false);
    let base_color = Vec3::ZERO;
    scene.materials[0] = Material { base_color, specular: 0.0, emission: color, ..Material::default() };
    Arc::new(scene)
}

fn next_frame() {
    let mut bench = Bench::new();
    let [red, green] = [Vec3::X, Vec3::Y].map(glowing);
    bench.set(&red);
    let mut frame = frame(&red);
    bench.settle(&frame);
    assert!(bench.radiance(Vec2::splat(0.5)).abs_diff_eq(Vec3::X, 1e-3));
    // An edit keeps meshes and maps.
    let edited = Scene { materials: green.materials.clone(), ..Scene::clone(&red) };
    bench.set(&Arc::new(edited));
    let drawn = bench.draw(&frame);
    assert_eq!((drawn.frames, drawn.settled), (1, false));
    assert!(bench.radiance(Vec2::splat(0.5)).abs_diff_eq(Vec3::Y, 1e-3));
    frame.moving = true;
    for _ in 0..4 {
        frame.camera.world_from_view.translation.x += 0.01;
        let drawn = bench.draw(&frame);
        assert!(drawn.frames == 1 && !drawn.settled, "{drawn:?}");
    }
    frame.moving = false;
    assert_eq!(bench.settle(&frame).size, SIZE);
}

fn pick_and_radiance() {
    let mut bench = Bench::new();
    let scene = Arc::new(base());
    assert_eq!(bench.viewport.pick(Vec2::splat(0.5)), Ok(None));
    assert_eq!(bench.viewport.radiance(Vec2::splat(0.5)), Ok(None));
    bench.set(&scene);
    bench.settle(&frame(&scene));
    let picture = reference(&bench.passes, &scene);
    for (x, y) in [(0, 0), (45, 30), (20, 40), (89, 59)] {
        let at = (UVec2::new(x, y).as_vec2() + 0.5) / SIZE.as_vec2();
        let expected = picture.texels[(y * SIZE.x + x) as usize].truncate();
        let read = bench.radiance(at);
        // The other order of the sum.
        assert!(read.abs_diff_eq(expected, 1e-5 * expected.max_element()), "{read} is not {expected}");
    }
    assert_eq!(bench.viewport.radiance(Vec2::new(1.5, 0.5)), Ok(None));

    // Every instance is picked where its middle is seen, unless something is before it.
    let aspect = SIZE.x as f32 / SIZE.y as f32;
    let clip = burnish_render::renderer::clip_from_world(&scene.cameras[0], SIZE.as_vec2(), Vec2::ZERO);
    let mut found = 0;
    for instance in &scene.instances {
        let middle = Vec3::from(instance.world_from_local.translation);
        let seen = clip.project_point3(middle);
        let at = Vec2::new(0.5 + 0.5 * seen.x, 0.5 - 0.5 * seen.y);
        let Some(picked) = bench.viewport.pick(at).unwrap_or_else(|e| panic!("{e}")) else { continue };
        let ray = scene.cameras[0].ray(at, aspect);
        assert!((picked.position - ray.origin).cross(ray.direction).length() < 1e-4, "{picked:?} is off its ray");
        found += usize::from(std::ptr::eq(&scene.instances[picked.instance], instance));
    }
    assert!(found > scene.instances.len() / 2, "only {found} of {} are picked", scene.instances.len());
}

fn hidden() {
    let mut bench = Bench::new();
    let mut scene = scenes::bent_square(false);
    environment(&mut scene).strength = 1e-3;
    // A lamp behind the viewer, and a ball between it and the square, beside what the camera sees in the middle.
    let up = Vec3::new(0.0, 0.9, 0.8);
    scene.meshes.push(Arc::new(shape::sphere(0.25, 24)));
    let mut ball = scene.instances[0].clone();
    (ball.mesh, ball.world_from_local) = (1, Affine3A::from_translation(0.5 * up));
    scene.instances.push(ball);
    scene.lights.push(burnish_core::scene::Light {
        name: "lamp".into(),
        position: up,
        direction: -up.normalize(),
        intensity: Vec3::splat(50.0),
        range: f32::INFINITY,
        kind: LightKind::Point,
        ..Default::default()
    });
    scene.materials[0] = Material { double_sided: true, ..Material::default() };
    let shown = Arc::new(scene);
    let mut scene = Scene::clone(&shown);
    scene.instances[1].visible = false;
    let hidden = Arc::new(scene);
    let at = Vec2::splat(0.5);
    let mut radiance = |scene: &Arc<Scene>| {
        bench.set(scene);
        bench.settle(&frame(scene));
        let picked = bench.viewport.pick(Vec2::new(0.4, 0.02)).unwrap_or_else(|e| panic!("{e}"));
        (bench.radiance(at), picked.map(|p| p.instance))
    };
    let (dark, _) = radiance(&shown);
    let (lit, picked) = radiance(&hidden);
    assert!(lit.min_element() > 2.0 * dark.max_element(), "{lit} is not lit, {dark} in the shadow");
    assert_ne!(picked, Some(1));
    // The renderer too.
    let [shown, hidden] = [shown, hidden].map(|scene| reference(&bench.passes, &scene));
    let middle = (SIZE.y / 2 * SIZE.x + SIZE.x / 2) as usize;
    assert!(hidden.texels[middle].x > 2.0 * shown.texels[middle].x);
}

fn refused() {
    let mut bench = Bench::new();
    let scene = glowing(Vec3::X);
    bench.set(&scene);
    bench.settle(&frame(&scene));
    let without = Scene { environment: None, ..Scene::clone(&glowing(Vec3::Y)) };
    assert_eq!(bench.viewport.set_scene(&Arc::new(without)), Err(RenderError::NoEnvironment));
    assert!(bench.draw(&frame(&scene)).settled);
    assert!(bench.radiance(Vec2::splat(0.5)).abs_diff_eq(Vec3::X, 1e-3));
}

fn environment_again() {
    let mut bench = Bench::new();
    let first = Arc::new(base());
    let mut scene = Scene::clone(&first);
    scene.environment = Some(Arc::new(sky(Vec3::X)));
    let second = Arc::new(scene);
    for scene in [&first, &second] {
        bench.set(scene);
        assert!(bench.draw(&frame(scene)).preparing.is_some());
        bench.settle(&frame(scene));
    }
    bench.set(&first);
    assert_eq!(bench.draw(&frame(&first)).preparing, None);
}

fn nothing_to_show() {
    let mut bench = Bench::new();
    let scene = glowing(Vec3::X);
    let mut frame = frame(&scene);
    let drawn = bench.draw(&frame);
    assert!(drawn.settled && drawn.size == UVec2::ZERO && bench.viewport.output().is_none());
    bench.set(&scene);
    frame.size = UVec2::new(0, 60);
    assert!(matches!(bench.viewport.draw(&frame), Err(RenderError::Size { .. })));
    frame.size = UVec2::new(1, 1);
    assert_eq!(bench.settle(&frame).size, UVec2::ONE);
}

fn lost_device() {
    let mut bench = Bench::new();
    let scene = glowing(Vec3::X);
    bench.set(&scene);
    let frame = frame(&scene);
    bench.draw(&frame);
    bench.gpu.device.destroy();
    let moved = Frame { exposure_ev: 1.0, ..frame };
    for _ in 0..2 {
        let errors = [
            bench.viewport.draw(&moved).err(),
            bench.viewport.set_scene(&glowing(Vec3::Y)).err(),
            bench.viewport.radiance(Vec2::splat(0.5)).err(),
        ];
        for error in errors {
            let error = error.expect("nothing works without a device").to_string();
            assert!(error.contains("the graphics device failed"), "{error}");
        }
    }
}
