//! Even light of radiance 1 from everywhere: no surface may send back more, white ones send back all.

use glam::DVec3;

use super::*;
use crate::material::finish;
use crate::material::{ReflectionModel, preset};
use crate::scene::gallery::shape;
use crate::surface::blinn_phong::{self, Variant};
use crate::surface::fresnel::Form;
use crate::surface::ggx::Masking;
use crate::surface::micro_normal;

/// A ring: it sees itself.
fn ring() -> Mesh {
    shape::torus(0.6, 0.3, 96, 48)
}

fn lit(material: Material, options: Options) -> Film {
    let mut scene = scene([(ring(), material)]);
    scene.environment = even_sky(Vec3::ONE);
    film(scene, options, &view(Vec3::new(0.0, 1.2, 1.4), Vec3::ZERO, 24, 9), 64)
}

/// Mean over the pixels that show nothing but the surface.
fn on_surface(film: &Film) -> DVec3 {
    let inside: Vec<_> = film.pixels().iter().filter(|pixel| pixel.hits == pixel.count).collect();
    assert!(inside.len() > 100, "{} pixels", inside.len());
    inside.iter().map(|pixel| pixel.mean).sum::<DVec3>() / inside.len() as f64
}

#[test]
fn white_surfaces_send_back_all_light() {
    let options = Options { bounces: 1000, ..Options::default() };
    let white = [
        ("matte", matte(Vec3::ONE)),
        ("mirror", even_metal(Vec3::ONE, 0.0)),
        ("smooth metal", even_metal(Vec3::ONE, 0.1)),
        ("rough metal", even_metal(Vec3::ONE, 0.5)),
        ("roughest metal", even_metal(Vec3::ONE, 1.0)),
        ("brushed metal", Material { anisotropy: 0.8, ..even_metal(Vec3::ONE, 0.3) }),
        ("plastic", Material { roughness: 0.4, double_sided: true, ..Material::default() }),
        ("glossy plastic", Material { roughness: 0.0, double_sided: true, ..Material::default() }),
        ("half metal", Material { metallic: 0.5, roughness: 0.3, double_sided: true, ..Material::default() }),
    ];
    for (name, material) in white {
        let got = on_surface(&lit(material, options));
        println!("{name}: {got:.4}");
        // The coupling of reflection and base, and the tables of what single scattering loses, hold to a percent; those
        // of stretched lobes to less, which a ring that sees itself multiplies.
        let bound = if name == "brushed metal" { 0.025 } else { 0.012 };
        assert!((got - DVec3::ONE).abs().max_element() < bound, "{name}: {got}");
    }
}

#[test]
fn no_metal_finish_or_coat_sends_back_more_than_it_gets() {
    let mut cases = Vec::new();
    for id in ["Au", "Ag", "Al", "Cr", "Ge"] {
        let metal = preset::find(id).unwrap();
        for form in Form::ALL {
            let reflectance = Reflectance::Preset { id: id.into(), fresnel: Arc::new(metal.fresnel(form)) };
            cases.push((format!("{id} {}", form.id()), Material { reflectance, roughness: 0.4, ..matte(Vec3::ONE) }));
        }
    }
    for kind in finish::Kind::ALL {
        for finish in finish::list(kind) {
            let mut material = even_metal(Vec3::ONE, 0.3);
            finish.apply(&mut material);
            cases.push((format!("white metal, {}", finish.id), material));
        }
    }
    for (exponent, metallic) in [(5.0, 0.0), (5.0, 1.0), (1000.0, 0.0), (1000.0, 1.0)] {
        let reflection_model = ReflectionModel::BlinnPhong(Variant::Exact);
        let material = Material { reflection_model, exponent, metallic, double_sided: true, ..Material::default() };
        cases.push((format!("power {exponent}, metallic {metallic}"), material));
    }
    let bumps = Material { micro_normal: micro_normal::Kind::Cast, micro_depth: 1.0, ..even_metal(Vec3::ONE, 0.1) };
    cases.push(("deep bumps".into(), bumps.clone()));
    cases.push(("deep bumps, lacquered".into(), Material { coat: 1.0, ..bumps }));
    for coat_roughness in [0.0, 0.3, 1.0] {
        cases.push((
            format!("coat {coat_roughness}"),
            Material { coat: 1.0, coat_roughness, ..even_metal(Vec3::ONE, 0.2) },
        ));
    }
    for masking in Masking::ALL {
        let options = Options { masking, bounces: 1000, ..Options::default() };
        for (name, material) in &cases {
            let got = on_surface(&lit(material.clone(), options));
            println!("{name}, {masking:?}: {got:.4}");
            assert!(got.max_element() < 1.012 && got.min_element() > 0.005, "{name}, {masking:?}: {got}");
        }
    }
}

