//! glTF 2.0, as JSON or GLB.
//!
//! The `gltf` crate supplies the types of the JSON; everything that touches bytes, indices or the node graph is done
//! here, because the crate's own reading trusts the file.

mod accessor;
mod container;
mod material;
mod nodes;
mod primitive;
mod punctual;
#[cfg(test)]
mod tests;
mod texture;

use std::borrow::Cow;

use ::gltf::json::Root;

use super::budget::Meter;
use super::report::Report;
use super::resolve::{fetch, quoted};
use super::{Cause, NormalsWhenAbsent, ReadScene, Resolver};
use accessor::Data;

/// Extensions whose content is read. Everything else is refused when required and noticed when used.
const SUPPORTED: &[&str] = &[
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// Extensions that say nothing about the picture: how triangles were cut from polygons, and who made the file.
const WITHOUT_LOOK: &[&str] = &["FB_ngon_encoding", "KHR_xmp", "KHR_xmp_json_ld"];

/// Media types of inline buffers.
const BUFFER_MEDIA: &[&str] = &["application/octet-stream", "application/gltf-buffer"];

/// Reads a model; faults and notices go to the report.
pub(super) fn scene(
    bytes: &[u8],
    resolver: &dyn Resolver,
    normals: NormalsWhenAbsent,
    meter: &mut Meter,
    report: &mut Report,
) -> ReadScene {
    let taken = meter.take_bytes(bytes.len() as u64);
    report.keep("file", taken)?;
    let split = container::split(bytes);
    let (json, binary) = report.keep("file", split)?;
    let parsed = parse(json, meter);
    let root = report.keep("JSON", parsed)?;
    check_asset(&root, meter, report)?;
    let buffers = read_buffers(&root, binary, resolver, meter, report);
    let data = Data { root: &root, buffers };
    let images = texture::read_images(&data, resolver, meter, report);
    let materials = material::read_all(&root, &images, report);
    let mut scene = nodes::flatten(&data, &materials, normals, meter, report)?;
    scene.materials = materials.list;
    scene.images = images.list;
    Some(scene)
}

fn parse(json: &[u8], meter: &Meter) -> Result<Root, Cause> {
    let (asked, limit) = (json.len() as u64, meter.budget.json_bytes);
    if asked > limit {
        return Err(Cause::Limit { what: "bytes of JSON", asked, limit });
    }
    let (asked, limit) = (objects(json), meter.budget.json_objects);
    if asked > limit {
        return Err(Cause::Limit { what: "JSON objects", asked, limit });
    }
    serde_json::from_slice(json).map_err(|e| Cause::Syntax(e.to_string()))
}

/// Opening braces outside of strings.
fn objects(json: &[u8]) -> u64 {
    let (mut count, mut quoted, mut escaped) = (0, false, false);
    for byte in json {
        match byte {
            _ if escaped => escaped = false,
            b'\\' => escaped = quoted,
            b'"' => quoted = !quoted,
            b'{' if !quoted => count += 1,
            _ => {}
        }
    }
    count
}

/// True for extensions that may be required without harm.
fn known(extension: &str) -> bool {
    SUPPORTED.contains(&extension) || WITHOUT_LOOK.contains(&extension)
}

/// Refuses files that cannot be shown as meant; `None` when it did.
fn check_asset(root: &Root, meter: &Meter, report: &mut Report) -> Option<()> {
    let needed = root.asset.min_version.as_ref().unwrap_or(&root.asset.version);
    let mut sound = true;
    if !root.asset.version.starts_with("2.") || (root.asset.min_version.is_some() && needed != "2.0") {
        report.fault("asset", Cause::Unsupported(format!("glTF version {}; version 2.0 is read", quoted(needed))));
        sound = false;
    }
    for name in &root.extensions_required {
        if !known(name) {
            report.fault("extensionsRequired", Cause::Extension(name.chars().take(80).collect()));
            sound = false;
        }
    }
    let (asked, limit) = (root.nodes.len() as u64, meter.budget.nodes);
    if asked > limit {
        report.fault("nodes", Cause::Limit { what: "nodes", asked, limit });
        sound = false;
    }
    for name in &root.extensions_used {
        match name.as_str() {
            name if known(name) || root.extensions_required.iter().any(|r| r == name) => {}
            "KHR_materials_pbrSpecularGlossiness" => report.notice(
                "extensionsUsed",
                "KHR_materials_pbrSpecularGlossiness is not supported; the metallic-roughness values are shown instead",
            ),
            name => report.notice("extensionsUsed", format!("the extension {} is not supported", quoted(name))),
        }
    }
    for (list, what) in [(root.animations.len(), "animations"), (root.skins.len(), "skins")] {
        report.notice_many(what, format!("{what} are not played; the model is shown at rest"), list);
    }
    sound.then_some(())
}

/// The bytes of every buffer; those that cannot be had are reported and `None`.
fn read_buffers<'a>(
    root: &Root,
    binary: Option<&'a [u8]>,
    resolver: &dyn Resolver,
    meter: &mut Meter,
    report: &mut Report,
) -> Vec<Option<Cow<'a, [u8]>>> {
    let mut buffers = Vec::with_capacity(root.buffers.len());
    for (i, buffer) in root.buffers.iter().enumerate() {
        let bytes = match (&buffer.uri, binary) {
            (Some(uri), _) => fetch(resolver, uri, BUFFER_MEDIA, meter).map(Cow::Owned),
            (None, Some(binary)) if i == 0 => Ok(Cow::Borrowed(binary)),
            (None, _) => Err(Cause::Invalid("has neither a URI nor a binary chunk".into())),
        };
        let bytes = bytes.and_then(|bytes| {
            let (have, stated) = (bytes.len() as u64, buffer.byte_length.0);
            if have < stated {
                return Err(Cause::Invalid(format!("states {stated} bytes but has {have}")));
            }
            Ok(bytes)
        });
        buffers.push(report.keep(element("buffer", i, buffer.name.as_deref()), bytes));
    }
    buffers
}

/// An element as messages call it: `mesh 3 'body'`.
fn element(kind: &str, index: usize, name: Option<&str>) -> String {
    match name {
        Some(name) if !name.is_empty() => format!("{kind} {index} {}", quoted(name)),
        _ => format!("{kind} {index}"),
    }
}
