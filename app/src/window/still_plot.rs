//! Plots that are looked at, not moved.

use egui_plot::Plot;

/// A plot that neither scrolls nor zooms.
pub fn still_plot<'a>(id: &'static str) -> Plot<'a> {
    Plot::new(id)
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_drag(false)
        .allow_boxed_zoom(false)
        .allow_axis_zoom_drag(false)
        .allow_double_click_reset(false)
}
