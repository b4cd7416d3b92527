//! The look of the window: neutral greys around the picture, so that they tint no judgement of color.

use eframe::egui::{self, Color32, CornerRadius, Stroke, Style, Theme, ThemePreference, Visuals};

use super::preferences::Preferences;

/// Scales of text and widgets that can be chosen.
pub const SCALES: std::ops::RangeInclusive<f32> = 0.5..=3.0;

/// R, G and B in plots with the colours of Okabe and Ito, told apart without red and green as well.
pub const CHANNELS: [(&str, Color32); 3] = [
    ("R", Color32::from_rgb(0xd5, 0x5e, 0x00)),
    ("G", Color32::from_rgb(0x00, 0x9e, 0x73)),
    ("B", Color32::from_rgb(0x2f, 0x8f, 0xd0)),
];

/// Sets both themes once; `Ctrl` `+`, `-` and `0` are commands here and not egui's own.
pub fn install(ctx: &egui::Context) {
    ctx.options_mut(|options| options.zoom_with_keyboard = false);
    ctx.style_mut_of(Theme::Dark, |style| shape(style, dark()));
    ctx.style_mut_of(Theme::Light, |style| shape(style, light()));
}

/// Follows the user's choices.
pub fn apply(ctx: &egui::Context, preferences: &Preferences) {
    ctx.set_theme(match preferences.dark {
        None => ThemePreference::System,
        Some(true) => ThemePreference::Dark,
        Some(false) => ThemePreference::Light,
    });
    let scale = if preferences.ui_scale.is_finite() { preferences.ui_scale } else { 1.0 };
    ctx.set_zoom_factor(scale.clamp(*SCALES.start(), *SCALES.end()));
}

/// The next scale of text and widgets, in steps of a tenth.
pub fn scaled(scale: f32, steps: f32) -> f32 {
    ((scale * 10.0 + steps).round() / 10.0).clamp(*SCALES.start(), *SCALES.end())
}

/// Spacing and corners, which both themes share.
fn shape(style: &mut Style, visuals: Visuals) {
    style.visuals = visuals;
    style.spacing.item_spacing = egui::vec2(6.0, 4.0);
    style.spacing.button_padding = egui::vec2(6.0, 2.0);
    style.spacing.menu_margin = egui::Margin::same(6);
    style.spacing.indent = 14.0;
    style.spacing.combo_width = 80.0;
    style.interaction.selectable_labels = false;
    let visuals = &mut style.visuals;
    let widgets = &mut visuals.widgets;
    for widget in [
        &mut widgets.noninteractive,
        &mut widgets.inactive,
        &mut widgets.hovered,
        &mut widgets.active,
        &mut widgets.open,
    ] {
        widget.corner_radius = CornerRadius::same(3);
        widget.expansion = 0.0;
    }
    visuals.window_corner_radius = CornerRadius::same(5);
    visuals.menu_corner_radius = CornerRadius::same(4);
    visuals.slider_trailing_fill = true;
}

/// A mid-dark grey: darker surroundings make a picture look lighter than it is.
fn dark() -> Visuals {
    let grey = Color32::from_gray;
    let mut visuals = Visuals::dark();
    visuals.panel_fill = grey(42);
    visuals.window_fill = grey(48);
    visuals.window_stroke = Stroke::new(1.0, grey(72));
    visuals.faint_bg_color = grey(47);
    visuals.extreme_bg_color = grey(27);
    visuals.warn_fg_color = Color32::from_rgb(230, 170, 80);
    visuals.error_fg_color = Color32::from_rgb(240, 110, 100);
    visuals.selection.bg_fill = Color32::from_rgb(56, 88, 122);
    visuals.selection.stroke = Stroke::new(1.0, grey(240));
    visuals.widgets.noninteractive.bg_fill = grey(42);
    visuals.widgets.noninteractive.weak_bg_fill = grey(42);
    visuals.widgets.noninteractive.bg_stroke = Stroke::new(1.0, grey(66));
    visuals.widgets.noninteractive.fg_stroke = Stroke::new(1.0, grey(200));
    visuals.widgets.inactive.bg_fill = grey(68);
    visuals.widgets.inactive.weak_bg_fill = grey(62);
    visuals.widgets.hovered.bg_fill = grey(84);
    visuals.widgets.hovered.weak_bg_fill = grey(76);
    visuals.widgets.hovered.bg_stroke = Stroke::new(1.0, grey(110));
    visuals.widgets.active.bg_fill = grey(96);
    visuals.widgets.active.weak_bg_fill = grey(90);
    visuals.widgets.open.bg_fill = grey(52);
    visuals.widgets.open.weak_bg_fill = grey(58);
    visuals
}

fn light() -> Visuals {
    let grey = Color32::from_gray;
    let mut visuals = Visuals::light();
    visuals.panel_fill = grey(228);
    visuals.window_fill = grey(238);
    visuals.faint_bg_color = grey(221);
    visuals.extreme_bg_color = grey(248);
    visuals.warn_fg_color = Color32::from_rgb(140, 84, 0);
    visuals.error_fg_color = Color32::from_rgb(170, 24, 16);
    visuals.selection.bg_fill = Color32::from_rgb(168, 200, 232);
    visuals.widgets.noninteractive.bg_fill = grey(228);
    visuals.widgets.noninteractive.weak_bg_fill = grey(228);
    visuals.widgets.noninteractive.bg_stroke = Stroke::new(1.0, grey(190));
    visuals.widgets.noninteractive.fg_stroke = Stroke::new(1.0, grey(50));
    visuals.widgets.inactive.bg_fill = grey(198);
    visuals.widgets.inactive.weak_bg_fill = grey(208);
    visuals.widgets.inactive.fg_stroke = Stroke::new(1.0, grey(40));
    visuals
}

/// Encoded colour that windows are cleared to: panels need not be filled once more, which takes a software rasteriser as
/// long as the picture does.
pub fn background(visuals: &Visuals) -> [f32; 4] {
    visuals.panel_fill.to_normalized_gamma_f32()
}