#[test]
fn a_ball_of_metal_sends_back_its_directional_albedo() {
    use crate::surface::ggx::reflection::directional_albedo;
    let metal = preset::find("Cu").unwrap();
    let fresnel = metal.fresnel(Form::Spectral);
    for roughness in [0.1_f32, 0.4, 0.9] {
        let reflectance = Reflectance::Preset { id: "Cu".into(), fresnel: Arc::new(fresnel.clone()) };
        let material = Material { reflectance, roughness, ..Material::default() };
        let mut scene = scene([(shape::sphere(1.0, 128), material)]);
        scene.environment = even_sky(Vec3::ONE);
        let options = Options { multiple_scattering: false, ..Options::default() };
        // The middle of the ball, seen straight on.
        let mut view = view(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO, 8, 1);
        view.camera = Camera::look_at("middle", Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO, 0.02);
        let got = mean(&film(scene, options, &view, 256));
        let alpha = f64::from(roughness * roughness);
        let curve = |x: f64| fresnel.eval(x as f32).as_dvec3();
        let want = directional_albedo(1.0, alpha, Masking::Correlated, curve);
        println!("{roughness}: {got:.4} for {want:.4}");
        assert!((got / want - DVec3::ONE).abs().max_element() < 5e-3, "{roughness}: {got} instead of {want}");
    }
}

#[test]
fn a_power_of_the_cosine_sends_back_all_light_straight_on_and_a_share_aslant() {
    let reflection_model = ReflectionModel::BlinnPhong(Variant::Exact);
    for exponent in [0.0, 5.0, 32.0, 1e4] {
        for cos in [1.0f32, 0.6, 0.2] {
            let material = Material { reflection_model, exponent, ..even_metal(Vec3::ONE, 1.0) };
            let mut scene = scene([(shape::plane(40.0, 40.0), material)]);
            scene.environment = even_sky(Vec3::ONE);
            let eye = 3.0 * Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
            let mut view = view(eye, Vec3::ZERO, 8, 1);
            view.camera = Camera::look_at("middle", eye, Vec3::ZERO, 0.02);
            let got = mean(&film(scene, Options::default(), &view, 1024)).x;
            let want = f64::from(blinn_phong::albedo(cos, exponent, Variant::Exact));
            println!("{exponent} {cos}: {got:.4} for {want:.4}");
            // The fit is 1.6 % off, and exact at normal incidence; 64 k paths leave half a percent.
            let bound = if cos == 1.0 { 5e-3 } else { 0.02 };
            assert!((got / want - 1.0).abs() < bound, "{exponent} {cos}: {got} instead of {want}");
        }
    }
}

#[test]
fn a_world_by_wavelength_shows_metals_and_colours_as_their_colour() {
    let gold = preset::find("Au").unwrap();
    let curve = Arc::new(gold.fresnel(Form::Spectral));
    let metal = Material {
        reflectance: Reflectance::Preset { id: "Au".into(), fresnel: curve.clone() },
        roughness: 0.0,
        double_sided: true,
        ..Material::default()
    };
    let color = Vec3::new(0.8, 0.3, 0.1);
    // A plane sees nothing of itself: what is seen is the mean curve, or the colour, under coloured light.
    for (material, light) in [(metal, Vec3::ONE), (matte(color), Vec3::ONE), (even_metal(Vec3::ONE, 0.0), color)] {
        let mut scene = scene([(shape::plane(40.0, 40.0), material.clone())]);
        scene.environment = even_sky(light);
        let scene = Arc::new(scene);
        let view = view(Vec3::new(0.0, 0.0, 3.0), Vec3::ZERO, 8, 1);
        let rgb = World::new(&scene, Options::default());
        let (waves, unknown) = rgb.clone().by_wavelength(|id| preset::find(id).ok());
        assert_eq!(
            unknown.is_empty(),
            !matches!(&material.reflectance, Reflectance::Preset { id, .. } if id == "even")
        );
        let trace_in = |world: &World| {
            let mut film = Film::new(view.size);
            assert_eq!(trace(world, &view, &mut film, 1024, &Control::default()), Pass::Whole);
            mean(&film)
        };
        let (got, want) = (trace_in(&waves), trace_in(&rgb));
        println!("{got:.4} for {want:.4}");
        // The curve in RGB is clamped where the red of gold exceeds 1.
        assert!((got.min(DVec3::ONE) - want).abs().max_element() < 0.01, "{got} {want}");
    }
}
