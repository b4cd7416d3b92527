//! Commands about snapshots and the sides of the comparison.

use super::commands::Command;
use super::request::{Request, Requests};
use super::session::Session;

/// Name of a snapshot that nobody has named yet.
const UNNAMED: &str = "Snapshot";

/// Does a command about snapshots; says by a request what is not seen.
pub fn command(command: Command, session: &mut Session, requests: &mut Requests) {
    // A command is one step of the history, whatever is done right before and after it.
    session.seal();
    match command {
        Command::StoreSide(side) => {
            let letter = side.letter();
            session.edit(&format!("Store as {letter}"), "", |document| document.store_side(side));
            requests.push(Request::Notice(format!("Stored as {letter}")));
        }
        Command::SwapSides => session.edit("Swap A and B", "", burnish_core::document::Document::swap_sides),
        Command::TakeSnapshot => {
            let mut name = String::new();
            session.edit("Take snapshot", "", |document| name = document.add_snapshot(UNNAMED));
            requests.push(Request::Notice(format!("Kept as `{name}`")));
        }
        _ => {}
    }
    session.seal();
}
