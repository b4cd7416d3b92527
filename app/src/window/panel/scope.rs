//! Aids for the light of the picture: how it is shown, whose light it shows, how its levels are spread.

use std::sync::Arc;

use burnish_core::color::tone::ToneMap;
use burnish_core::measure::view::{Counts, DisplayMode, Histogram, MIDDLE_GREY, Waveform};
use eframe::egui::{self, Color32, ColorImage, Rect, RichText, Role, Sense, TextureHandle, WidgetInfo, pos2, vec2};
use egui_plot::{Line, VLine};

use super::Context;
use crate::window::scope::{Counted, Exposure};
use crate::window::still_plot::still_plot;
use crate::window::theme::CHANNELS;
use crate::window::widget::{columns, name_ui, radio_ui};

/// Room for numbers and notes around a plot, points.
const AROUND: f32 = 64.0;
/// Counts fade from here on: a column of a waveform is as bright as a few of its pixels are there.
const GLOW: f32 = 0.5;

/// Which counts are shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Kind {
    #[default]
    Histogram,
    Waveform,
}

/// The panel.
#[derive(Default)]
pub struct ScopePanel {
    kind: Kind,
    /// Red, green and blue instead of luminance.
    channels: bool,
    /// The picture of the waveform, of these counts.
    waveform: Option<(Arc<Counted>, bool, TextureHandle)>,
}

impl ScopePanel {
    /// Shows the panel.
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        modes_ui(ui, context);
        super::lights::source_ui(ui, context);
        follow(ui.ctx(), context);
        ui.horizontal_wrapped(|ui| {
            for (kind, title) in [(Kind::Histogram, "Histogram"), (Kind::Waveform, "Waveform")] {
                ui.selectable_value(&mut self.kind, kind, title);
            }
            ui.checkbox(&mut self.channels, "R, G, B").on_hover_text("The channels instead of luminance.");
        });
        let compared = context.compare.view().is_some();
        let counted = context.scope.counted().filter(|_| !compared && context.scope.fault().is_none()).cloned();
        let Some(counted) = counted else {
            let words = match context.scope.fault() {
                _ if compared => "Shown of one picture: close the comparison.".into(),
                Some(fault) => fault.to_string(),
                None => "Waits for the picture to be sharp.".into(),
            };
            ui.weak(words);
            return;
        };
        let height = (ui.available_height() - AROUND).clamp(90.0, 360.0);
        match self.kind {
            Kind::Histogram => histogram_ui(ui, height, &counted.histogram, self.channels),
            Kind::Waveform => self.waveform_ui(ui, height, &counted),
        }
        clipped_ui(ui, &counted);
    }

    fn waveform_ui(&mut self, ui: &mut egui::Ui, height: f32, counted: &Arc<Counted>) {
        let channels = self.channels;
        let known = self.waveform.as_ref();
        if known.is_none_or(|(of, shown, _)| !Arc::ptr_eq(of, counted) || *shown != channels) {
            let image = waveform_image(&counted.waveform, channels);
            let texture = ui.ctx().load_texture("waveform", image, egui::TextureOptions::LINEAR);
            self.waveform = Some((counted.clone(), channels, texture));
        }
        let Some((.., texture)) = &self.waveform else { return };
        let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width().max(1.0), height), Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "Waveform of the picture"));
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, 0.0, Color32::BLACK);
        painter.image(texture.id(), rect, Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0)), Color32::WHITE);
        for quarter in 0..=4 {
            let y = rect.bottom() - 0.25 * quarter as f32 * rect.height();
            painter.hline(rect.x_range(), y, (1.0, Color32::from_white_alpha(40)));
        }
        response.on_hover_text(
            "Levels of the screen, from black at the bottom to white at the top, in the columns of the picture from left \
             to right.",
        );
    }
}

/// Picture, false colour or clipping.
fn modes_ui(ui: &mut egui::Ui, context: &mut Context<'_>) {
    ui.horizontal_wrapped(|ui| {
        for mode in DisplayMode::ALL {
            let on = context.aids.mode == mode;
            let hover = match mode {
                DisplayMode::Picture => "The picture itself.",
                DisplayMode::FalseColor => "Stops of luminance about middle grey as colours, before the tone map.",
                DisplayMode::Clipping => "Marks where channels are at an end of what the screen shows.",
            };
            if radio_ui(ui, on, mode.title(), hover) {
                context.aids.mode = mode;
            }
        }
    });
}

/// Lets the picture that is shown be counted.
fn follow(ctx: &egui::Context, context: &mut Context<'_>) {
    let view = &context.session.document().view;
    let tone = view.tone.parse::<ToneMap>().unwrap_or_default();
    let exposure = Exposure { tone, exposure_ev: view.exposure_ev as f32 };
    if context.compare.view().is_some() {
        return;
    }
    match context.reference.shown() {
        Some(look) => {
            let subject = context.session.revision;
            context.scope.follow_traced(ctx, exposure, (&look.picture, look.samples, subject));
        }
        None => {
            let Context { stage, scope, .. } = context;
            let status = stage.status();
            let settled = status.is_none_or(|status| status.drawn.settled && status.message.is_none());
            let size = status.map_or(glam::UVec2::splat(16), |status| status.size);
            scope.follow_live(ctx, exposure, settled, || stage.read(crate::window::stage::Screen::Main, size));
        }
    }
}

