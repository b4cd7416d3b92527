use super::study::apart;
use super::*;
use crate::math::sampling::Random;

const REFERENCE: &str = include_str!("../../../../tests/data/reference/impostor_cubic_room.csv");

/// Of a cubic room from -1 to 1, seen from its middle.
fn room(d: Vec3) -> f32 {
    d.abs().max_element().recip()
}

const ROOM: Extent = Extent { near: 1.0, far: 1.733, radius: 1.25, low: Vec3::NEG_ONE, high: Vec3::ONE };

fn effort(solver: Solver, refinements: u32) -> Effort {
    Effort { solver, refinements, steps: 32, tolerance: f32::INFINITY }
}

fn unit(random: &mut Random) -> Vec3 {
    let u = random.point2();
    let (sin, cos) = (std::f32::consts::TAU * u.x).sin_cos();
    let z = 1.0 - 2.0 * u.y;
    let level = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
    Vec3::new(level * cos, level * sin, z).normalize()
}

fn within(random: &mut Random, half: f32) -> Vec3 {
    let (a, b) = (random.point2(), random.point2());
    (Vec3::new(a.x, a.y, b.x) * 2.0 - 1.0) * half
}

/// Where a ray leaves the cubic room.
fn exact(x: Vec3, r: Vec3) -> f32 {
    proxy::cuboid(x, r, Vec3::NEG_ONE, Vec3::ONE).unwrap()
}

#[test]
fn guesses_and_secant_steps_are_those_of_the_reference_values() {
    let mut rows = 0;
    for line in REFERENCE.lines().skip(1) {
        let v: Vec<f32> = line.split(',').map(|number| number.parse().unwrap()).collect();
        let (x, r) = (Vec3::new(v[0], v[1], v[2]), Vec3::new(v[3], v[4], v[5]));
        let near = |found: f32, wanted: f32, what: &str| {
            assert!((found - wanted).abs() <= 1e-5 * wanted.abs().max(1.0), "{what}: {found} {wanted} at {x} {r}");
        };
        near(exact(x, r), v[6], "exact");
        near(solve(&room, &ROOM, x, r, &effort(Solver::Perpendicular, 0)).t, v[7], "perpendicular");
        for refinements in 0..=5 {
            let found = solve(&room, &ROOM, x, r, &effort(Solver::Secant, refinements));
            near(found.t, v[8 + refinements as usize], &format!("secant {refinements}"));
        }
        rows += 1;
    }
    assert_eq!(rows, 60);
}

/// Median and 95 % of the errors in direction, degrees.
fn errors(solver: Solver, refinements: u32) -> [f32; 2] {
    let mut random = Random::new(7);
    let mut all: Vec<f32> = (0..200_000)
        .map(|_| {
            let (x, r) = (within(&mut random, 0.7), unit(&mut random));
            let found = solve(&room, &ROOM, x, r, &effort(solver, refinements));
            let seen = if solver == Solver::Classical { r } else { x + found.t * r };
            apart(seen, x + exact(x, r) * r)
        })
        .collect();
    all.sort_by(f32::total_cmp);
    [all[all.len() / 2], all[all.len() * 95 / 100]]
}

/// Computed apart from this code over 200 000 points: median and 95 %, degrees.
#[test]
fn a_cubic_room_has_the_errors_that_were_computed_for_it() {
    for (solver, refinements, median, most) in [
        (Solver::Classical, 0, 25.7, 49.6),
        (Solver::Secant, 0, 0.0, 3.46),
        (Solver::Secant, 1, 0.0, 0.0),
        (Solver::Secant, 3, 0.0, 0.0),
        (Solver::Mixed, 0, 0.0, 3.46),
        (Solver::Mixed, 1, 0.0, 1.28),
        (Solver::Mixed, 3, 0.0, 0.22),
        (Solver::FalsePosition, 0, 11.07, 91.1),
        (Solver::FalsePosition, 1, 0.20, 27.3),
        (Solver::FalsePosition, 3, 0.0, 3.1),
        (Solver::SecantFromPoint, 0, 11.07, 91.1),
        (Solver::SecantFromPoint, 1, 3.17, 136.4),
        (Solver::SecantFromPoint, 3, 0.0, 136.4),
        (Solver::Box, 0, 0.0, 0.0),
        (Solver::March, 4, 0.0, 0.0),
    ] {
        let found = errors(solver, refinements);
        // 200 000 points tell a quantile to some percent, floats an angle to a hundredth of a degree.
        for (found, wanted) in found.into_iter().zip([median, most]) {
            assert!((found - wanted).abs() <= 0.05 + 0.05 * wanted, "{solver:?} {refinements}: {found} {wanted}");
        }
    }
}

/// A ball in the room, beside the middle.
const BALL: (Vec3, f32) = (Vec3::new(0.45, 0.1, 0.3), 0.25);

fn ball(x: Vec3, r: Vec3) -> Option<f32> {
    let o = x - BALL.0;
    let (b, c) = (o.dot(r), o.length_squared() - BALL.1 * BALL.1);
    let root = b * b - c;
    (root > 0.0).then(|| -b - root.sqrt()).filter(|t| *t > 1e-4)
}

fn cluttered(d: Vec3) -> f32 {
    ball(Vec3::ZERO, d).unwrap_or(f32::INFINITY).min(room(d))
}

