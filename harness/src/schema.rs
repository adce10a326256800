//! `riprap schema`: the format of scenes for editors.

use crate::print;
use anyhow::Result;

/// Prints the JSON schema of scenes.
#[derive(clap::Args, Debug)]
pub struct Args {}

/// Prints the schema.
pub fn run(_: &Args) -> Result<()> {
    print::print_json(&riprap::scene::Scene::schema())
}
