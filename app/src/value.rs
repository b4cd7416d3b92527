//! Values of command-line options: how they are read and what they take.

use std::path::PathBuf;

use burnish_core::file::PictureFormat;
use burnish_core::lighting::{self, Method};
use glam::{UVec2, Vec3};

/// Largest side of a picture: what every adapter grants a texture.
const MAX_SIDE: u32 = 8192;
/// Largest picture: 16 bytes a pixel fill the 256 MiB buffer that every adapter grants.
const MAX_PIXELS: u32 = 1 << 24;

/// `WIDTHxHEIGHT` in pixels.
pub fn size(text: &str) -> Result<UVec2, String> {
    let parsed = text.split_once('x').and_then(|(w, h)| Some(UVec2::new(w.parse().ok()?, h.parse().ok()?)));
    let size = parsed.ok_or("write it as WIDTHxHEIGHT, such as 1280x720")?;
    let sides = 1..=MAX_SIDE;
    if !sides.contains(&size.x) || !sides.contains(&size.y) || size.x * size.y > MAX_PIXELS {
        return Err(format!("each side takes 1 to {MAX_SIDE} pixels, both together at most {MAX_PIXELS}"));
    }
    Ok(size)
}

/// A number inside a range, for clap.
pub fn number(min: f32, max: f32) -> impl Fn(&str) -> Result<f32, String> + Clone {
    move |text| match text.parse::<f32>() {
        Ok(value) if (min..=max).contains(&value) => Ok(value),
        _ => Err(format!("it takes a number from {min} to {max}")),
    }
}

/// `key=value` of `--set`.
pub fn assignment(text: &str) -> Result<(String, String), String> {
    let (key, value) = text.split_once('=').ok_or("write it as key=value, such as samples=64")?;
    Ok((key.trim().into(), value.trim().into()))
}

/// One of a list of named things.
#[derive(Clone, Debug, PartialEq)]
pub enum Pick {
    Name(String),
    Index(usize),
}

impl Pick {
    /// `#3` is an index, all else a name.
    pub fn parse(text: &str) -> Pick {
        match text.strip_prefix('#').map(str::parse) {
            Some(Ok(index)) => Pick::Index(index),
            _ => Pick::Name(text.into()),
        }
    }

    /// Indices that are meant among `names`, at least one; several where a name occurs more than once. The error lists
    /// the names.
    pub fn among<'a>(&self, what: &str, names: impl Iterator<Item = &'a str>) -> Result<Vec<usize>, String> {
        let names: Vec<&str> = names.collect();
        let found: Vec<usize> = match self {
            Pick::Index(index) => (*index < names.len()).then_some(*index).into_iter().collect(),
            Pick::Name(name) => (0..names.len()).filter(|i| names[*i] == name).collect(),
        };
        if !found.is_empty() {
            return Ok(found);
        }
        let list: Vec<String> = names.iter().enumerate().map(|(i, name)| format!("#{i} {name}")).collect();
        let known = if list.is_empty() { "there are none".into() } else { format!("there are: {}", list.join(", ")) };
        Err(match self {
            Pick::Index(index) => format!("no {what} #{index}; {known}"),
            Pick::Name(name) => format!("no {what} `{name}`; {known}"),
        })
    }
}

