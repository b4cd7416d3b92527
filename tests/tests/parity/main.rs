//! Every WGSL leaf equals its Rust twin on the GPU, over a grid with its limits.
//!
//! One file per leaf holds its cases. A leaf without a case fails, and so does a function of a leaf that no case
//! reaches. `trace` compares rays, which are no leaf.

mod area;
mod area_cube;
mod blinn_phong;
mod classical;
mod coat;
mod curves;
mod dielectric;
mod fresnel;
mod ggx;
mod grid;
mod ground;
mod harness;
mod impostor;
mod lambert;
mod layered;
mod math;
mod micro_normal;
mod probe;
mod surface;
mod tone;
mod trace;
mod view;

use std::collections::BTreeSet;

use burnish_core::leaf;
use burnish_tests::{Need, trial};
use libtest_mimic::{Arguments, Trial};
use naga::compact::{KeepUnused, compact};
use naga::valid::{Capabilities, ValidationFlags, Validator};

use harness::Case;

fn main() {
    let mut trials: Vec<Trial> =
        cases().into_iter().map(|case| trial(case.name, &[Need::Gpu], move || case.run())).collect();
    trials.push(trial("every function of every leaf is compared", &[], every_function_is_compared));
    trials.push(trial("differences over the tolerance are faults", &[], harness::differences_are_faults));
    trials.extend(trace::trials());
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    cases.extend(math::cases());
    cases.extend(tone::cases());
    cases.extend(view::cases());
    cases.extend(ground::cases());
    cases.extend(fresnel::cases());
    cases.extend(ggx::cases());
    cases.extend(lambert::cases());
    cases.extend(blinn_phong::cases());
    cases.extend(dielectric::cases());
    cases.extend(coat::cases());
    cases.extend(layered::cases());
    cases.extend(micro_normal::cases());
    cases.extend(area::cases());
    cases.extend(area_cube::cases());
    cases.extend(classical::cases());
    cases.extend(impostor::cases());
    cases.extend(probe::cases());
    cases
}

/// Needs no GPU: naga tells which functions an entry point reaches.
fn every_function_is_compared() {
    let cases = cases();
    for leaf in burnish_core::leaves::all() {
        let mut reached = BTreeSet::new();
        for case in cases.iter().filter(|case| case.leaf.name == leaf.name) {
            let mut module = validated(case.name, &case.source());
            compact(&mut module, KeepUnused::No);
            reached.extend(names(&module));
        }
        let alone = naga::front::wgsl::parse_str(&format!("{}\n{}", leaf::join(&[leaf]), externs(leaf))).unwrap();
        let own = format!("\n{}", leaf.source);
        let missed: Vec<_> = names(&alone)
            .into_iter()
            .filter(|name| own.contains(&format!("\nfn {name}(")) && !reached.contains(name))
            .collect();
        assert!(!reached.is_empty(), "no case for the leaf `{}`", leaf.name);
        assert!(missed.is_empty(), "no case of the leaf `{}` calls {missed:?}", leaf.name);
    }
}

fn validated(name: &str, source: &str) -> naga::Module {
    let module = naga::front::wgsl::parse_str(source)
        .unwrap_or_else(|e| panic!("{name} does not parse:\n{}", e.emit_to_string(source)));
    Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .unwrap_or_else(|e| panic!("{name} is not valid:\n{}", e.emit_to_string(source)));
    module
}

fn names(module: &naga::Module) -> Vec<String> {
    module.functions.iter().filter_map(|(_, function)| function.name.clone()).collect()
}

fn externs(leaf: &'static leaf::Leaf) -> String {
    leaf::order(leaf).iter().map(|needed| format!("{}\n", needed.externs)).collect()
}
