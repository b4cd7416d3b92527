//! What a drag of a handle means in the world: rules without a window.

use burnish_core::scene::Ray;
use eframe::egui::Pos2;
use glam::{Quat, Vec3};

use super::sight::Sight;

/// How flat a plane may be seen before a turn in it is read off the screen.
const FLAT: f32 = 0.15;
/// Degrees to which a turn snaps.
const SNAP_DEG: f32 = 15.0;
/// Part of a power of ten to which moves snap, see [`snap_step`].
const SNAP_MOVE: f32 = 0.1;
/// Share to which scales snap.
const SNAP_SCALE: f32 = 0.1;

/// What the handles do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Mode {
    /// Moves.
    #[default]
    Move,
    /// Turns.
    Rotate,
    /// Scales.
    Scale,
}

/// A handle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Handle {
    /// Of an axis: 0 x, 1 y, 2 z.
    Axis(usize),
    /// In the middle: in the plane of the screen, or along all axes.
    Center,
}

/// What a drag did since it began.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change {
    /// Metres.
    Move(Vec3),
    /// About the origin of the handles.
    Rotate(Quat),
    /// Factors along the axes.
    Scale(Vec3),
}

/// A drag of a handle from one point of the window to another.
#[derive(Clone, Copy, Debug)]
pub struct Drag {
    /// What is dragged.
    pub mode: Mode,
    /// By which handle.
    pub handle: Handle,
    /// Where the handles stand, in the world, when the drag begins.
    pub origin: Vec3,
    /// Where the pointer was then.
    pub from: Pos2,
    /// In steps.
    pub snaps: bool,
}

impl Drag {
    /// What it means to have the pointer at `to`; `None` where that is nowhere, such as behind the camera.
    pub fn to(&self, sight: &Sight, to: Pos2) -> Option<Change> {
        Some(match (self.mode, self.handle) {
            (Mode::Move, Handle::Axis(axis)) => {
                let metres = self.along(sight, axis, to)? - self.along(sight, axis, self.from)?;
                let metres = self.snapped(metres, SNAP_MOVE * snap_step(sight.metres_per_point(self.origin)?));
                Change::Move(metres * Vec3::AXES[axis])
            }
            (Mode::Move, Handle::Center) => {
                let plane = Vec3::from(sight.camera.world_from_view.matrix3.z_axis);
                Change::Move(meet(sight.ray(to), self.origin, plane)? - meet(sight.ray(self.from), self.origin, plane)?)
            }
            (Mode::Rotate, Handle::Axis(axis)) => {
                let radians = self.angle(sight, Vec3::AXES[axis], to)?;
                Change::Rotate(Quat::from_axis_angle(Vec3::AXES[axis], self.snapped(radians, SNAP_DEG.to_radians())))
            }
            (Mode::Rotate, Handle::Center) => {
                let axis = sight.toward_eye(self.origin);
                let radians = self.angle(sight, axis, to)?;
                Change::Rotate(Quat::from_axis_angle(axis, self.snapped(radians, SNAP_DEG.to_radians())))
            }
            (Mode::Scale, Handle::Axis(axis)) => {
                let (start, end) = (self.along(sight, axis, self.from)?, self.along(sight, axis, to)?);
                let factor = self.snapped(factor(end, start)?, SNAP_SCALE);
                let mut factors = Vec3::ONE;
                factors[axis] = factor;
                Change::Scale(factors)
            }
            (Mode::Scale, Handle::Center) => {
                // Outward to the right and up.
                let by = (to.x - self.from.x - (to.y - self.from.y)) / 100.0;
                Change::Scale(Vec3::splat(self.snapped(by.exp(), SNAP_SCALE)))
            }
        })
    }

    /// Metres along an axis from the origin to the point nearest to the ray through a point of the window.
    fn along(&self, sight: &Sight, axis: usize, at: Pos2) -> Option<f32> {
        let (ray, axis) = (sight.ray(at), Vec3::AXES[axis]);
        let (offset, cos) = (ray.origin - self.origin, ray.direction.dot(axis));
        let sin2 = 1.0 - cos * cos;
        // An axis seen end on leads nowhere.
        (sin2 > 1e-4).then(|| (axis.dot(offset) - cos * ray.direction.dot(offset)) / sin2).filter(|t| t.is_finite())
    }

    /// The turn about an axis through the origin.
    fn angle(&self, sight: &Sight, axis: Vec3, to: Pos2) -> Option<f32> {
        let facing = axis.dot(sight.toward_eye(self.origin));
        if facing.abs() > FLAT {
            let [from, to] = [self.from, to].map(|at| meet(sight.ray(at), self.origin, axis).map(|p| p - self.origin));
            let (from, to) = (from?, to?);
            return Some(axis.dot(from.cross(to)).atan2(from.dot(to)));
        }
        // Seen from the side: along the ring as it is drawn, a turn for its width.
        let [center, tip] = [self.origin, self.origin + axis].map(|world| sight.project(world));
        let (along, middle) = ((tip? - center?).normalized(), center?);
        let across = along.rot90();
        let radius = (self.from - middle).length().max(40.0);
        Some((to - self.from).dot(across) / radius)
    }

