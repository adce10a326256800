//! `riprap`: computes scenes and tells about them.

use clap::{Parser, Subcommand};
use riprap_harness::{adapters, check, schema};
use std::process::ExitCode;

#[derive(Parser)]
#[command(version, about)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Check(check::Args),
    Adapters(adapters::Args),
    Schema(schema::Args),
}

fn main() -> ExitCode {
    let done = match Cli::parse().command {
        Command::Check(args) => check::run(&args),
        Command::Adapters(args) => adapters::run(&args),
        Command::Schema(args) => schema::run(&args),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("riprap: {error:#}");
            ExitCode::from(2)
        }
    }
}
