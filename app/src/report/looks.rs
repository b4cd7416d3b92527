//! How forms are drawn and numbers written, everywhere in the report.

use burnish_core::surface::fresnel::Form;
use glam::Vec3;

use super::chart::Marker;
use burnish_core::color::rgb::srgb_from_linear;

/// Class of a form in `style.css`: a colour for the family, a dash for the member.
pub fn class(form: Form) -> String {
    format!("f-{}", form.id())
}

/// Shape of a form's points.
pub fn marker(form: Form) -> Marker {
    match form {
        Form::Spectral => Marker::Plus,
        Form::EffectiveNk => Marker::Square,
        Form::SampledNk => Marker::Circle,
        Form::Gulbrandsen => Marker::Star,
        Form::Schlick => Marker::Cross,
        Form::Rescaled => Marker::Diamond,
        Form::Recipe => Marker::Down,
        Form::Fitted => Marker::Up,
        Form::Series2 => Marker::Circle,
        Form::Series3 => Marker::Square,
        Form::Series4 => Marker::Diamond,
        Form::F82 => Marker::Down,
        Form::F82Fitted => Marker::Up,
    }
}

/// Two significant digits, no more than three decimals.
pub fn brief(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        v if v < 0.0005 => "<0.001".into(),
        v if v < 0.095 => format!("{value:.3}"),
        v if v < 0.95 => format!("{value:.2}"),
        v if v < 9.5 => format!("{value:.1}"),
        _ => format!("{value:.0}"),
    }
}

/// [`brief`] of a share in per cent, without the sign.
pub fn percent(share: f64) -> String {
    brief(100.0 * share)
}

/// Three numbers with three decimals.
pub fn triple(numbers: [f64; 3]) -> String {
    numbers.map(|v| format!("{v:.3}")).join(" ")
}

/// `#rrggbb` of linear Rec.709, clamped.
pub fn hex(linear: Vec3) -> String {
    let [r, g, b] = srgb_from_linear(linear).to_array().map(|v| (v * 255.0).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_form_has_a_style() {
        let style = include_str!("style.css");
        for form in Form::ALL {
            assert!(style.contains(&format!(".{}{{", class(form))), "{form:?}");
        }
        // Colour and shape together are unique, so that shape decides within a family.
        let color = |form: Form| {
            let rule = style.split(&format!(".{}{{", class(form))).nth(1).unwrap();
            rule.split([';', '}']).next().unwrap().to_string()
        };
        let looks: BTreeSet<String> = Form::ALL.iter().map(|f| format!("{} {:?}", color(*f), marker(*f))).collect();
        assert_eq!(looks.len(), Form::ALL.len());
    }

    #[test]
    fn numbers_have_two_significant_digits_where_they_matter() {
        let shown = [0.0, 0.0001, 0.012_34, 0.099, 0.123, 0.96, 1.26, 9.6, 37.4].map(brief);
        assert_eq!(shown, ["0", "<0.001", "0.012", "0.10", "0.12", "1.0", "1.3", "10", "37"]);
        assert_eq!(percent(0.0123), "1.2");
        assert_eq!(hex(Vec3::new(1.0, 0.0, 0.5)), "#ff00bc");
    }
}