    fn snapped(&self, value: f32, step: f32) -> f32 {
        if self.snaps { (value / step).round() * step } else { value }
    }
}

/// The power of ten next above a hundred points.
fn snap_step(metres_per_point: f32) -> f32 {
    10_f32.powf((100.0 * metres_per_point).max(1e-6).log10().ceil())
}

fn factor(end: f32, start: f32) -> Option<f32> {
    (start.abs() > 1e-9).then(|| (end / start).clamp(0.01, 100.0))
}

/// Where a ray meets a plane through a point; `None` where it looks away.
fn meet(ray: Ray, point: Vec3, normal: Vec3) -> Option<Vec3> {
    let distance = (point - ray.origin).dot(normal) / ray.direction.dot(normal);
    (distance.is_finite() && distance > 0.0).then(|| ray.origin + distance * ray.direction)
}

#[cfg(test)]
mod tests {
    use burnish_core::scene::Camera;
    use eframe::egui::{Rect, pos2};

    use super::*;

    const ORIGIN: Vec3 = Vec3::new(0.3, 0.8, -0.2);

    fn sight() -> Sight {
        let camera = Camera::look_at("c", Vec3::new(2.0, 3.0, 6.0), Vec3::new(0.0, 0.5, 0.0), 0.6);
        Sight { camera, rect: Rect::from_min_max(pos2(100.0, 40.0), pos2(740.0, 400.0)) }
    }

    fn drag(mode: Mode, handle: Handle, from: Vec3) -> Drag {
        Drag { mode, handle, origin: ORIGIN, from: sight().project(from).unwrap(), snaps: false }
    }

    #[test]
    fn what_is_dragged_along_an_axis_stays_under_the_pointer() {
        for axis in 0..3 {
            let grip = ORIGIN + 0.5 * Vec3::AXES[axis];
            let drag = drag(Mode::Move, Handle::Axis(axis), grip);
            let want = -0.37 * Vec3::AXES[axis];
            let to = sight().project(grip + want).unwrap();
            let Some(Change::Move(by)) = drag.to(&sight(), to) else { panic!("no move") };
            assert!((by - want).length() < 1e-3, "{by}");
            // Only what is along the axis counts.
            let Some(Change::Move(by)) = drag.to(&sight(), to + eframe::egui::vec2(3.0, 5.0)) else {
                panic!("no move")
            };
            assert!(by.cross(Vec3::AXES[axis]).length() < 1e-6);
        }
        let across = Vec3::from(sight().camera.world_from_view.matrix3.x_axis) * 0.4;
        let Some(Change::Move(by)) =
            drag(Mode::Move, Handle::Center, ORIGIN).to(&sight(), sight().project(ORIGIN + across).unwrap())
        else {
            panic!("no move")
        };
        assert!((by - across).length() < 1e-2, "{by}");
    }

    #[test]
    fn a_ring_turns_by_the_angle_of_the_pointer_about_it() {
        for axis in 0..3 {
            let (normal, start) = (Vec3::AXES[axis], 0.6 * Vec3::AXES[(axis + 1) % 3]);
            let drag = drag(Mode::Rotate, Handle::Axis(axis), ORIGIN + start);
            let turn = Quat::from_axis_angle(normal, 0.9);
            let to = sight().project(ORIGIN + turn * start).unwrap();
            let Some(Change::Rotate(got)) = drag.to(&sight(), to) else { panic!("no turn") };
            assert!(got.dot(turn).abs() > 1.0 - 1e-4, "axis {axis}: {got}");
            let Some(Change::Rotate(got)) = Drag { snaps: true, ..drag }.to(&sight(), to) else { panic!("no turn") };
            let degrees = got.to_axis_angle().1.to_degrees();
            assert!((degrees / 15.0 - (degrees / 15.0).round()).abs() < 1e-3, "{degrees}");
        }
    }

    #[test]
    fn scales_grow_outward_and_never_reach_zero() {
        let grip = ORIGIN + 0.5 * Vec3::Y;
        let drag = drag(Mode::Scale, Handle::Axis(1), grip);
        let at = |factor: f32| drag.to(&sight(), sight().project(ORIGIN + 0.5 * factor * Vec3::Y).unwrap());
        let Some(Change::Scale(by)) = at(1.5) else { panic!("no scale") };
        assert!((by - Vec3::new(1.0, 1.5, 1.0)).length() < 1e-3, "{by}");
        let Some(Change::Scale(by)) = at(-2.0) else { panic!("no scale") };
        assert!(by.y > 0.0, "{by}");
    }

    #[test]
    fn an_axis_seen_end_on_moves_nothing() {
        let camera = Camera::look_at("c", ORIGIN + 5.0 * Vec3::Z, ORIGIN, 0.6);
        let sight = Sight { camera, ..sight() };
        let drag = Drag { from: sight.rect.center(), ..drag(Mode::Move, Handle::Axis(2), ORIGIN) };
        assert_eq!(drag.to(&sight, sight.rect.center()), None);
    }
}
