//! The window: panels around a live picture.
//!
//! [`Workbench`] is everything that is shown and knows no windowing system: [`run`] puts it into an eframe window, tests
//! and `burnish snapshot --ui` draw it offscreen. Panels are in `panel/`, one file each; they edit the document through
//! [`Session::edit`] and ask for the rest by [`Request`]s. The picture comes from [`Stage`].

mod commands;
mod edits;
mod files;
mod panel;
mod preferences;
mod request;
mod session;
mod stage;
mod workbench;

use eframe::egui;

pub use commands::{Command, Entry, Menu, TABLE};
pub use preferences::Preferences;
pub use request::{Purpose, Request, Requests};
pub use session::{Selection, Session};
pub use stage::Stage;
pub use workbench::{Options, Workbench};

use crate::failure::Failure;

struct App {
    workbench: Workbench,
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        self.workbench.ui(ui);
    }
}

/// Opens the window and returns when it was closed.
pub fn run(options: Options) -> Result<(), Failure> {
    let native = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default().with_inner_size([1280.0, 800.0]).with_title("Burnish"),
        ..Default::default()
    };
    let create: eframe::AppCreator<'_> =
        Box::new(|cc| Ok(Box::new(App { workbench: Workbench::new(&cc.egui_ctx, options, Stage::Flat) })));
    eframe::run_native("burnish", native, create).map_err(|e| Failure::resources(format!("no window: {e}")))
}