/// Pixels over stops about middle grey, the highest bin at the top.
fn histogram_ui(ui: &mut egui::Ui, height: f32, histogram: &Histogram, channels: bool) {
    let curves: Vec<(&str, Color32, &Counts)> = match channels {
        true => CHANNELS.into_iter().zip(&histogram.channels).map(|((name, color), c)| (name, color, c)).collect(),
        false => vec![("Luminance", ui.visuals().strong_text_color(), &histogram.luminance)],
    };
    let largest = curves.iter().flat_map(|(.., counts)| &counts.bins).copied().max().unwrap_or(0).max(1) as f64;
    // Square roots: small lights are few pixels, and are to be seen.
    let points = |counts: &Counts| -> Vec<[f64; 2]> {
        let bins = counts.bins.iter().enumerate();
        bins.map(|(bin, count)| [f64::from(histogram.stops(bin)), (*count as f64 / largest).sqrt()]).collect()
    };
    let plot = still_plot("histogram")
        .height(height)
        .include_y(0.0)
        .include_y(1.0)
        .include_x(-8.0)
        .include_x(8.0)
        .show_y(false)
        .y_axis_formatter(|_, _| String::new())
        .x_axis_label("stops about middle grey");
    let response = plot.show(ui, |plot| {
        plot.vline(VLine::new("middle grey", 0.0).color(Color32::GRAY));
        for (name, color, counts) in curves {
            plot.line(Line::new(name, points(counts)).color(color).fill(0.0).width(1.0));
        }
    });
    let (under, over) = histogram.shares_outside();
    let text = format!(
        "Histogram: {} of the pixels more than 12 stops below {MIDDLE_GREY}, {} above",
        percent(under),
        percent(over)
    );
    response.response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &text));
    response.response.on_hover_text(format!("Exposed light before the tone map, by luminance in stops. {text}."));
}

/// A picture with the columns and levels of the counts; light adds up, as on a tube.
fn waveform_image(waveform: &Waveform, channels: bool) -> ColorImage {
    let (columns, levels) = (waveform.columns, waveform.levels);
    let mean = (0..levels).map(|level| waveform.count(0, 0, level)).sum::<u32>().max(1) as f32 / levels as f32;
    let glow = |count: u32| (255.0 * (GLOW * count as f32 / mean).sqrt().min(1.0)) as u8;
    let mut image = ColorImage::filled([columns as usize, levels as usize], Color32::BLACK);
    for column in 0..columns {
        for level in 0..levels {
            let at = ((levels - 1 - level) * columns + column) as usize;
            let of = |kind: usize| glow(waveform.count(kind, column, level));
            image.pixels[at] = match channels {
                true => Color32::from_rgb(of(1), of(2), of(3)),
                false => Color32::from_gray(of(0)),
            };
        }
    }
    image
}

/// How much the screen cannot show.
fn clipped_ui(ui: &mut egui::Ui, counted: &Counted) {
    let clipped = &counted.clipped;
    ui.horizontal(|ui| {
        let [names, _] = columns(ui);
        name_ui(ui, "Clipped", false, names).on_hover_text("Pixels with a channel at an end of what the screen shows.");
        let text = format!("{} too bright, {} black", percent(clipped.over_some), percent(clipped.under_some));
        let hover = format!(
            "All three channels: {} too bright, {} black.",
            percent(clipped.over_all),
            percent(clipped.under_all)
        );
        ui.label(RichText::new(text)).on_hover_text(hover);
    });
}

fn percent(share: f64) -> String {
    match 100.0 * share {
        0.0 => "0 %".into(),
        v if v < 0.1 => "< 0.1 %".into(),
        v => format!("{v:.1} %"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use burnish_core::measure::view::waveform;
    use burnish_core::picture::Picture;
    use glam::Vec4;

    #[test]
    fn a_waveform_shows_bright_columns_at_the_top() {
        let picture = Picture::from_fn(8, 4, |x, _| if x < 4 { Vec4::ZERO } else { Vec4::ONE });
        let image = waveform_image(&waveform(&picture, ToneMap::None, 0.0, 8, 16), false);
        let lit = |x: usize, y: usize| image.pixels[y * 8 + x] != Color32::BLACK;
        assert!(lit(0, 15) && !lit(0, 0) && lit(7, 0) && !lit(7, 15));
    }

    #[test]
    fn small_shares_are_not_called_none() {
        assert_eq!((percent(0.0), percent(1e-5), percent(0.25)), ("0 %".into(), "< 0.1 %".into(), "25.0 %".into()));
    }
}
