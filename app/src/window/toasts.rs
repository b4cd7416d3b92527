//! Short messages that pass: notices leave by themselves, errors stay long enough to be read.
//!
//! The same words are shown once, however often they are said. Assistive technology reads them as they come.

use std::time::Duration;

use eframe::egui::{self, Align2, RichText, accesskit};

/// How long a notice stays, seconds.
const NOTICE_SECS: f64 = 5.0;
/// How long an error stays, seconds.
const ERROR_SECS: f64 = 20.0;
/// Messages that are shown; the oldest make room.
const MAX_SHOWN: usize = 4;
/// Widest line.
const WIDTH: f32 = 340.0;

/// The messages that are shown.
#[derive(Default)]
pub struct Toasts {
    list: Vec<Toast>,
}

struct Toast {
    text: String,
    is_error: bool,
    until_secs: f64,
}

impl Toasts {
    /// Says something that passes; `now_secs` is the window's clock.
    pub fn notice(&mut self, text: String, now_secs: f64) {
        self.add(Toast { text, is_error: false, until_secs: now_secs + NOTICE_SECS });
    }

    /// Says what went wrong.
    pub fn error(&mut self, text: String, now_secs: f64) {
        self.add(Toast { text, is_error: true, until_secs: now_secs + ERROR_SECS });
    }

    /// The texts that are shown, the oldest first.
    pub fn texts(&self) -> impl Iterator<Item = &str> {
        self.list.iter().map(|toast| toast.text.as_str())
    }

    fn add(&mut self, toast: Toast) {
        match self.list.iter_mut().find(|shown| shown.text == toast.text) {
            Some(shown) => *shown = toast,
            None => self.list.push(toast),
        }
        let surplus = self.list.len().saturating_sub(MAX_SHOWN);
        self.list.drain(..surplus);
    }

    /// Shows them above the lower right corner of `area`. A message under the pointer stays.
    pub fn ui(&mut self, ctx: &egui::Context, area: egui::Rect) {
        let now_secs = ctx.input(|input| input.time);
        self.list.retain(|toast| toast.until_secs > now_secs);
        let Some(first) = self.list.iter().map(|toast| toast.until_secs).min_by(f64::total_cmp) else { return };
        ctx.request_repaint_after(Duration::from_secs_f64((first - now_secs).max(0.05)));
        let mut closed = None;
        let shown = egui::Area::new(egui::Id::unique("toasts"))
            .order(egui::Order::Foreground)
            .pivot(Align2::RIGHT_BOTTOM)
            .fixed_pos(area.right_bottom() - egui::vec2(12.0, 12.0))
            .show(ctx, |ui| {
                for (index, toast) in self.list.iter().enumerate() {
                    if toast.ui(ui) {
                        closed = Some(index);
                    }
                }
            });
        if shown.response.contains_pointer() {
            self.list.iter_mut().for_each(|toast| toast.until_secs = toast.until_secs.max(now_secs + 1.0));
        }
        if let Some(index) = closed {
            self.list.remove(index);
        }
    }
}

impl Toast {
    /// Returns whether it was closed.
    fn ui(&self, ui: &mut egui::Ui) -> bool {
        let frame = egui::Frame::popup(ui.style()).inner_margin(egui::Margin::symmetric(10, 7));
        let content = |ui: &mut egui::Ui| {
            ui.set_max_width(WIDTH);
            let visuals = ui.visuals();
            let color = if self.is_error { visuals.error_fg_color } else { visuals.weak_text_color() };
            // In words too: a color alone says nothing to those who do not see it.
            let sign = if self.is_error { "Error" } else { "Note" };
            ui.horizontal_top(|ui| {
                ui.label(RichText::new(sign).strong().color(color));
                ui.vertical(|ui| {
                    ui.set_max_width(WIDTH - 84.0);
                    let text = ui.label(&self.text);
                    ui.ctx().accesskit_node_builder(text.id, |node| {
                        node.set_live(if self.is_error { accesskit::Live::Assertive } else { accesskit::Live::Polite });
                    });
                });
                let close = ui.add(egui::Button::new("\u{d7}").frame(false)).on_hover_text("Close this message");
                close.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, "Close message"));
                close.clicked()
            })
            .inner
        };
        frame.show(ui, content).inner
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_words_are_said_once_and_old_ones_make_room() {
        let mut toasts = Toasts::default();
        for second in 0..100 {
            toasts.error("no such file".into(), f64::from(second));
        }
        assert_eq!(toasts.texts().count(), 1);
        for number in 0..100 {
            toasts.notice(number.to_string(), 0.0);
        }
        assert_eq!(toasts.texts().collect::<Vec<_>>(), ["96", "97", "98", "99"]);
    }
}
