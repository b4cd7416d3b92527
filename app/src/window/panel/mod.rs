//! The panels, one file each. A panel keeps what only it shows; documents, scenes and files are the session's.

mod chart;
mod compare;
mod environment;
mod history;
mod lights;
mod material;
mod presets;
mod reflectance;
mod row;
mod scene_tree;
mod scope;
mod start;
mod status;
mod viewport;

use eframe::egui::{self, WidgetText};
use serde::{Deserialize, Serialize};

use super::aids::Aids;
use super::chart::Chart;
use super::compare::Compare;
use super::preferences::Preferences;
use super::preparations::Preparations;
use super::reference::Reference;
use super::request::Requests;
use super::scope::Scope;
use super::session::Session;
use super::stage::Stage;
use super::thumbnails::Thumbnails;
use super::user_lightings::UserLightings;
use super::user_presets::UserPresets;

pub use chart::ChartPanel;
pub use compare::ComparePanel;
pub use environment::{EnvironmentPanel, expose};
pub use history::HistoryPanel;
pub use lights::LightsPanel;
pub use material::MaterialPanel;
pub use presets::{FormSettings, PresetsPanel, assign, f0, f0_ui, forms_ui, warning_ui};
pub use reflectance::ReflectancePanel;
pub use scene_tree::SceneTree;
pub use scope::ScopePanel;
pub use start::StartPage;
pub use status::StatusLine;
pub use viewport::{Tool, ViewportPanel};

/// What every panel may use.
pub struct Context<'a> {
    /// What is open.
    pub session: &'a mut Session,
    /// The user's choices.
    pub preferences: &'a mut Preferences,
    /// The picture.
    pub stage: &'a mut Stage,
    /// The path-traced one.
    pub reference: &'a mut Reference,
    /// What the live method prepares.
    pub preparations: &'a mut Preparations,
    /// Two pictures.
    pub compare: &'a mut Compare,
    /// Time against error.
    pub chart: &'a mut Chart,
    /// How the picture is looked at.
    pub aids: &'a mut Aids,
    /// How its levels are spread.
    pub scope: &'a mut Scope,
    /// Wishes for after the frame.
    pub requests: &'a mut Requests,
    /// The user's presets.
    pub own: &'a mut UserPresets,
    /// The user's lighting presets.
    pub lightings: &'a mut UserLightings,
    /// Pictures of presets.
    pub thumbnails: &'a mut Thumbnails,
}

/// What is dragged out of the preset browser: the key of a preset, for [`Request::AssignPreset`].
///
/// [`Request::AssignPreset`]: super::request::Request::AssignPreset
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DraggedPreset(pub String);

/// A panel that can be docked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Pane {
    /// The picture.
    Viewport,
    /// Objects.
    Scene,
    /// Factors and textures.
    Material,
    /// Metals.
    Presets,
    /// Lamps.
    Lights,
    /// Light and view.
    Environment,
    /// Snapshots and what differs between two.
    Compare,
    /// Time against error.
    Chart,
    /// Reflectance against angle.
    Reflectance,
    /// Levels of the picture.
    Scope,
    /// Steps to undo.
    History,
}

impl Pane {
    /// All of them.
    pub const ALL: [Pane; 11] = [
        Pane::Viewport,
        Pane::Scene,
        Pane::Material,
        Pane::Presets,
        Pane::Lights,
        Pane::Environment,
        Pane::Compare,
        Pane::Chart,
        Pane::Reflectance,
        Pane::Scope,
        Pane::History,
    ];

    /// Title of its tab.
    pub fn title(self) -> &'static str {
        match self {
            Pane::Viewport => "Viewport",
            Pane::Scene => "Scene",
            Pane::Material => "Material",
            Pane::Presets => "Presets",
            Pane::Lights => "Lights",
            Pane::Environment => "Environment",
            Pane::Compare => "Compare",
            Pane::Chart => "Chart",
            Pane::Reflectance => "Reflectance",
            Pane::Scope => "Scope",
            Pane::History => "History",
        }
    }

    /// Fills its place, with scroll bars of its own if any.
    fn scrolls_itself(self) -> bool {
        matches!(self, Pane::Viewport | Pane::Scene | Pane::Presets | Pane::History)
    }
}

/// The docked panels.
#[derive(Default)]
pub struct Panels {
    /// Also moves the camera on command.
    pub viewport: ViewportPanel,
    /// Also renames on command.
    pub scene: SceneTree,
    material: MaterialPanel,
    /// Also shows what came in.
    pub presets: PresetsPanel,
    lights: LightsPanel,
    environment: EnvironmentPanel,
    compare: ComparePanel,
    chart: ChartPanel,
    reflectance: ReflectancePanel,
    scope: ScopePanel,
    history: HistoryPanel,
}

impl Panels {
    /// Forgets what belongs to the document.
    pub fn forget(&mut self) {
        self.environment = EnvironmentPanel::default();
    }

    fn ui(&mut self, pane: Pane, ui: &mut egui::Ui, context: &mut Context<'_>) {
        match pane {
            Pane::Viewport => self.viewport.ui(ui, context),
            Pane::Scene => self.scene.ui(ui, context),
            Pane::Material => self.material.ui(ui, context),
            Pane::Presets => self.presets.ui(ui, context),
            Pane::Lights => self.lights.ui(ui, context),
            Pane::Environment => self.environment.ui(ui, context),
            Pane::Compare => self.compare.ui(ui, context),
            Pane::Chart => self.chart.ui(ui, context),
            Pane::Reflectance => self.reflectance.ui(ui, context),
            Pane::Scope => self.scope.ui(ui, context),
            Pane::History => self.history.ui(ui, context),
        }
    }
}

/// Shows docked panels to egui_tiles.
pub struct Docked<'a, 'b> {
    /// The panels.
    pub panels: &'a mut Panels,
    /// What they use.
    pub context: &'a mut Context<'b>,
    /// Set where panels were moved or resized.
    pub rearranged: bool,
}

impl egui_tiles::Behavior<Pane> for Docked<'_, '_> {
    fn pane_ui(&mut self, ui: &mut egui::Ui, _tile: egui_tiles::TileId, pane: &mut Pane) -> egui_tiles::UiResponse {
        let margin = if *pane == Pane::Viewport { 0 } else { 6 };
        egui::Frame::new().inner_margin(margin).show(ui, |ui| {
            if pane.scrolls_itself() {
                self.panels.ui(*pane, ui, self.context);
            } else {
                egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                    self.panels.ui(*pane, ui, self.context);
                });
            }
        });
        egui_tiles::UiResponse::None
    }

    fn tab_title_for_pane(&mut self, pane: &Pane) -> WidgetText {
        pane.title().into()
    }

    fn tab_bar_height(&self, _style: &egui::Style) -> f32 {
        22.0
    }

    fn on_edit(&mut self, _edit: egui_tiles::EditAction) {
        self.rearranged = true;
    }

    fn simplification_options(&self) -> egui_tiles::SimplificationOptions {
        egui_tiles::SimplificationOptions { all_panes_must_have_tabs: true, ..Default::default() }
    }
}
