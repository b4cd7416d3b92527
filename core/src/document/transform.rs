//! Where the user put an object of the model.

use glam::{Affine3A, EulerRot, Mat3, Quat, Vec3};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::{Document, is_default};

/// Least factor of a scale: an object without extent cannot be lit.
const SCALE_MIN: f64 = 1e-4;
/// Largest.
const SCALE_MAX: f64 = 1e4;
/// Farthest move in metres.
const MOVE_MAX: f64 = 1e6;

/// A move, turn and scale of an object from its place in the model, about the centre of its box there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TransformEntry {
    /// Metres along the axes of the world.
    #[serde(rename = "move", default, skip_serializing_if = "is_default")]
    pub by: [f64; 3],
    /// Degrees about x, y and z: first about z, then x, then y, axes of the world.
    #[serde(default, skip_serializing_if = "is_default")]
    pub rotate_deg: [f64; 3],
    /// Factors along the axes of the world, before the turn.
    #[serde(default = "ones", skip_serializing_if = "is_ones")]
    pub scale: [f64; 3],
    /// Fields that this version does not know.
    #[serde(flatten)]
    pub other: Map<String, Value>,
}

fn ones() -> [f64; 3] {
    [1.0; 3]
}

fn is_ones(scale: &[f64; 3]) -> bool {
    *scale == ones()
}

impl Default for TransformEntry {
    fn default() -> Self {
        TransformEntry { by: [0.0; 3], rotate_deg: [0.0; 3], scale: ones(), other: Map::new() }
    }
}

impl TransformEntry {
    /// The turn. Numbers that are none count as 0.
    pub fn rotation(&self) -> Quat {
        let [x, y, z] = self.rotate_deg.map(|angle| bounded(angle, -3.6e5, 3.6e5, 0.0).to_radians() as f32);
        Quat::from_euler(EulerRot::YXZ, y, x, z)
    }

    /// Turns to this.
    pub fn set_rotation(&mut self, rotation: Quat) {
        let (y, x, z) = rotation.normalize().to_euler(EulerRot::YXZ);
        self.rotate_deg = [x, y, z].map(|angle| f64::from(angle.to_degrees()));
    }

    /// The place in the world of an object whose place in the model is `world_from_local` with its box about `center`.
    /// Always finite and invertible where that is.
    pub fn place(&self, world_from_local: Affine3A, center: Vec3) -> Affine3A {
        let vector = |values: [f64; 3]| Vec3::from_array(values.map(|value| value as f32));
        let by = vector(self.by.map(|metres| bounded(metres, -MOVE_MAX, MOVE_MAX, 0.0)));
        let scale = vector(self.scale.map(|factor| {
            let size = bounded(factor.abs(), SCALE_MIN, SCALE_MAX, 1.0);
            if factor < 0.0 { -size } else { size }
        }));
        let matrix = Mat3::from_quat(self.rotation()) * Mat3::from_diagonal(scale);
        let about = Affine3A::from_mat3_translation(matrix, by + center - matrix * center);
        about * world_from_local
    }
}

fn bounded(value: f64, min: f64, max: f64, otherwise: f64) -> f64 {
    if value.is_finite() { value.clamp(min, max) } else { otherwise }
}

impl Document {
    /// Where the user put an object; that of the model where nothing is stored.
    pub fn transform(&self, key: &str) -> TransformEntry {
        let entry = self.objects.iter().find(|entry| entry.key == key);
        entry.and_then(|entry| entry.transform.clone()).unwrap_or_default()
    }

    /// Puts an object somewhere, or back where the model has it.
    pub fn set_transform(&mut self, key: &str, transform: TransformEntry) {
        self.edit_object(key, |entry| entry.transform = Some(transform).filter(|t| *t != TransformEntry::default()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Curves, DEFAULT_SCENE, open, resolve};

    #[test]
    fn an_object_turns_and_grows_about_its_centre_and_moves_with_it() {
        let opened = open(DEFAULT_SCENE).unwrap();
        let mut document = opened.document;
        let resolved = |document: &Document| resolve(document, &opened.sources, &mut Curves::default());
        let before = resolved(&document);
        let (key, first) = (before.object_keys[0].clone(), &before.scene.instances[0]);
        let mesh = &before.scene.meshes[first.mesh];
        let center = first.bounds(mesh).center();
        let mut put = TransformEntry { by: [0.5, 0.0, -1.0], scale: [2.0, 1.0, 1.0], ..TransformEntry::default() };
        put.set_rotation(Quat::from_rotation_y(0.7) * Quat::from_rotation_x(0.2));
        document.set_transform(&key, put.clone());
        let after = resolved(&document).scene.instances[0].clone();
        let local = first.world_from_local.inverse().transform_point3(center);
        let moved = after.world_from_local.transform_point3(local);
        assert!((moved - center - Vec3::new(0.5, 0.0, -1.0)).length() < 1e-4, "{moved}");
        let grown = after.world_from_local.matrix3.determinant() / first.world_from_local.matrix3.determinant();
        assert!((grown - 2.0).abs() < 1e-3, "{grown}");
        let text = serde_json::to_string(&document.transform(&key)).unwrap();
        assert_eq!(serde_json::from_str::<TransformEntry>(&text).unwrap(), put, "{text}");
        document.set_transform(&key, TransformEntry::default());
        assert!(document.objects.is_empty());
    }

    #[test]
    fn turns_are_read_back_and_nonsense_places_nothing_out_of_reach() {
        for turn in
            [Quat::from_rotation_x(1.2), Quat::from_rotation_z(-2.9), Quat::from_euler(EulerRot::XYZ, 0.3, 1.4, 2.0)]
        {
            let mut entry = TransformEntry::default();
            entry.set_rotation(turn);
            assert!(entry.rotation().dot(turn).abs() > 1.0 - 1e-5, "{turn}");
        }
        let nonsense = TransformEntry {
            by: [f64::NAN, f64::INFINITY, 1e300],
            rotate_deg: [f64::NAN, 1e300, 0.0],
            scale: [0.0, f64::NAN, -1e300],
            other: Map::new(),
        };
        let placed = nonsense.place(Affine3A::IDENTITY, Vec3::ONE);
        assert!(placed.is_finite() && placed.matrix3.determinant() != 0.0, "{placed:?}");
    }
}
