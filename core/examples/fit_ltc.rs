//! Makes `core/src/lighting/area/cosines.f32`: `cargo run -p burnish-core --example fit_ltc -- FILE`.

use burnish_core::lighting::area::NODES;
use burnish_core::lighting::area::fit;
use burnish_core::surface::ggx::Masking;
use rayon::prelude::*;

fn main() -> std::io::Result<()> {
    let mut bytes = Vec::new();
    for masking in Masking::ALL {
        let rows: Vec<_> = (0..NODES).into_par_iter().map(|node| fit::row(node, masking)).collect();
        for (node, row) in rows.iter().enumerate() {
            let errors = (0..NODES).zip(row).map(|(column, p)| fit::error(node as u32, column, masking, p));
            let errors: Vec<_> = errors.map(|e| format!("{:4.1}", 100.0 * e)).collect();
            println!("{masking:?} row {node}, % of the light: {}", errors.join(" "));
            bytes.extend(row.iter().flatten().flat_map(|x| (*x as f32).to_le_bytes()));
        }
    }
    match std::env::args().nth(1) {
        Some(path) => std::fs::write(path, bytes),
        None => Ok(()),
    }
}
