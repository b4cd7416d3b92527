//! WGSL leaves: pure shader functions that stand beside their Rust twin.
//!
//! A leaf holds functions, structs and constants only: no bindings, no entry points, no textures. What it must look up
//! it asks of a function that the joining pass defines; such functions are declared in [`Leaf::externs`].

/// One WGSL source file with what it stands on.
pub struct Leaf {
    /// Name of the file without its ending, unique among all leaves.
    pub name: &'static str,
    /// WGSL text.
    pub source: &'static str,
    /// Leaves that must come before this one.
    pub needs: &'static [&'static Leaf],
    /// WGSL definitions that stand in for the functions the pass supplies, so that the leaf validates alone.
    /// Empty when the leaf looks nothing up.
    pub externs: &'static str,
}

/// Joins leaves into one source, each once, what is needed before what needs it.
pub fn join(leaves: &[&'static Leaf]) -> String {
    let mut order = Vec::new();
    for leaf in leaves {
        visit(leaf, &mut order);
    }
    order.iter().map(|leaf| format!("// leaf: {}\n{}\n", leaf.name, leaf.source)).collect()
}

/// The leaves that `join` would write for `leaf`, in order, itself last.
pub fn order(leaf: &'static Leaf) -> Vec<&'static Leaf> {
    let mut order = Vec::new();
    visit(leaf, &mut order);
    order
}

/// Depth first; the needs of leaves are `static` references and so cannot form a cycle at run time.
fn visit(leaf: &'static Leaf, order: &mut Vec<&'static Leaf>) {
    if order.iter().any(|seen| seen.name == leaf.name) {
        return;
    }
    for need in leaf.needs {
        visit(need, order);
    }
    order.push(leaf);
}
