//! `riprap`: computes scenes and tells about them.

use clap::{Parser, Subcommand};
use riprap_harness::{adapters, bench, check, schema, validate};
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
    Validate(validate::Args),
    Bench(bench::Args),
}

fn main() -> ExitCode {
    let done = match Cli::parse().command {
        Command::Check(args) => check::run(&args).map(|()| true),
        Command::Adapters(args) => adapters::run(&args).map(|()| true),
        Command::Schema(args) => schema::run(&args).map(|()| true),
        Command::Validate(args) => validate::run(args),
        Command::Bench(args) => bench::run(args).map(|()| true),
    };
    match done {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("riprap: {error:#}");
            ExitCode::from(2)
        }
    }
}
