//! Axes of charts: where a value lies, and the ticks.

/// How values are laid out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scale {
    Linear,
    /// Decades; values at 0 and below lie at the start.
    Log,
    /// Signed decades beyond this magnitude, linear between.
    SignedLog(f64),
}

/// Values from one end of a chart to the other.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    pub title: &'static str,
    pub from: f64,
    pub to: f64,
    pub scale: Scale,
    /// Ascending.
    pub ticks: Vec<f64>,
}

impl Axis {
    pub fn linear(title: &'static str, from: f64, to: f64, step: f64) -> Axis {
        let count = ((to - from) / step).round() as usize;
        let ticks = (0..=count).map(|i| from + i as f64 * step).collect();
        Axis { title, from, to, scale: Scale::Linear, ticks }
    }

    /// From `from` to `to`, both above 0, with a tick at each power of ten.
    pub fn log(title: &'static str, from: f64, to: f64) -> Axis {
        let (first, last) = (from.log10().ceil() as i32, to.log10().floor() as i32);
        let ticks = (first..=last).map(|power| 10f64.powi(power)).collect();
        Axis { title, from, to, scale: Scale::Log, ticks }
    }

    /// Whole decades around values, at least one; those that are not above 0 do not count.
    pub fn decades(title: &'static str, values: impl Iterator<Item = f64>) -> Axis {
        let (least, most) = ends(values);
        let (from, to) = (least.log10().floor(), most.log10().ceil());
        Axis::log(title, 10f64.powf(from), 10f64.powf(to.max(from + 1.0)))
    }

    /// From the 1, 2 or 5 of a decade below values to that above, at least a step; ticks are those, or powers of ten over more than two
    /// decades. Values that are not above 0 do not count.
    pub fn around(title: &'static str, values: impl Iterator<Item = f64>) -> Axis {
        let (least, most) = ends(values);
        let (first, last) = (least.log10().floor() as i32, most.log10().ceil() as i32 + 1);
        let steps: Vec<f64> =
            (first..=last).flat_map(|power| [1.0, 2.0, 5.0].map(|digit| digit * 10f64.powi(power))).collect();
        // Powers are rounded.
        let below = steps.iter().rposition(|step| *step <= least * (1.0 + 1e-9)).unwrap_or(0);
        let above = steps.iter().position(|step| *step >= most * (1.0 - 1e-9)).unwrap_or(0).max(below + 1);
        let (from, to) = (steps[below], steps[above]);
        let all = Axis::log(title, from, to);
        if to > 100.0 * from { all } else { Axis { ticks: steps[below..=above].to_vec(), ..all } }
    }

    /// From `-to` to `to` in decades, linear within `linear` of 0; both powers of ten.
    pub fn signed_log(title: &'static str, linear: f64, to: f64) -> Axis {
        let (first, last) = (linear.log10().round() as i32, to.log10().round() as i32);
        let positive: Vec<f64> = (first..=last).map(|power| 10f64.powi(power)).collect();
        let negative = positive.iter().rev().map(|v| -v);
        let ticks = negative.chain([0.0]).chain(positive.iter().copied()).collect();
        Axis { title, from: -to, to, scale: Scale::SignedLog(linear), ticks }
    }

    /// Share of the way from start to end, 0 to 1; values beyond lie at the end, NaN at the start.
    pub fn at(&self, value: f64) -> f64 {
        let [value, from, to] = [value, self.from, self.to].map(|v| self.stretched(v));
        let share = (value - from) / (to - from);
        if share > 0.0 { share.min(1.0) } else { 0.0 }
    }

    fn stretched(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => value,
            Scale::Log => value.log10(),
            Scale::SignedLog(linear) => {
                let size = (value / linear).abs();
                value.signum() * if size > 1.0 { 1.0 + size.log10() } else { size }
            }
        }
    }
}