/// A lighting method by its id.
#[derive(Clone, Copy)]
pub struct MethodChoice(pub &'static dyn Method);

/// Reads a [`MethodChoice`].
pub fn method(id: &str) -> Result<MethodChoice, String> {
    lighting::method::find(&lighting::methods(), id).map(MethodChoice).map_err(|e| e.to_string())
}

/// `PRESET[:slot]` of `--metal`.
#[derive(Clone, Debug, PartialEq)]
pub struct MetalChoice {
    /// Id of a preset, or its file.
    pub preset: String,
    /// Which material; all when absent.
    pub slot: Option<Pick>,
}

/// Reads a [`MetalChoice`]; the name of a slot may hold colons, and so may the path of a file.
pub fn metal(text: &str) -> Result<MetalChoice, String> {
    let end_of_file = text.to_ascii_lowercase().find(".json").map_or(0, |dot| dot + ".json".len());
    let (preset, slot) = match text[end_of_file..].find(':') {
        Some(colon) => {
            let (preset, slot) = text.split_at(end_of_file + colon);
            (preset, Some(Pick::parse(&slot[1..])))
        }
        None => (text, None),
    };
    if preset.is_empty() {
        return Err("write it as PRESET or PRESET:SLOT, such as Au:shell".into());
    }
    Ok(MetalChoice { preset: preset.into(), slot })
}

/// What `--camera` asks for.
#[derive(Clone, Debug, PartialEq)]
pub enum CameraChoice {
    /// A camera of the scene.
    Of(Pick),
    /// Points in metres and the full vertical angle in radians.
    LookAt { eye: Vec3, target: Vec3, yfov: f32 },
}

/// Reads a [`CameraChoice`]: seven numbers with commas are a point of view, all else picks from the scene.
pub fn camera(text: &str) -> Result<CameraChoice, String> {
    let numbers: Result<Vec<f32>, _> = text.split(',').map(|part| part.trim().parse::<f32>()).collect();
    let numbers = match numbers {
        Ok(numbers) if numbers.len() > 1 => numbers,
        _ => return Ok(CameraChoice::Of(Pick::parse(text))),
    };
    let &[ex, ey, ez, tx, ty, tz, fov] = numbers.as_slice() else {
        return Err("a point of view is seven numbers: eye x,y,z, target x,y,z, vertical angle in degrees".into());
    };
    let (eye, target) = (Vec3::new(ex, ey, ez), Vec3::new(tx, ty, tz));
    if !eye.is_finite() || !target.is_finite() || eye == target {
        return Err("eye and target must be finite and apart".into());
    }
    if !(1.0..=170.0).contains(&fov) {
        return Err("the vertical angle takes 1 to 170 degrees".into());
    }
    Ok(CameraChoice::LookAt { eye, target, yfov: fov.to_radians() })
}

/// A path whose ending names a format that pictures are written in.
pub fn picture_path(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    PictureFormat::of(&path).map(|_| path).map_err(|e| format!("{}; {}", e.reason, e.remedy))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_size_is_read_and_one_beyond_the_bounds_is_refused() {
        assert_eq!(size("1280x720"), Ok(UVec2::new(1280, 720)));
        for bad in ["", "x", "0x5", "8193x1", "8192x8192", "4294967295x4294967295", "-1x3", "3x3x3"] {
            assert!(size(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn seven_numbers_are_a_point_of_view_and_a_name_with_a_comma_is_a_name() {
        let Ok(CameraChoice::LookAt { eye, target, yfov }) = camera("1,2,3, 0,0,0, 90") else { panic!() };
        assert_eq!((eye, target), (Vec3::new(1.0, 2.0, 3.0), Vec3::ZERO));
        assert!((yfov - std::f32::consts::FRAC_PI_2).abs() < 1e-6);
        assert_eq!(camera("left, low"), Ok(CameraChoice::Of(Pick::Name("left, low".into()))));
        assert_eq!(camera("#2"), Ok(CameraChoice::Of(Pick::Index(2))));
        for bad in ["1,2,3", "0,0,0,0,0,0,40", "NaN,0,0,1,0,0,40", "0,0,0,1,0,0,0", "0,0,0,1,0,0,inf"] {
            assert!(camera(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn a_pick_finds_by_name_or_index_and_else_lists_what_there_is() {
        let names = ["shell", "body", "shell"];
        let among = |text: &str| Pick::parse(text).among("material", names.into_iter());
        assert_eq!(among("shell"), Ok(vec![0, 2]));
        assert_eq!(among("#1"), Ok(vec![1]));
        assert!(among("#3").unwrap_err().contains("#1 body"));
        assert!(among("lid").unwrap_err().contains("no material `lid`; there are: #0 shell"));
    }

    #[test]
    fn a_metal_is_a_preset_with_or_without_a_slot() {
        assert_eq!(metal("Au"), Ok(MetalChoice { preset: "Au".into(), slot: None }));
        let slot = Some(Pick::Name("a:b".into()));
        assert_eq!(metal("Au:a:b"), Ok(MetalChoice { preset: "Au".into(), slot }));
        let own = MetalChoice { preset: "C:\\own.json".into(), slot: Some(Pick::Index(2)) };
        assert_eq!(metal("C:\\own.json:#2"), Ok(own));
        assert!(metal(":shell").is_err());
    }
}
