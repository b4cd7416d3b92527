//! The window driven by labels and drawn offscreen: what people do, how it looks, and what a monkey does to it.
//!
//! `UPDATE_SNAPSHOTS=1 cargo test --workspace --test ui` accepts how the window looks now; `BURNISH_SEEDS=20` lets the
//! monkey loose twenty times.

mod baked;
mod bench;
mod chart;
mod compare;
mod environment;
mod import;
mod lights;
mod looks;
mod monkey;
mod probes;
mod reference;
mod snapshot;
mod workflow;

use libtest_mimic::Arguments;

fn main() {
    let trials = [
        workflow::trials(),
        import::trials(),
        environment::trials(),
        lights::trials(),
        probes::trials(),
        baked::trials(),
        looks::trials(),
        compare::trials(),
        chart::trials(),
        monkey::trials(),
        reference::trials(),
        snapshot::trials(),
    ]
    .into_iter()
    .flatten()
    .collect();
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}
