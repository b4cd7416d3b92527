//! Reflectance against angle: how the inspector's material reflects, and how its metal really would.

use burnish_core::document::Document;
use burnish_core::material::preset::{FormChoice, Preset};
use burnish_core::material::{Material, Reflectance};
use burnish_core::surface::dielectric;
use burnish_core::surface::fresnel::schlick;
use eframe::egui::{self, WidgetInfo};
use egui_plot::{GridMark, Line, LineStyle, PlotPoint, Text};
use glam::{DVec3, Vec3};

use super::Context;
use super::presets::title;
use crate::window::still_plot::still_plot;
use crate::window::theme::CHANNELS;

/// Degrees that are sampled, and the last of them.
const STEPS: usize = 90;
/// Room for the numbers and the notes around the plot, points.
const AROUND: f32 = 50.0;

/// A curve at every degree from 0 to 90.
type Curve = Vec<Vec3>;

/// The plot.
#[derive(Default)]
pub struct ReflectancePanel {
    /// The exact curve of the metal that was last shown.
    exact: Option<(Preset, Curve)>,
    /// Degrees that the pointer reads.
    angle: Option<f64>,
}

impl ReflectancePanel {
    /// Shows the panel.
    pub fn ui(&mut self, ui: &mut egui::Ui, context: &mut Context<'_>) {
        let index = context.session.selection.material;
        let document = context.session.document().clone();
        let scene = context.session.scene().clone();
        let Some(material) = scene.materials.get(index) else { return };
        let metal = metal_of(&document, material);
        let used = curve(|cos_theta| rendered(material, cos_theta as f32));
        let exact = metal.map(|metal| self.exact(metal));
        ui.small(caption(&document, index, material, metal));
        let height = (ui.available_height() - AROUND).clamp(110.0, 420.0);
        self.angle = plot_ui(ui, height, &used, exact.as_ref());
        readout_ui(ui, self.angle, &used, exact.as_ref());
    }

    /// Integrated once for each metal.
    fn exact(&mut self, metal: &Preset) -> Curve {
        if let Some((known, curve)) = &self.exact
            && known == metal
        {
            return curve.clone();
        }
        let made = curve(|cos_theta| metal.unclamped(cos_theta).clamp(DVec3::ZERO, DVec3::ONE).as_vec3());
        self.exact = Some((metal.clone(), made.clone()));
        made
    }
}

fn metal_of<'a>(document: &'a Document, material: &Material) -> Option<&'a Preset> {
    match &material.reflectance {
        Reflectance::Preset { id, .. } => document.metal(id),
        Reflectance::BaseColor => None,
    }
}

/// What the renderer uses: the curve of the metal, else what glTF makes of the factors.
fn rendered(material: &Material, cos_theta: f32) -> Vec3 {
    match &material.reflectance {
        Reflectance::Preset { fresnel, .. } => fresnel.eval(cos_theta),
        Reflectance::BaseColor => {
            let metal = schlick(material.base_color, 1.0, cos_theta);
            let f0 = dielectric::f0(material.ior, material.specular, material.specular_color);
            schlick(f0, material.specular, cos_theta).lerp(metal, material.metallic).clamp(Vec3::ZERO, Vec3::ONE)
        }
    }
}

fn curve(reflectance: impl Fn(f64) -> Vec3) -> Curve {
    (0..=STEPS).map(|degree| reflectance((degree as f64).to_radians().cos().max(0.0))).collect()
}

/// What is drawn.
fn caption(document: &Document, index: usize, material: &Material, metal: Option<&Preset>) -> String {
    match metal {
        Some(metal) => {
            let form = form_of(document, index, metal);
            format!("{}: {}; solid as rendered ({form}), dashed exact", material.name, title(metal))
        }
        None => format!("{}: from its base color and index of refraction (glTF)", material.name),
    }
}

/// The form that is rendered; `cheapest` where it is not known which that is.
fn form_of(document: &Document, index: usize, metal: &Preset) -> &'static str {
    let used = document.materials.get(index).and_then(|entry| entry.preset.as_ref());
    let own = used.and_then(|used| used.fresnel.as_deref());
    match document.form_choice(own) {
        FormChoice::Of(form) => form.id(),
        FormChoice::Cheapest(tolerance) => {
            metal.stored_fits().map_or(FormChoice::CHEAPEST, |fits| fits.cheapest(tolerance).form.id())
        }
    }
}

