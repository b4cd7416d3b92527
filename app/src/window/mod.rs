//! The window: panels around a live picture.
//!
//! [`Workbench`] is everything that is shown and knows no windowing system: [`run`] puts it into an eframe window, tests
//! and `burnish snapshot --ui` draw it offscreen. Panels are in `panel/`, one file each; they edit the document through
//! [`Session::edit`] and ask for the rest by [`Request`]s. The picture comes from [`Stage`].

mod aids;
mod chart;
mod commands;
mod compare;
mod edits;
mod files;
mod icon;
mod layout;
mod lights;
mod native;
pub mod offscreen;
mod palette;
mod panel;
mod pool;
mod preferences;
mod preparation;
mod preparations;
mod reference;
mod rename;
mod request;
mod scope;
mod session;
mod shortcuts;
mod snapshots;
mod stage;
mod still_plot;
mod table_import;
mod theme;
mod thumbnails;
mod toasts;
mod user_lightings;
mod user_presets;
mod widget;
mod workbench;

pub use aids::{Aids, ProbeMarks, Source};
pub use chart::{Chart, ErrorMeasure};
pub use commands::{Command, Entry, Menu, TABLE};
pub use compare::{Compare, CompareView, Legend};
pub use files::Folders;
pub use native::run;
pub use panel::{Pane, Tool};
pub use preferences::Preferences;
pub use preparations::lighting_now;
pub use reference::{Look, Reference};
pub use request::{Purpose, Request, Requests};
pub use session::{Selection, Session};
pub use stage::{Live, LossLog, Shown, Stage, Status, Trial};
pub use workbench::{Options, Workbench};
