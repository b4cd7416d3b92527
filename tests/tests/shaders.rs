//! Every WGSL file of the project, checked without a GPU: it parses and validates, the structs and constants that
//! both languages declare agree, and a leaf stays a leaf.

use std::f32::consts;

use burnish_core::color::tone::{self, ToneMap};
use burnish_core::leaf::{self, Leaf};
use burnish_core::lighting::{area, area_cube, classical, impostor, probe, radiance_map};
use burnish_core::measure::view;
use burnish_core::surface::blinn_phong::{self, Variant};
use burnish_core::surface::ggx::{self, Masking, albedo};
use burnish_core::surface::{coat, fresnel, layered, micro_normal};
use burnish_render::layout::types::{CONSTANTS, STRUCTS};
use burnish_render::shader;
use naga::valid::{Capabilities, ValidationFlags, Validator};

fn validated(name: &str, source: &str) -> naga::Module {
    let module = naga::front::wgsl::parse_str(source)
        .unwrap_or_else(|e| panic!("{name} does not parse:\n{}", e.emit_to_string(source)));
    // Packing halves is part of WGSL; naga lists it as a capability because old GL lacks it.
    Validator::new(ValidationFlags::all(), Capabilities::SHADER_FLOAT16_IN_FLOAT32)
        .validate(&module)
        .unwrap_or_else(|e| panic!("{name} is not valid:\n{}", e.emit_to_string(source)));
    module
}

/// The leaf alone, with stand-ins for what passes supply.
fn source_of(leaf: &'static Leaf) -> String {
    let mut source = leaf::join(&[leaf]);
    for needed in leaf::order(leaf) {
        source.push_str(needed.externs);
        source.push('\n');
    }
    source
}

#[test]
fn every_leaf_validates_with_the_leaves_it_declares() {
    let leaves = burnish_core::leaves::all();
    assert!(!leaves.is_empty());
    for leaf in leaves {
        validated(leaf.name, &source_of(leaf));
    }
}

#[test]
fn leaf_names_are_unique() {
    let mut names: Vec<_> = burnish_core::leaves::all().iter().map(|l| l.name).collect();
    names.sort_unstable();
    let count = names.len();
    names.dedup();
    assert_eq!(names.len(), count);
}

#[test]
fn leaves_have_no_bindings_and_no_entry_points() {
    for leaf in burnish_core::leaves::all() {
        let module = validated(leaf.name, &source_of(leaf));
        assert!(module.entry_points.is_empty(), "{} has an entry point", leaf.name);
        assert!(module.global_variables.is_empty(), "{} has a global variable", leaf.name);
    }
}

#[test]
fn every_pass_validates() {
    assert!(!shader::ALL.is_empty());
    for shader in shader::ALL {
        let module = validated(shader.name, &shader.source());
        assert!(!module.entry_points.is_empty(), "{} has no entry point", shader.name);
    }
}

#[test]
fn what_is_timed_without_a_curve_is_the_same_in_both_languages() {
    let times = validated("times", &shader::TIMES.source());
    assert_eq!(constant(&times, "FORM_NONE"), f64::from(burnish_render::times::FORM_NONE));
}

#[test]
fn lookups_of_a_radiance_map_have_the_constants_of_the_processor() {
    let map = validated("radiance map", &shader::RADIANCE_MAP.source());
    assert_eq!(constant(&map, "RADIANCE_MAP_SET"), radiance_map::SET as f64);
    assert_eq!(constant(&map, "RADIANCE_MAP_AGREEMENT"), f64::from(radiance_map::AGREEMENT));
    assert_eq!(constant(&map, "RADIANCE_MAP_RINGS"), f64::from(radiance_map::RINGS));
    assert_eq!(constant(&map, "RADIANCE_MAP_MIRRORS"), f64::from(radiance_map::MOST_MIRRORS));
}

#[test]
fn as_many_children_of_a_tree_wait_as_the_shader_has_places() {
    let trace = validated("trace", &shader::TRACE.source());
    assert_eq!(constant(&trace, "TRACE_STACK"), burnish_render::trace::STACK as f64);
}

