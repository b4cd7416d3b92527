//! `burnish fresnel-times`: what the forms cost and how wrong they are, beside published figures.

use std::io::Write;

use burnish_core::material::preset::{self, Preset};
use burnish_core::measure::evaluation_times;
use burnish_core::surface::fresnel::fit::Target;
use burnish_core::surface::fresnel::{Form, Fresnel, exact, grazing_slope};
use burnish_render::{Gpu, times};
use serde::Serialize;

use super::stage::metal_failure;
use super::write_json;
use crate::failure::{Exit, Failure, printable};

/// Wavelengths of the published comparison, nm.
const WAVELENGTHS_NM: [f64; 3] = [435.0, 550.0, 700.0];

/// Largest relative error of the rescaled form over them, as published.
const PUBLISHED_ERRORS: [(&str, f64); 4] = [("Ag", 0.02), ("Cu", 0.05), ("Au", 0.06), ("Al", 0.18)];

/// Published time relative to the exact formula.
const PUBLISHED_TIMES: [(Form, f64); 4] =
    [(Form::EffectiveNk, 1.0), (Form::Schlick, 0.28), (Form::Rescaled, 0.33), (Form::Fitted, 0.54)];

/// Rounds of timing on the processor, of which the median counts.
const ROUNDS: usize = 31;

/// The exact formula: to it all times are relative.
const EXACT: Form = Form::EffectiveNk;

#[derive(clap::Args)]
pub struct Args {
    /// Metal whose curves are timed
    #[arg(long, value_name = "PRESET", default_value = "Au")]
    metal: String,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Report {
    errors: Vec<ErrorRow>,
    /// Adapter of the graphics times; null where there is none.
    adapter: Option<String>,
    /// Why nothing was measured in WGSL.
    reason: Option<String>,
    times: Vec<TimeRow>,
}

/// Largest relative errors of the rescaled form at 435, 550 and 700 nm.
#[derive(Serialize)]
struct ErrorRow {
    metal: &'static str,
    relative: [f64; 3],
    published: f64,
}

/// Nanoseconds for red, green and blue at one angle, and the same relative to the exact formula.
#[derive(Serialize)]
struct TimeRow {
    form: Form,
    cpu_ns: f64,
    cpu_relative: f64,
    gpu_ns: Option<f64>,
    gpu_relative: Option<f64>,
    published: Option<f64>,
}

pub fn run(args: Args, out: &mut dyn Write) -> Result<Exit, Failure> {
    let metal = preset::find(&args.metal).map_err(|e| metal_failure(&args.metal, e))?;
    let errors = PUBLISHED_ERRORS.iter().map(|&(id, published)| error_row(id, published)).collect::<Result<_, _>>()?;
    let gpu = Gpu::new();
    let times = time_rows(&metal, gpu.as_ref().ok())?;
    let reason = gpu.as_ref().err().map(ToString::to_string);
    let report = Report { errors, adapter: gpu.ok().map(|gpu| gpu.report().name.clone()), reason, times };
    if args.json {
        write_json(out, &report)?;
    } else {
        write_text(out, &report, &metal)?;
    }
    Ok(Exit::Ok)
}

fn error_row(metal: &'static str, published: f64) -> Result<ErrorRow, Failure> {
    let constants = preset::find(metal).map_err(|e| Failure::usage(e.to_string()))?;
    let relative = WAVELENGTHS_NM.map(|nm| {
        let (n, k) = constants.index_at(nm);
        let target = Target::new(grazing_slope(n, k), |x| exact(n, k, x));
        target.relative_error(|x| target.rescaled(x))
    });
    Ok(ErrorRow { metal, relative, published })
}

/// Every form; a machine without an adapter still has a processor.
fn time_rows(metal: &Preset, gpu: Option<&Gpu>) -> Result<Vec<TimeRow>, Failure> {
    let curves: Vec<Fresnel> = Form::ALL.iter().map(|form| metal.fresnel(*form)).collect();
    let cpu = evaluation_times(&curves, ROUNDS);
    let gpu_times = gpu.map(|gpu| times::evaluation_times(gpu, &curves)).transpose().map_err(Failure::resources)?;
    let place = Form::ALL.iter().position(|form| *form == EXACT).unwrap_or(0);
    let row = |(i, &form): (usize, &Form)| {
        let gpu = gpu_times.as_ref();
        TimeRow {
            form,
            cpu_ns: 1e9 * cpu[i],
            cpu_relative: cpu[i] / cpu[place],
            gpu_ns: gpu.map(|times| 1e9 * times[i]),
            // A device too fast for the clock.
            gpu_relative: gpu.filter(|times| times[place] > 0.0).map(|times| times[i] / times[place]),
            published: PUBLISHED_TIMES.iter().find(|(known, _)| *known == form).map(|v| v.1),
        }
    };
    Ok(Form::ALL.iter().enumerate().map(row).collect())
}

fn write_text(out: &mut dyn Write, report: &Report, metal: &Preset) -> Result<(), Failure> {
    writeln!(out, "Largest relative error of the rescaled form, %")?;
    writeln!(out, "metal   435 nm  550 nm  700 nm   published")?;
    for ErrorRow { metal, relative: [a, b, c], published } in &report.errors {
        let [a, b, c, published] = [a, b, c, published].map(|v| 100.0 * v);
        writeln!(out, "{metal:6} {a:7.1} {b:7.1} {c:7.1}   {published:9.0}")?;
    }
    let without = || format!("not measured ({})", report.reason.as_deref().unwrap_or("no adapter"));
    let adapter = report.adapter.clone().unwrap_or_else(without);
    writeln!(out, "\nTime for red, green and blue at one angle, {}; {EXACT} is the exact formula", metal.name)?;
    writeln!(out, "CPU: batches of 1024 on one thread; WGSL: {}", printable(&adapter))?;
    writeln!(out, "form            CPU ns      %  WGSL ns      %  published %")?;
    for row in &report.times {
        let number = |v: Option<f64>, decimals: usize| v.map_or("-".into(), |v| format!("{v:.decimals$}"));
        let percent = |v: Option<f64>| number(v.map(|v| 100.0 * v), 0);
        writeln!(
            out,
            "{:14} {:7.2} {:>6}  {:>7} {:>6}  {:>11}",
            row.form,
            row.cpu_ns,
            percent(Some(row.cpu_relative)),
            number(row.gpu_ns, 3),
            percent(row.gpu_relative),
            percent(row.published)
        )?;
    }
    Ok(())
}
