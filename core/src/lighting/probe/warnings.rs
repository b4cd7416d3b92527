//! Where probes fail, told before it is seen.

use glam::Vec3;

use super::{Probes, Sites};
use crate::lighting::Prepared;
use crate::scene::Scene;

/// Share of directions that see a surface from behind, from which a probe is taken to be inside of something.
const INSIDE: f32 = 0.3;
/// Share of directions without a distance, from which a probe is said to know little.
const SKY: f32 = 0.98;

/// What will look wrong, and what helps.
pub fn warnings(scene: &Scene, sites: &Sites, prepared: &Prepared) -> Vec<String> {
    if sites.list.is_empty() {
        let cause = "no probe serves anything that has surroundings: the environment is shown as by `classical`";
        return vec![format!("{cause}; select objects and add a probe for them")];
    }
    let mut list = Vec::new();
    for (site, probe) in sites.list.iter().zip(Probes::of(prepared).iter()) {
        let name = &site.name;
        let [sky, behind] = *probe.maps.floats("shares") else { continue };
        if behind > INSIDE {
            let share = 100.0 * behind;
            list.push(format!(
                "probe `{name}` sees {share:.0} % of its surroundings from behind: it stands inside of an object; move it, or let it \
                 serve that object"
            ));
        }
        if sky > SKY {
            list.push(format!("probe `{name}` sees almost nothing but the sky: it shows the same as `classical`"));
        }
        if let Some(beyond) = beyond(scene, &site.served, &probe) {
            list.push(format!(
                "what probe `{name}` serves reaches {beyond:.3} m beyond the surroundings that it sees: reflections there are guesses; \
                 add a probe nearer to it"
            ));
        }
    }
    list
}

/// By how much the served objects are farther from the probe than its surroundings, if they are; told by the corners of their
/// boxes' faces.
fn beyond(scene: &Scene, served: &[u32], probe: &super::Probe<'_>) -> Option<f32> {
    let mut most = 0.0_f32;
    for instance in served.iter().filter_map(|i| scene.instances.get(*i as usize)) {
        let bounds = instance.bounds(&scene.meshes[instance.mesh]);
        let (center, half) = (bounds.center(), 0.5 * (bounds.max - bounds.min));
        for axis in [Vec3::X, Vec3::Y, Vec3::Z].into_iter().flat_map(|axis| [axis, -axis]) {
            let from_probe = center + axis * half - probe.middle;
            let (length, distance) = (from_probe.length(), probe.distances.distance(from_probe.normalize_or(axis)));
            if distance > 0.0 {
                most = most.max(length - distance);
            }
        }
    }
    // What stands on a floor touches it.
    let slack = 0.02 * probe.extent.far;
    (most > slack).then_some(most)
}