#[test]
fn shared_structs_have_the_same_names_offsets_and_sizes() {
    let module = validated("types", include_str!("../../render/src/layout/types.wgsl"));
    let mut layouter = naga::proc::Layouter::default();
    layouter.update(module.to_ctx()).unwrap();
    let mut seen = Vec::new();
    for (handle, ty) in module.types.iter() {
        let naga::TypeInner::Struct { members, span } = &ty.inner else { continue };
        let name = ty.name.clone().unwrap();
        let twin = STRUCTS.iter().find(|s| s.name == name).unwrap_or_else(|| panic!("{name} has no Rust twin"));
        assert_eq!(twin.size, *span as usize, "size of {name}");
        assert_eq!(twin.size, layouter[handle].to_stride() as usize, "stride of {name}");
        let theirs: Vec<_> = members
            .iter()
            .map(|m| {
                let size = module.types[m.ty].inner.size(module.to_ctx()) as usize;
                (m.name.clone().unwrap(), m.offset as usize, size)
            })
            .collect();
        let ours: Vec<_> = twin.fields.iter().map(|f| (f.name.to_string(), f.offset, f.size)).collect();
        assert_eq!(ours, theirs, "fields of {name}");
        seen.push(name);
    }
    for twin in STRUCTS {
        assert!(seen.iter().any(|name| name == twin.name), "{} has no WGSL twin", twin.name);
    }
}

/// Value of a module constant as a number. naga has folded expressions; a copy of another constant is followed.
fn constant(module: &naga::Module, name: &str) -> f64 {
    let (_, constant) = module
        .constants
        .iter()
        .find(|(_, c)| c.name.as_deref() == Some(name))
        .unwrap_or_else(|| panic!("no WGSL constant {name}"));
    let mut expression = constant.init;
    loop {
        expression = match module.global_expressions[expression] {
            naga::Expression::Constant(other) => module.constants[other].init,
            naga::Expression::Literal(naga::Literal::U32(v)) => return f64::from(v),
            naga::Expression::Literal(naga::Literal::I32(v)) => return f64::from(v),
            naga::Expression::Literal(naga::Literal::F32(v)) => return f64::from(v),
            ref other => panic!("{name} is {other:?}, not a number"),
        };
    }
}

/// Names of all module constants.
fn constants(module: &naga::Module) -> Vec<String> {
    module.constants.iter().filter_map(|(_, c)| c.name.clone()).collect()
}

#[test]
fn constants_of_both_languages_are_equal() {
    let types = validated("types", include_str!("../../render/src/layout/types.wgsl"));
    for (name, value) in CONSTANTS {
        assert_eq!(constant(&types, name), f64::from(*value), "{name}");
    }
}