/// Least and greatest of the values above 0; 1 where there are none.
fn ends(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let positive = values.filter(|v| v.is_finite() && *v > 0.0);
    let ends = positive.fold((f64::INFINITY, 0.0_f64), |(least, most), value| (least.min(value), most.max(value)));
    if ends.1 > 0.0 { ends } else { (1.0, 1.0) }
}

/// A tick in words: at most as many digits as it needs.
pub fn tick(value: f64) -> String {
    format!("{}", (value * 1e6).round() / 1e6 + 0.0).replace('-', "\u{2212}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_near(a: f64, b: f64) -> bool {
        (a - b).abs() < 1e-12
    }

    #[test]
    fn a_linear_axis_has_its_ends_at_its_ends_and_keeps_values_inside() {
        let axis = Axis::linear("x", 0.0, 90.0, 30.0);
        assert_eq!(axis.ticks, [0.0, 30.0, 60.0, 90.0]);
        for (value, share) in [(0.0, 0.0), (45.0, 0.5), (90.0, 1.0), (-5.0, 0.0), (1e9, 1.0), (f64::NAN, 0.0)] {
            assert!(is_near(axis.at(value), share), "{value}");
        }
    }

    #[test]
    fn a_logarithmic_axis_has_a_tick_a_decade_and_takes_0_to_its_start() {
        let axis = Axis::log("x", 0.02, 200.0);
        assert_eq!(axis.ticks.iter().map(|v| tick(*v)).collect::<Vec<_>>(), ["0.1", "1", "10", "100"]);
        assert!(is_near(axis.at(2.0), 0.5) && axis.at(0.0) == 0.0 && axis.at(-1.0) == 0.0);
    }

    #[test]
    fn decades_are_whole_and_at_least_one() {
        let axis = Axis::decades("x", [0.02, 3.0, f64::NAN, 0.0].into_iter());
        assert!((axis.from - 0.01).abs() < 1e-9 && (axis.to - 10.0).abs() < 1e-9);
        assert!(Axis::decades("x", [].into_iter()).to > 1.0);
        assert_eq!(Axis::decades("x", [10.0].into_iter()).ticks.len(), 2);
    }

    #[test]
    fn an_axis_around_values_is_as_narrow_as_its_ticks_allow() {
        let ticks = |values: &[f64]| {
            let axis = Axis::around("x", values.iter().copied());
            let shown = values.iter().filter(|v| **v > 0.0);
            assert!(shown.into_iter().all(|v| (axis.from..=axis.to).contains(v)), "{axis:?}");
            (axis.from, axis.to, axis.ticks.len())
        };
        assert_eq!(ticks(&[215.0, 470.0]), (200.0, 500.0, 2));
        assert_eq!(ticks(&[0.41, 45.0]).2, 2, "from 0.2 to 50 are more than two decades");
        assert_eq!(ticks(&[0.51, 45.0]).2, 7);
        assert_eq!(ticks(&[1e-3, 2.0, f64::NAN, 0.0]).2, 4);
        assert_eq!(ticks(&[10.0]), (10.0, 20.0, 2));
        assert_eq!(ticks(&[]), (1.0, 2.0, 2));
    }

    #[test]
    fn a_signed_axis_is_odd_and_linear_around_0() {
        let axis = Axis::signed_log("x", 0.1, 100.0);
        assert_eq!(axis.ticks.len(), 9);
        assert!(is_near(axis.at(0.0), 0.5));
        // Four equal parts on each side: up to 0.1, 1, 10, 100.
        for (value, share) in [(0.05, 0.5625), (0.1, 0.625), (1.0, 0.75), (10.0, 0.875), (100.0, 1.0)] {
            assert!(is_near(axis.at(value), share) && is_near(axis.at(-value), 1.0 - share), "{value}");
        }
    }

    #[test]
    fn ticks_are_short() {
        assert_eq!([0.1 + 0.2, -100.0, -0.0, 0.001].map(tick), ["0.3", "\u{2212}100", "0", "0.001"]);
    }
}
