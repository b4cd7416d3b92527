//! Outlines in the half plane (distance from the axis, height), made of lines and arcs with exact normals.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::Vec2;

/// An outline in metres: x is the distance from the axis, y the height. The body is on the right of the way along it
/// and the outside on the left, so the outline of a solid goes from the top of the axis over the outside to the bottom.
///
/// Where two pieces meet at an angle the surface has a crease.
#[derive(Clone, Debug, Default)]
pub struct Profile {
    /// Smooth pieces in order, each with at least two points; the last point of one is the first of the next.
    pub(super) pieces: Vec<Vec<ProfilePoint>>,
    /// Where a line would start.
    here: Option<Vec2>,
}

/// A point of a [`Profile`].
#[derive(Clone, Copy, Debug)]
pub(super) struct ProfilePoint {
    /// Distance from the axis, height.
    pub at: Vec2,
    /// Unit, to the outside.
    pub normal: Vec2,
    /// Metres along the whole profile.
    pub length: f32,
}

/// A corner of a polygon whose corners are rounded.
#[derive(Clone, Copy, Debug)]
pub struct Corner {
    /// Distance from the axis, height; metres.
    pub at: Vec2,
    /// Radius of the arc that replaces the corner, 0 for a crease.
    pub radius: f32,
}

impl Corner {
    /// A crease.
    pub fn sharp(x: f32, y: f32) -> Corner {
        Corner::round(x, y, 0.0)
    }

    /// A rounded corner.
    pub fn round(x: f32, y: f32, radius: f32) -> Corner {
        Corner { at: Vec2::new(x, y), radius }
    }
}

/// Points nearer than this (metres) are the same: the rounding of sines and cosines on bodies up to some metres.
const SAME_POINT: f32 = 2e-6;

impl Profile {
    /// An empty outline.
    pub fn new() -> Profile {
        Profile::default()
    }

    /// A straight line to a point; the first call only sets the start.
    pub fn to(self, point: Vec2) -> Profile {
        self.line(point, 1)
    }

    /// A straight line in several segments.
    pub fn line(mut self, point: Vec2, segments: usize) -> Profile {
        let point = on_axis(point);
        let Some(start) = self.here else {
            self.here = Some(point);
            return self;
        };
        if start.distance(point) < SAME_POINT {
            return self;
        }
        let normal = (point - start).normalize().perp();
        let piece = (0..=segments).map(|i| (start.lerp(point, i as f32 / segments as f32), normal));
        self.push(piece.collect());
        self
    }

    /// An arc from angle `from` to angle `to` (radians counter-clockwise from the +x axis of the half plane), after a
    /// straight line to its start where there is a gap. A falling angle bulges outwards, a rising one inwards.
    pub fn arc(self, center: Vec2, radius: f32, from: f32, to: f32, segments: usize) -> Profile {
        let outward = if to < from { 1.0 } else { -1.0 };
        let segments = segments.max(1);
        let mut points: Vec<(Vec2, Vec2)> = (0..=segments)
            .map(|i| {
                let direction = Vec2::from_angle(from + (to - from) * (i as f32 / segments as f32));
                (on_axis(center + radius * direction), outward * direction)
            })
            .collect();
        if (to - from).abs() == TAU {
            points[segments] = points[0];
        }
        let mut profile = self.to(points[0].0);
        profile.push(points);
        profile
    }

    /// A line back to the start, for a ring-shaped body.
    pub fn closed(mut self) -> Profile {
        let Some(start) = self.pieces.first().map(|piece| piece[0].at) else { return self };
        self = self.to(start);
        // The end is the start, not within rounding of it; where the closing is smooth, so is the normal.
        let first_normal = self.pieces[0][0].normal;
        if let Some(last) = self.pieces.last_mut().and_then(|piece| piece.last_mut()) {
            last.at = start;
            last.normal = joined(last.normal, first_normal);
        }
        self
    }

    /// An open polygon with rounded corners, `segments` to a quarter turn. Corners may turn either way.
    pub fn rounded(corners: &[Corner], segments: usize) -> Profile {
        let mut profile = Profile::new();
        for (i, corner) in corners.iter().enumerate() {
            let neighbours = i.checked_sub(1).and_then(|before| Some((corners[before].at, corners.get(i + 1)?.at)));
            profile = match neighbours {
                Some((before, after)) if corner.radius > 0.0 => profile.fillet(before, *corner, after, segments),
                _ => profile.to(corner.at),
            };
        }
        profile
    }

    /// The arc that touches both sides of a corner.
    fn fillet(self, before: Vec2, corner: Corner, after: Vec2, segments: usize) -> Profile {
        let (into, out) = ((corner.at - before).normalize_or_zero(), (after - corner.at).normalize_or_zero());
        let turn = into.angle_to(out);
        if turn.abs() < 1e-4 || turn.abs() > PI - 1e-4 {
            return self.to(corner.at);
        }
        // The centre lies on the side to which the way turns.
        let side = turn.signum();
        let start = corner.at - into * (corner.radius * (0.5 * turn.abs()).tan());
        let center = start + side * corner.radius * into.perp();
        let from = (start - center).to_angle();
        let count = (segments as f32 * turn.abs() / FRAC_PI_2).ceil().max(1.0) as usize;
        self.arc(center, corner.radius, from, from + turn, count)
    }

    /// Metres from the start to the end.
    pub fn length(&self) -> f32 {
        self.pieces.last().and_then(|piece| piece.last()).map_or(0.0, |point| point.length)
    }

    /// Greatest distance from the axis.
    pub fn widest(&self) -> f32 {
        self.pieces.iter().flatten().fold(0.0, |widest, point| point.at.x.max(widest))
    }

    /// Adds a smooth piece that starts where the last one ended.
    fn push(&mut self, mut points: Vec<(Vec2, Vec2)>) {
        if let (Some(here), Some(first)) = (self.here, points.first_mut()) {
            first.0 = here;
            if let Some(last) = self.pieces.last().and_then(|piece| piece.last()) {
                first.1 = joined(first.1, last.normal);
            }
        }
        let mut length = self.length();
        let mut before = points[0].0;
        let piece: Vec<ProfilePoint> = points
            .into_iter()
            .map(|(at, normal)| {
                length += at.distance(before);
                before = at;
                ProfilePoint { at, normal, length }
            })
            .collect();
        self.here = Some(before);
        self.pieces.push(piece);
    }
}

/// The normal at a joint: that of the other piece when both mean the same direction, so that both pieces give the same
/// vertices.
fn joined(own: Vec2, other: Vec2) -> Vec2 {
    if own.distance(other) < 1e-3 { other } else { own }
}

/// Snaps to the axis what misses it by rounding, so that poles are single points.
fn on_axis(point: Vec2) -> Vec2 {
    debug_assert!(point.x > -SAME_POINT, "a profile stays on its side of the axis");
    if point.x < SAME_POINT { Vec2::new(0.0, point.y) } else { point }
}
