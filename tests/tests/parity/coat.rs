//! The clear coat.

use burnish_core::surface::coat;
use burnish_core::surface::ggx::Masking;
use glam::{Vec2, Vec4};

use crate::grid::{self, ALPHAS, MASKINGS, v4};
use crate::harness::Case;

pub fn cases() -> Vec<Case> {
    vec![Case::new("coat: reflection and what passes", &coat::WGSL, COAT, inputs, |x| {
        let (wo, wi, masking) = (x[0].truncate(), x[1].truncate(), Masking::ALL[x[1].w as usize]);
        let reflected = coat::eval(wo, wi, x[2].x, masking);
        let both = Vec2::new(reflected, coat::transmission(wo, x[2].x, x[2].y, masking));
        [both.extend(0.0).extend(0.0)]
    })]
}

const COAT: &str = "
    let masking = u32(x[1].w);
    let reflected = coat_eval(x[0].xyz, x[1].xyz, x[2].x, masking);
    y[0] = vec4f(reflected, coat_transmission(x[0].xyz, x[2].x, x[2].y, masking), 0.0, 0.0);
";

fn inputs() -> Vec<[Vec4; 3]> {
    let mut inputs = Vec::new();
    for (i, (wo, wi)) in grid::pairs().into_iter().enumerate() {
        for alpha in ALPHAS {
            let weight = [0.0, 0.3, 1.0][i % 3];
            let widths = Vec4::new(alpha.y, weight, 0.0, 0.0);
            inputs.extend(MASKINGS.map(|masking| [v4(wo, 0.0), v4(wi, masking), widths]));
        }
    }
    inputs
}