/// Returns the angle under the pointer.
fn plot_ui(ui: &mut egui::Ui, height: f32, used: &Curve, exact: Option<&Curve>) -> Option<f64> {
    let id = ui.scope_id().with("reflectance");
    let label = |at: &egui_plot::HoverPosition<'_>| match at {
        egui_plot::HoverPosition::NearDataPoint { plot_name, position, .. } => {
            Some(format!("{plot_name}\n{:.0}°: {:.3}", position.x, position.y))
        }
        egui_plot::HoverPosition::Elsewhere { .. } => None,
    };
    let shown = still_plot("reflectance")
        .id(id)
        .height(height)
        .default_x_bounds(-1.0, STEPS as f64 + 4.0)
        .default_y_bounds(0.0, 1.02)
        .x_grid_spacer(|_| marks(90, &[30.0, 15.0]))
        .x_axis_formatter(|mark, _| format!("{:.0}°", mark.value))
        .label_formatter(label)
        .show(ui, |plot| {
            let curves = [("as rendered", Some(used), true), ("exact", exact, false)];
            for (what, curve, solid) in
                curves.into_iter().filter_map(|(what, curve, solid)| Some((what, curve?, solid)))
            {
                for (channel, (name, color)) in CHANNELS.into_iter().enumerate() {
                    let style = if solid { LineStyle::Solid } else { LineStyle::dashed_dense() };
                    let width = if solid { 1.5 } else { 2.0 };
                    let line = Line::new(format!("{name} {what}"), points(curve, channel));
                    plot.line(line.color(color).style(style).width(width));
                }
            }
            for (channel, (name, color)) in CHANNELS.into_iter().enumerate() {
                // Beside one another, for curves of a grey metal lie on each other.
                let degree = 4 + 5 * channel;
                let value = used.get(degree).map_or(0.0, |v| f64::from(v[channel]));
                let beside = if value > 0.85 { -0.08 } else { 0.06 };
                let at = PlotPoint::new(degree as f64, value + beside);
                plot.text(Text::new("", at, name).color(color).allow_hover(false));
            }
            plot.pointer_coordinate().filter(|_| plot.response().hovered())
        });
    shown.response.widget_info(|| WidgetInfo::labeled(egui::Role::Image, true, "Plot of reflectance against angle"));
    shown.inner.map(|at| at.x.clamp(0.0, STEPS as f64))
}

fn marks(end: i32, steps: &[f64]) -> Vec<GridMark> {
    let finest = steps.last().copied().unwrap_or(15.0);
    let count = (f64::from(end) / finest).round() as i32;
    let step = |value: f64| steps.iter().copied().find(|step| (value / step).fract() == 0.0).unwrap_or(finest);
    (0..=count).map(|i| f64::from(i) * finest).map(|value| GridMark { value, step_size: step(value) }).collect()
}

fn points(curve: &Curve, channel: usize) -> Vec<[f64; 2]> {
    curve.iter().enumerate().map(|(degree, value)| [degree as f64, f64::from(value[channel])]).collect()
}

/// The numbers under the pointer, at normal incidence where there is none.
fn readout_ui(ui: &mut egui::Ui, angle: Option<f64>, used: &Curve, exact: Option<&Curve>) {
    let angle = angle.unwrap_or(0.0);
    let read = |curve: &Curve| {
        let [r, g, b] = at(curve, angle).to_array();
        format!("{r:.3}  {g:.3}  {b:.3}")
    };
    let hover = "Reflectance of R, G and B (linear Rec.709 under D65) at this angle from the normal";
    egui::Grid::new("readout").num_columns(2).spacing([8.0, 1.0]).show(ui, |ui| {
        ui.small(format!("{angle:.0}° as rendered")).on_hover_text(hover);
        ui.monospace(egui::RichText::new(read(used)).small());
        ui.end_row();
        if let Some(exact) = exact {
            ui.small("exact").on_hover_text(hover);
            ui.monospace(egui::RichText::new(read(exact)).small());
            ui.end_row();
        }
    });
}

/// Linear between degrees.
fn at(curve: &Curve, angle: f64) -> Vec3 {
    let below = (angle.clamp(0.0, STEPS as f64).floor() as usize).min(STEPS - 1);
    let entry = |degree: usize| curve.get(degree).copied().unwrap_or_default();
    entry(below).lerp(entry(below + 1), (angle - below as f64) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use burnish_core::material::preset;

    #[test]
    fn the_curve_of_a_dielectric_begins_at_four_per_cent_and_ends_at_one() {
        let glass = curve(|cos_theta| rendered(&Material::default(), cos_theta as f32));
        assert!((at(&glass, 0.0).x - 0.04).abs() < 1e-6, "{}", at(&glass, 0.0));
        assert!((at(&glass, 90.0).x - 1.0).abs() < 1e-6, "{}", at(&glass, 90.0));
        let metal = Material { metallic: 1.0, base_color: Vec3::new(0.9, 0.6, 0.3), ..Material::default() };
        let metal = curve(|cos_theta| rendered(&metal, cos_theta as f32));
        assert!((at(&metal, 0.0) - Vec3::new(0.9, 0.6, 0.3)).length() < 1e-6);
    }

    #[test]
    fn the_caption_names_the_form_that_the_cheapest_is() {
        use burnish_core::material::preset::Tolerance;
        let mut document = burnish_core::document::open("gallery:workbench").unwrap().document;
        let gold = preset::find("Au").unwrap();
        document.assign_preset(0, &gold, Default::default());
        let form = |document: &Document| form_of(document, 0, &gold).to_string();
        assert_eq!(form(&document), gold.fits().cheapest(Tolerance::default()).form.id());
        document.set_fresnel(0, Some("recipe"));
        assert_eq!(form(&document), "recipe");
        assert_eq!(form_of(&document, 1, &Preset { fits: None, ..gold.clone() }), "cheapest");
    }

    #[test]
    fn the_exact_curve_is_integrated_once_for_a_metal() {
        let mut panel = ReflectancePanel::default();
        let (gold, silver) = (preset::find("Au").unwrap(), preset::find("Ag").unwrap());
        let curve = panel.exact(&gold);
        assert!((at(&curve, 0.0) - Vec3::new(1.0, 0.728, 0.365)).abs().max_element() < 5e-3, "{}", at(&curve, 0.0));
        assert_eq!(panel.exact(&gold), curve);
        assert_ne!(panel.exact(&silver), curve);
    }
}
