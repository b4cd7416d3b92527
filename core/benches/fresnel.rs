//! Time of every Fresnel form over a batch of RGB reflectances: `cargo bench -p burnish-core --bench fresnel`.

use std::hint::black_box;

use burnish_core::material::preset;
use burnish_core::surface::fresnel::Form;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};

/// RGB evaluations of a batch: what fits into the first cache with its results.
const SIZE: usize = 1024;

fn forms(c: &mut Criterion) {
    let gold = preset::find("Au").expect("a preset of the library");
    let cosines: Vec<f32> = (0..SIZE).map(|i| (i as f32 + 0.5) / SIZE as f32).collect();
    let mut out = [(); 3].map(|()| vec![0.0; SIZE]);
    let mut group = c.benchmark_group("fresnel");
    group.throughput(Throughput::Elements(SIZE as u64));
    for form in Form::ALL {
        let curve = gold.fresnel(form);
        group.bench_function(format!("{form}/{SIZE}"), |b| {
            b.iter(|| {
                black_box(&curve).eval_batch(black_box(&cosines), out.each_mut().map(Vec::as_mut_slice));
                black_box(&mut out);
            });
        });
    }
    group.finish();
}

criterion_group!(benches, forms);
criterion_main!(benches);