/// Constants of a leaf with their namesakes in Rust; every constant of every leaf is here.
fn twins(leaf: &str) -> Vec<(&'static str, f64)> {
    match leaf {
        "math" => vec![("PI", consts::PI.into()), ("INV_PI", consts::FRAC_1_PI.into())],
        "tone" => vec![
            ("TONE_NONE", ToneMap::None.number().into()),
            ("TONE_NEUTRAL", ToneMap::Neutral.number().into()),
            ("TONE_AGX", ToneMap::AgX.number().into()),
            ("TONE_ACES", ToneMap::Aces.number().into()),
            ("MAX_LINEAR", tone::MAX_LINEAR.into()),
        ],
        "view" => vec![
            ("DISPLAY_PICTURE", view::DISPLAY_PICTURE.into()),
            ("DISPLAY_FALSE_COLOR", view::DISPLAY_FALSE_COLOR.into()),
            ("DISPLAY_CLIPPING", view::DISPLAY_CLIPPING.into()),
            ("MIDDLE_GREY", view::MIDDLE_GREY.into()),
            ("CLIP_OVER", view::CLIP_OVER.into()),
            ("CLIP_UNDER", view::CLIP_UNDER.into()),
        ],
        "fresnel" => vec![
            ("FRESNEL_RESCALED", fresnel::RESCALED.into()),
            ("FRESNEL_SCHLICK", fresnel::SCHLICK.into()),
            ("FRESNEL_CONDUCTOR", fresnel::CONDUCTOR.into()),
            ("FRESNEL_SPECTRAL", fresnel::SPECTRAL.into()),
            ("FRESNEL_COMPENSATED", fresnel::COMPENSATED.into()),
            ("FRESNEL_F82", fresnel::F82.into()),
            ("FRESNEL_SERIES2", fresnel::SERIES2.into()),
            ("FRESNEL_SERIES3", fresnel::SERIES3.into()),
            ("FRESNEL_SERIES4", fresnel::SERIES4.into()),
            ("FRESNEL_TABLE_SIZE", fresnel::TABLE_SIZE as f64),
            ("FRESNEL_INDEX_MIN", fresnel::INDEX_MIN.into()),
            ("FRESNEL_INDEX_MAX", fresnel::INDEX_MAX.into()),
        ],
        "ggx" => vec![
            ("GGX_ALPHA_MIN", ggx::ALPHA_MIN.into()),
            ("GGX_CORRELATED", f64::from(Masking::Correlated as u32)),
            ("GGX_SEPARABLE", f64::from(Masking::Separable as u32)),
            ("GGX_ALBEDO_MU", albedo::ALBEDO_MU.into()),
            ("GGX_ALBEDO_ALPHA", albedo::ALBEDO_ALPHA.into()),
            ("GGX_ALBEDO_LOSS_MEAN", albedo::ALBEDO_LOSS_MEAN.into()),
            ("GGX_ALBEDO_SCHLICK", albedo::ALBEDO_SCHLICK.into()),
            ("GGX_ALBEDO_SCHLICK_MEAN", albedo::ALBEDO_SCHLICK_MEAN.into()),
            ("GGX_ALBEDO_STRIDE", albedo::ALBEDO_STRIDE.into()),
            ("GGX_ALBEDO_ROOT_MIN", albedo::ALBEDO_ROOT_MIN.into()),
            ("GGX_ALBEDO_LOSS_NARROWING", albedo::ALBEDO_LOSS_NARROWING.into()),
            ("GGX_ALBEDO_SCHLICK_NARROWING", albedo::ALBEDO_SCHLICK_NARROWING.into()),
        ],
        "blinn_phong" => vec![
            ("BLINN_PHONG_EXPONENT_MAX", blinn_phong::EXPONENT_MAX.into()),
            ("BLINN_PHONG_COS_MIN", blinn_phong::COS_MIN.into()),
            ("BLINN_PHONG_EXACT", f64::from(Variant::Exact as u32)),
            ("BLINN_PHONG_APPROXIMATE", f64::from(Variant::Approximate as u32)),
            ("BLINN_PHONG_UNNORMALIZED", f64::from(Variant::Unnormalized as u32)),
            ("BLINN_PHONG_MICROFACET", f64::from(Variant::Microfacet as u32)),
        ],
        "layered" => vec![("LAYERED_GGX", f64::from(layered::GGX))],
        "probe" => vec![
            ("PROBE_BLEND", probe::BLEND.into()),
            ("PROBE_FADE", probe::FADE.into()),
            ("PROBE_JUMP", probe::JUMP.into()),
            ("PROBE_ALL", (probe::MOST as u32).into()),
            ("PROBE_FAR", f64::from(1e30_f32)),
        ],
        "impostor" => vec![
            ("PYRAMID_JUMP", probe::JUMP.into()),
            ("PYRAMID_WAYS", impostor::pyramid::WAYS.into()),
            ("PYRAMID_LOOKUPS_PER_STEP", impostor::pyramid::LOOKUPS_PER_STEP.into()),
            ("PYRAMID_ENTRY", impostor::pyramid::ENTRY.into()),
            ("PYRAMID_DEPTH_MIN", impostor::pyramid::DEPTH_MIN.into()),
            ("PYRAMID_FAR", impostor::pyramid::FAR.into()),
            ("IMPOSTOR_CLASSICAL", impostor::CLASSICAL.into()),
            ("IMPOSTOR_SPHERE", impostor::SPHERE.into()),
            ("IMPOSTOR_BOX", impostor::BOX.into()),
            ("IMPOSTOR_PERPENDICULAR", impostor::PERPENDICULAR.into()),
            ("IMPOSTOR_SECANT", impostor::SECANT.into()),
            ("IMPOSTOR_SECANT_FROM_POINT", impostor::SECANT_FROM_POINT.into()),
            ("IMPOSTOR_FALSE_POSITION", impostor::FALSE_POSITION.into()),
            ("IMPOSTOR_MIXED", impostor::MIXED.into()),
            ("IMPOSTOR_MARCH", impostor::MARCH.into()),
            ("IMPOSTOR_PYRAMID", impostor::PYRAMID.into()),
            ("IMPOSTOR_EPSILON", impostor::EPSILON.into()),
            ("IMPOSTOR_SHOW_LIGHT", impostor::SHOW_LIGHT.into()),
            ("IMPOSTOR_SHOW_LOOKUPS", impostor::SHOW_LOOKUPS.into()),
            ("IMPOSTOR_SHOW_RATIO", impostor::SHOW_RATIO.into()),
            ("IMPOSTOR_SHOW_ERROR", impostor::SHOW_ERROR.into()),
            ("IMPOSTOR_MOST_LOOKUPS", impostor::MOST_LOOKUPS.into()),
            ("IMPOSTOR_MOST_RATIO", impostor::MOST_RATIO.into()),
        ],
        "coat" => vec![("COAT_F0", coat::F0.into())],
        "micro_normal" => vec![
            ("MICRO_NORMAL_NONE", f64::from(micro_normal::Kind::None as u32)),
            ("MICRO_NORMAL_GRAIN", f64::from(micro_normal::Kind::Grain as u32)),
            ("MICRO_NORMAL_CAST", f64::from(micro_normal::Kind::Cast as u32)),
            ("MICRO_NORMAL_HAMMERED", f64::from(micro_normal::Kind::Hammered as u32)),
            ("MICRO_NORMAL_FADE_FROM", micro_normal::FADE_FROM.into()),
            ("MICRO_NORMAL_FADE_TO", micro_normal::FADE_TO.into()),
            ("MICRO_NORMAL_PRECISION", micro_normal::PRECISION.into()),
            ("MICRO_NORMAL_NOISE_SLOPE", micro_normal::NOISE_SLOPE.into()),
            ("MICRO_NORMAL_DENT_SLOPE", micro_normal::DENT_SLOPE.into()),
            ("MICRO_NORMAL_JITTER", micro_normal::JITTER.into()),
            ("MICRO_NORMAL_REACH", micro_normal::REACH.into()),
            ("MICRO_NORMAL_SHARPNESS", micro_normal::SHARPNESS.into()),
            ("MICRO_NORMAL_FLAT", micro_normal::FLAT.into()),
            ("MICRO_NORMAL_CAST_OCTAVES", micro_normal::CAST_OCTAVES.into()),
            ("MICRO_NORMAL_CAST_GAIN", micro_normal::CAST_GAIN.into()),
            ("MICRO_NORMAL_CAST_SHARE", micro_normal::CAST_SHARE.into()),
        ],
        "area" => vec![
            ("AREA_NODES", area::NODES.into()),
            ("AREA_NUMBERS", area::NUMBERS.into()),
            ("AREA_STRIDE", area::STRIDE.into()),
            ("AREA_ROUGHNESS_MIN", area::ROUGHNESS_MIN.into()),
            ("AREA_CORNERS_MAX", area::CORNERS_MAX as f64),
            ("AREA_SIDES", area::SIDES.into()),
            ("AREA_WIDENING", area::WIDENING.into()),
            ("AREA_HORIZON", area::HORIZON.into()),
            ("AREA_PARTS", area::PARTS.into()),
            ("AREA_BENDING", area::BENDING.into()),
            ("AREA_STREAK", area::STREAK.into()),
            ("AREA_PART_WIDTH", area::PART_WIDTH.into()),
            ("AREA_RATIO_MAX", area::RATIO_MAX.into()),
            ("AREA_NOTHING", area::NOTHING.into()),
            ("AREA_RECTANGLE", area::RECTANGLE.into()),
            ("AREA_CAP", area::CAP.into()),
            ("AREA_EVERYWHERE", area::EVERYWHERE.into()),
        ],
        "area_cube" => vec![
            ("AREA_CUBE_HEIGHTS", area_cube::tables::HEIGHTS.into()),
            ("AREA_CUBE_SHARES", area_cube::tables::SHARES.into()),
            ("AREA_CUBE_WIDTHS", area_cube::tables::WIDTHS.into()),
            ("AREA_CUBE_CAPS", area_cube::tables::CAPS.into()),
            ("AREA_CUBE_OFFSETS", area_cube::tables::OFFSETS.into()),
            ("AREA_CUBE_NORMALS", area_cube::tables::NORMALS.into()),
            ("AREA_CUBE_STRIDE", area_cube::tables::STRIDE.into()),
            ("AREA_CUBE_CHORD_MAX", area_cube::tables::CHORD_MAX.into()),
            ("AREA_CUBE_NEIGHBOURS", area_cube::NEIGHBOURS.into()),
            ("AREA_CUBE_NEAR", area_cube::NEAR.into()),
            ("AREA_CUBE_WIDEST", area_cube::WIDEST.into()),
            ("AREA_CUBE_LEAST", area_cube::LEAST.into()),
            ("AREA_CUBE_HORIZON", area_cube::HORIZON.into()),
        ],
        "classical" => vec![("CLASSICAL_OVERLAP", classical::OVERLAP.into())],
        _ => Vec::new(),
    }
}

#[test]
fn every_constant_of_a_leaf_equals_its_rust_namesake() {
    for leaf in burnish_core::leaves::all() {
        let module = validated(leaf.name, &source_of(leaf));
        let of_needs: Vec<_> =
            leaf.needs.iter().flat_map(|need| constants(&validated(need.name, &source_of(need)))).collect();
        let twins = twins(leaf.name);
        for name in constants(&module).iter().filter(|name| !of_needs.contains(name)) {
            assert!(twins.iter().any(|(twin, _)| twin == name), "{name} of `{}` has no Rust twin here", leaf.name);
        }
        for (name, value) in twins {
            assert_eq!(constant(&module, name), value, "{name} of `{}`", leaf.name);
        }
    }
}
