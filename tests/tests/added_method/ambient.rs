//! The method that is added: every surface is lit by the mean of the environment.

use burnish_core::job::Handle;
use burnish_core::lighting::{Cover, Coverage, Method, MethodError, MethodId, MethodInfo, Prepared, Reads, ShadePoint};
use burnish_core::param::{Affects, ParamKind, ParamSpec, ParamValue, Settings};
use burnish_core::reference::{SurfacePoint, World};
use glam::Vec3;

pub const ID: &str = "ambient";

#[derive(Debug)]
pub struct Ambient;

static INFO: MethodInfo = MethodInfo {
    id: MethodId(ID),
    title: "Ambient",
    summary: "The mean of the environment from everywhere.",
    params: &[
        ParamSpec {
            key: "gain",
            label: "Gain",
            unit: "",
            kind: ParamKind::Number { min: 0.0, max: 8.0, default: 1.0 },
            help: "Factor on the light.",
            affects: Affects::Frame,
        },
        ParamSpec {
            key: "rows",
            label: "Rows",
            unit: "of the map",
            kind: ParamKind::Integer { min: 1, max: 64, default: 64 },
            help: "Rows of the map that are averaged, from the top.",
            affects: Affects::Prepare,
        },
    ],
    coverage: Coverage {
        lamps: Cover::None,
        environment: Cover::Approximate,
        indirect_diffuse: Cover::None,
        indirect_glossy: Cover::None,
        emission: Cover::None,
    },
    reads: Reads { environment: true, ..Reads::NOTHING },
    revision: 1,
};

impl Method for Ambient {
    fn info(&self) -> &'static MethodInfo {
        &INFO
    }

    fn prepare(&self, world: &World, settings: &Settings, job: &Handle) -> Result<Prepared, MethodError> {
        if job.is_cancelled() {
            return Err(MethodError::Cancelled);
        }
        let Some(map) = &world.scene().environment else {
            return Err(MethodError::Unfit("there is no environment; give one with --env".into()));
        };
        let Some(ParamValue::Integer(rows)) = settings.get("rows") else { unreachable!("declared") };
        let count = ((rows as u32).min(map.height) * map.width) as usize;
        let sum: Vec3 = map.texels[..count].iter().sum();
        let mean = map.scale() * sum / count as f32;
        Ok(Prepared::nothing().with("mean", mean.to_array().to_vec()))
    }

    fn points(&self) -> Option<&dyn ShadePoint> {
        Some(self)
    }
}

impl ShadePoint for Ambient {
    fn radiance(&self, point: &SurfacePoint<'_>, prepared: &Prepared, settings: &Settings, _: [f32; 4]) -> Vec3 {
        let Some(ParamValue::Number(gain)) = settings.get("gain") else { unreachable!("declared") };
        gain as f32 * point.albedo() * prepared.vector("mean", 0)
    }
}
