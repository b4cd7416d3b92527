//! n and k over wavelength.

use burnish_core::material::preset::Preset;
use eframe::egui::{self, Align2, Color32, WidgetInfo};
use egui_plot::{Line, LineStyle, PlotPoint, PlotPoints, Text, VLine};

use crate::window::still_plot::still_plot;

/// Light that is seen, nm.
const VISIBLE_NM: [f64; 2] = [380.0, 780.0];

/// Room beside the curves, for the numbers of the axis.
const BESIDE_NM: f64 = 30.0;

/// Share of the axis at its end that half a number takes.
const END_SHARE: f64 = 0.07;

/// Colours that are told apart without red and green; n is solid and k dashed besides.
const N_COLOR: Color32 = Color32::from_rgb(0x2f, 0x8f, 0xd0);
const K_COLOR: Color32 = Color32::from_rgb(0xd5, 0x5e, 0x00);

/// Shows the curves; they cannot be moved.
pub fn plot_ui(ui: &mut egui::Ui, metal: &Preset, height: f32) {
    let label = |at: &egui_plot::HoverPosition<'_>| match at {
        egui_plot::HoverPosition::NearDataPoint { plot_name, position, .. } => {
            Some(format!("{plot_name} {:.4}\n{:.1} nm", position.y, position.x))
        }
        egui_plot::HoverPosition::Elsewhere { .. } => None,
    };
    let grey = ui.visuals().weak_text_color();
    let shown = still_plot("n and k")
        .height(height)
        .include_y(0.0)
        .include_x(metal.wavelength_nm.first().copied().unwrap_or_default() - BESIDE_NM)
        .include_x(metal.wavelength_nm.last().copied().unwrap_or_default() + BESIDE_NM)
        .x_axis_formatter(|mark, range| {
            // A number at the very end would be cut off.
            let inside = mark.value < range.end() - END_SHARE * (range.end() - range.start());
            if inside { format!("{:.0} nm", mark.value) } else { String::new() }
        })
        .label_formatter(label)
        .show(ui, |plot| {
            for nm in VISIBLE_NM {
                plot.vline(
                    VLine::new("", nm).color(grey).width(1.0).style(LineStyle::dotted_dense()).allow_hover(false),
                );
            }
            let curves =
                [("n", &metal.n, N_COLOR, LineStyle::Solid), ("k", &metal.k, K_COLOR, LineStyle::dashed_dense())];
            for (name, values, color, style) in curves {
                let points: Vec<[f64; 2]> = metal.wavelength_nm.iter().zip(values).map(|(x, y)| [*x, *y]).collect();
                let at = points.get(points.len() / 4).copied().unwrap_or_default();
                plot.line(Line::new(name, PlotPoints::from(points)).color(color).style(style).width(1.5));
                // Above the line, and heard by nobody: the line has the name too.
                let text =
                    Text::new("", PlotPoint::new(at[0], at[1]), egui::RichText::new(name).size(13.0)).color(color);
                plot.text(text.anchor(Align2::CENTER_BOTTOM).allow_hover(false));
            }
        });
    shown.response.widget_info(|| WidgetInfo::labeled(egui::Role::Image, true, "Plot of n and k over wavelength"));
}
