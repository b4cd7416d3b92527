//! PNG and JPEG pictures for textures: size first, pixels later.

use std::io::Cursor;

use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};
use rayon::prelude::*;

use super::budget::Meter;
use super::guard::guarded;
use super::{Cause, sniff};
use crate::scene::{Image, Texels};

/// A picture whose header was read and whose pixels are within the budget.
pub(super) struct Encoded {
    bytes: Vec<u8>,
    format: ImageFormat,
    /// Place in the file.
    at: String,
}

impl Encoded {
    /// Reads the header. Only 8 and 16 bits a channel of PNG and JPEG are known; the content decides, not the name.
    pub fn open(bytes: Vec<u8>, at: String, meter: &mut Meter) -> Result<Encoded, Cause> {
        let format = match sniff::describe(&bytes) {
            "a PNG picture" => ImageFormat::Png,
            "a JPEG picture" => ImageFormat::Jpeg,
            found => return Err(Cause::Content { found: found.into(), expected: "a PNG or JPEG picture" }),
        };
        let size = || Ok(reader(&bytes, format).into_decoder().map_err(syntax)?.dimensions());
        let (width, height) = guarded(size)?;
        meter.take_pixels(width.into(), height.into())?;
        Ok(Encoded { bytes, format, at })
    }

    /// Decodes the pixels.
    pub fn decode(&self) -> Result<Image, Cause> {
        let picture = guarded(|| {
            let decoder = reader(&self.bytes, self.format).into_decoder().map_err(syntax)?;
            DynamicImage::from_decoder(decoder).map_err(syntax)
        })?;
        let (width, height) = (picture.width(), picture.height());
        let deep = matches!(
            picture,
            DynamicImage::ImageLuma16(_)
                | DynamicImage::ImageLumaA16(_)
                | DynamicImage::ImageRgb16(_)
                | DynamicImage::ImageRgba16(_)
        );
        let texels = match deep {
            true => Texels::Unorm16(picture.into_rgba16().into_raw()),
            false => Texels::Unorm8(picture.into_rgba8().into_raw()),
        };
        Ok(Image { name: self.at.clone(), width, height, texels })
    }
}

/// Decodes pictures on all cores; the results, with their places in the file, are in the order given.
pub(super) fn decode_all(pictures: Vec<Encoded>) -> Vec<(String, Result<Image, Cause>)> {
    pictures.into_par_iter().map(|picture| (picture.at.clone(), picture.decode())).collect()
}

fn reader(bytes: &[u8], format: ImageFormat) -> ImageReader<Cursor<&[u8]>> {
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    // Sizes are checked against our own budget. The crate's default cap of 512 MiB stays as a second net against
    // ancillary data that unpacks to more than the pixels do.
    reader.limits(Limits::default());
    reader
}

fn syntax(error: image::ImageError) -> Cause {
    Cause::Syntax(error.to_string())
}
