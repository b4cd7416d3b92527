//! `burnish methods`: the lighting methods, what they cover, and their settings; also as the page of the documentation.

use std::io::Write;

use burnish_core::lighting::{self, Method, MethodInfo};
use burnish_core::param::{ParamSpec, Settings};
use serde_json::{Value, json};

use super::write_json;
use crate::failure::{Exit, Failure};

#[derive(clap::Args)]
pub struct Args {
    /// Print JSON
    #[arg(long)]
    json: bool,
    /// Print the page of the documentation
    #[arg(long, conflicts_with = "json")]
    markdown: bool,
}

pub fn run(args: Args, out: &mut dyn Write) -> Result<Exit, Failure> {
    let methods = lighting::methods();
    if args.json {
        write_json(out, &methods.iter().map(|method| object(*method)).collect::<Vec<_>>())?;
    } else if args.markdown {
        write!(out, "{}", page(&methods))?;
    } else {
        for method in methods {
            plain(method.info(), out)?;
        }
    }
    Ok(Exit::Ok)
}

fn plain(info: &MethodInfo, out: &mut dyn Write) -> Result<(), Failure> {
    writeln!(out, "{}\n  {}", info.id, info.summary)?;
    for (term, cover, filled_by) in info.coverage.terms() {
        writeln!(out, "  {term:18} {}", cover.words(filled_by))?;
    }
    for spec in info.params {
        writeln!(out, "  --set {:20} {} [default: {}]", spec.key, spec.kind, default_text(info, spec))?;
    }
    Ok(())
}

fn object(method: &dyn Method) -> Value {
    let info = method.info();
    let coverage: Vec<Value> = info
        .coverage
        .terms()
        .into_iter()
        .map(|(term, cover, _)| json!({ "term": term, "cover": cover.word() }))
        .collect();
    let setting = |spec: &ParamSpec| {
        json!({
            "key": spec.key, "label": spec.label, "unit": spec.unit, "values": spec.kind.to_string(),
            "default": default_text(info, spec), "help": spec.help,
        })
    };
    let settings: Vec<Value> = info.params.iter().map(setting).collect();
    let reads: Vec<&str> = info.reads.parts().into_iter().filter(|(_, read)| *read).map(|(name, _)| name).collect();
    json!({
        "id": info.id.0, "title": info.title, "summary": info.summary, "coverage": coverage,
        "fills": info.coverage.fills(), "prepares_from": reads, "settings": settings,
    })
}

/// The page of the documentation.
fn page(methods: &[&'static dyn Method]) -> String {
    let mut text = String::from(
        "# Lighting methods\n\nMade by `burnish methods --markdown`. A method does some terms of the light; the frame \
         fills in the others, as the table says. What each is and where it fails stands on its page.\n",
    );
    for method in methods {
        let info = method.info();
        text += &format!("\n## {} (`{}`)\n\n{}\n\n| Term | Cover |\n|---|---|\n", info.title, info.id, info.summary);
        for (term, cover, filled_by) in info.coverage.terms() {
            text += &format!("| {term} | {} |\n", cover.words(filled_by));
        }
        text += "\n| Setting | Values | Default | |\n|---|---|---|---|\n";
        for spec in info.params {
            let cell = |text: &str| text.replace('|', "\\|");
            let (values, help) = (cell(&spec.kind.to_string()), cell(spec.help));
            text += &format!("| `{}` | {values} | {} | {help} |\n", spec.key, default_text(info, spec));
        }
    }
    text
}

fn default_text(info: &MethodInfo, spec: &ParamSpec) -> String {
    Settings::new(info.params).text(spec.key).unwrap_or_default()
}
