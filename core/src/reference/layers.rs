//! A film as an OpenEXR file: the mean where every viewer looks, and beside it what is known about each pixel.

use std::path::Path;

use glam::DVec3;

use super::checkpoint::masking_word;
use super::{Film, Options, Pixel, View, World};
use crate::file::{Attribute, Channel, FileError, Samples, write_exr_with};

impl Film {
    /// Writes the film: `R G B` are the mean; `variance` is [`Pixel::variance`], `N` the mean normal, `albedo` the mean
    /// albedo, `id` the numbers of instance and material in the scene ([`super::NOTHING`], 4294967295, for the
    /// background). Attributes tell how it was made. Nothing in it depends on the time that it took.
    pub fn write_exr(&self, world: &World, view: &View, path: &Path) -> Result<(), FileError> {
        write_exr_with(&self.picture(), self.channels(), &self.attributes(world, view), path)
    }

    fn channels(&self) -> Vec<Channel> {
        let float = |name, of: &dyn Fn(&Pixel) -> f64| Channel {
            name,
            samples: Samples::Float(self.pixels().iter().map(|p| of(p) as f32).collect()),
        };
        let whole = |name, of: &dyn Fn(&Pixel) -> u32| Channel {
            name,
            samples: Samples::Whole(self.pixels().iter().map(of).collect()),
        };
        type Vector = fn(&Pixel) -> DVec3;
        let vectors: [([&'static str; 3], Vector); 3] = [
            (["variance.R", "variance.G", "variance.B"], Pixel::variance),
            (["N.X", "N.Y", "N.Z"], Pixel::mean_normal),
            (["albedo.R", "albedo.G", "albedo.B"], Pixel::mean_albedo),
        ];
        let mut channels = vec![whole("id.instance", &|p| p.instance), whole("id.material", &|p| p.material)];
        for (names, vector) in vectors {
            channels.extend(names.into_iter().enumerate().map(|(axis, name)| float(name, &|p| vector(p)[axis])));
        }
        channels
    }

    fn attributes(&self, world: &World, view: &View) -> Vec<(&'static str, Attribute)> {
        let Options { bounces, clamp, masking, multiple_scattering, contribution: _ } = *world.options();
        let switch = |on: bool| Attribute::Text(if on { "on" } else { "off" }.into());
        let whole = |value: u32| Attribute::Whole(i32::try_from(value).unwrap_or(i32::MAX));
        vec![
            ("burnish.method", Attribute::Text(super::ID.into())),
            ("burnish.samples", whole(self.samples())),
            ("burnish.seed", Attribute::Number(view.seed.into())),
            ("burnish.bounces", whole(bounces)),
            ("burnish.clamp", Attribute::Number(clamp.into())),
            ("burnish.masking", Attribute::Text(masking_word(masking).into())),
            ("burnish.multiple-scattering", switch(multiple_scattering)),
            ("burnish.spectral", switch(world.wavelengths().is_some())),
            ("burnish.error", Attribute::Number(self.error())),
            ("burnish.rejected", Attribute::Number(self.rejected() as f64)),
            ("burnish.clamped-share", Attribute::Number(self.clamped_share())),
        ]
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use exr::meta::attribute::AttributeValue;
    use exr::prelude::{FlatSamples, read_all_flat_layers_from_file};
    use glam::{UVec2, Vec3};

    use super::*;
    use crate::file::read_picture;
    use crate::file::testing::Folder;
    use crate::reference::{Control, FirstHit, NOTHING, Pass, PathSample, trace_with};
    use crate::scene::{Bounds, Camera};

    #[test]
    fn a_film_is_read_as_its_mean_and_holds_what_is_known_of_each_pixel() {
        let path = |pixel: UVec2, index: u32| {
            let hit = FirstHit { normal: Vec3::Y, albedo: Vec3::splat(0.5), instance: 4, material: 2 };
            let first = (pixel.x == 1).then_some(hit);
            PathSample { radiance: Vec3::new(index as f32, 1.0, 0.0), clamped: Vec3::ZERO, first, rays: 1 }
        };
        let mut film = Film::new(UVec2::new(2, 1));
        assert_eq!(trace_with(&mut film, 4, &Control::default(), path), Pass::Whole);
        let folder = Folder::new();
        let file = folder.join("a.exr");
        let world = World::new(&Arc::default(), Options::default());
        let view = View { camera: Camera::frame(Bounds::EMPTY, 2.0), size: film.size(), seed: u32::MAX };
        film.write_exr(&world, &view, &file).unwrap();
        assert!(read_picture(&file).unwrap().0 == film.picture());

        let image = read_all_flat_layers_from_file(&file).unwrap();
        let layer = &image.layer_data[0];
        let channel = |name: &str| match &layer.channel_data.list.iter().find(|c| c.name == *name).unwrap().sample_data
        {
            FlatSamples::F32(values) => values.iter().map(|v| f64::from(*v)).collect::<Vec<_>>(),
            FlatSamples::U32(values) => values.iter().map(|v| f64::from(*v)).collect(),
            FlatSamples::F16(_) => panic!("halves"),
        };
        assert_eq!(layer.channel_data.list.len(), 14);
        assert_eq!((channel("R"), channel("G"), channel("B")), (vec![1.5; 2], vec![1.0; 2], vec![0.0; 2]));
        // 0, 1, 2, 3: s² = 5/3, of the mean a quarter.
        assert!((channel("variance.R")[0] - 5.0 / 12.0).abs() < 1e-6, "{:?}", channel("variance.R"));
        assert_eq!(channel("variance.G"), [0.0, 0.0]);
        assert_eq!((channel("N.Y"), channel("albedo.B")), (vec![0.0, 1.0], vec![0.0, 0.5]));
        assert_eq!(channel("id.instance"), [f64::from(NOTHING), 4.0]);
        assert_eq!(channel("id.material"), [f64::from(NOTHING), 2.0]);
        let fact = |name: &str| layer.attributes.other[name.as_bytes()].clone();
        assert_eq!(fact("burnish.samples"), AttributeValue::I32(4));
        assert_eq!(fact("burnish.seed"), AttributeValue::F64(4294967295.0));
        assert_eq!(fact("burnish.error"), AttributeValue::F64(film.error()));
        assert_eq!(fact("burnish.clamp"), AttributeValue::F64(f64::INFINITY));
    }
}