/// Where the middle sees something else, no solver can find the place; everywhere else marching does.
#[test]
fn behind_a_silhouette_a_secant_leaves_the_surface_and_marching_does_not() {
    let extent = Extent { near: 0.25, ..ROOM };
    let mut random = Random::new(3);
    let (mut rays, mut lost_secant, mut lost_march) = (0, 0, 0);
    for _ in 0..200_000 {
        let (x, r) = (within(&mut random, 0.9), unit(&mut random));
        let t = ball(x, r).unwrap_or(f32::INFINITY).min(exact(x, r));
        let place = x + t * r;
        let is_seen = |p: Vec3| (p.length() / cluttered(p.normalize()) - 1.0).abs() < 1e-4;
        if (x - BALL.0).length() < BALL.1 || x.length() > cluttered(x.normalize()) || !is_seen(place) {
            continue;
        }
        rays += 1;
        let lost = |solver, refinements| {
            let effort = Effort { solver, refinements, steps: 64, tolerance: 1e-3 };
            let found = solve(&cluttered, &extent, x, r, &effort);
            !found.is_hit || apart(x + found.t * r, place) > 1.0
        };
        lost_secant += u32::from(lost(Solver::Secant, 8));
        lost_march += u32::from(lost(Solver::March, 8));
    }
    assert!(rays > 100_000, "{rays}");
    let share = |lost: u32| f64::from(lost) / f64::from(rays);
    println!("lost: secant {:.4}, march {:.5}", share(lost_secant), share(lost_march));
    // The ball hides little from the middle; what is larger costs a secant more.
    assert!((0.01..0.03).contains(&share(lost_secant)), "secant {}", share(lost_secant));
    // What a step of 64 jumps over: the edge of the ball, thinner than the step.
    assert!(share(lost_march) < 2e-3, "march {}", share(lost_march));
}

/// Surroundings that make sense nowhere.
fn nonsense(kind: u32, d: Vec3) -> f32 {
    match kind {
        0 => ((d.x * 131.0).sin() * (d.y * 77.0).cos() * 3.0).exp() * 0.2,
        1 => [0.0, 1e-12, 1.0, 1e12, f32::INFINITY, f32::NAN, -1.0][((d.x + d.z) * 3.5 + 7.0) as usize % 7],
        _ if d.y > 0.2 => 0.0,
        _ => room(d) * (1.0 + 0.3 * (9.0 * d.x).sin()),
    }
}

#[test]
fn whatever_the_surroundings_a_place_is_finite_and_not_behind_the_point() {
    for kind in 0..3 {
        let mut random = Random::new(kind.into());
        for i in 0..1_000_000u32 {
            let solver = Solver::ALL[i as usize % Solver::ALL.len()];
            let x = match i / 9 % 50 {
                0 => Vec3::ZERO,
                1 => within(&mut random, 1e-20),
                2 => within(&mut random, 1e6),
                3 => Vec3::X,
                _ => within(&mut random, 2.0),
            };
            let r = if i / 9 % 7 == 0 { Vec3::NEG_Y } else { unit(&mut random) };
            let steps = [0, 1, 7, 20][i as usize / 9 % 4];
            let effort = Effort { solver, refinements: i / 9 % 6, steps, tolerance: 0.01 };
            let extent = Extent { near: 0.1, far: 2.0, ..ROOM };
            let found = solve(&|d: Vec3| nonsense(kind, d), &extent, x, r, &effort);
            let direction = found.direction(x, r);
            assert!(found.t.is_finite() && found.t >= 0.0, "{kind} {effort:?} {x} {r}: {found:?}");
            assert!((direction.length() - 1.0).abs() < 1e-4, "{kind} {effort:?} {x} {r}: {direction}");
        }
    }
}

#[test]
fn a_sphere_is_exact_within_a_sphere_and_a_point_outside_finds_nothing() {
    let mut random = Random::new(5);
    for _ in 0..1000 {
        let (x, r) = (within(&mut random, 0.5), unit(&mut random));
        let found = solve(&room, &ROOM, x, r, &effort(Solver::Sphere, 0));
        assert!(((x + found.t * r).length() - ROOM.radius).abs() < 1e-5);
    }
    for solver in [Solver::Sphere, Solver::Box] {
        assert!(!solve(&room, &ROOM, Vec3::splat(2.0), Vec3::X, &effort(solver, 0)).is_hit);
    }
    // The way to the sky ends nowhere.
    let sky = |_: Vec3| 0.0;
    for solver in Solver::ALL.into_iter().filter(|solver| !matches!(solver, Solver::Sphere | Solver::Box)) {
        let strict = Effort { tolerance: 0.1, ..effort(solver, 4) };
        let found = solve(&sky, &ROOM, Vec3::new(0.2, 0.1, 0.0), Vec3::Y, &strict);
        assert!(!found.is_hit && found.direction(Vec3::X, Vec3::Y) == Vec3::Y, "{solver:?}");
    }
}

#[test]
fn near_surfaces_are_seen_sharper() {
    assert_eq!(level(3.0, 1.0, 1.0, 8.0), 3.0);
    assert!((level(3.0, 0.25, 1.0, 8.0) - 1.0).abs() < 1e-6);
    assert_eq!(level(3.0, 0.0, 1.0, 8.0), 0.0);
    assert_eq!(level(3.0, 1e30, 0.0, 8.0), 8.0);
}
