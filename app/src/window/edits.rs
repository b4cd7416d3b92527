//! Commands that edit the document: materials and objects.

use super::commands::Command;
use super::session::Session;

/// Does a command about materials or objects.
pub fn command(command: Command, session: &mut Session) {
    match command {
        Command::CopyMaterial => session.clipboard = session.material().cloned(),
        Command::ShowAll => session.edit("Show all", "", |document| document.show_all()),
        _ => {}
    }
}
