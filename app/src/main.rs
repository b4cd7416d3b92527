//! The `burnish` program.

use std::process::ExitCode;

fn main() -> ExitCode {
    burnish::interrupt::arm();
    // Unlocked handles: a panic message from another thread must not wait for this one.
    let code = burnish::run(std::env::args_os().skip(1), &mut std::io::stdout(), &mut std::io::stderr());
    ExitCode::from(code)
}
