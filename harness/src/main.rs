//! `riprap`: runs scenes and reports on them.

use clap::{Parser, Subcommand};
use riprap::Error;
use riprap_harness::{
    adapters, bench, check, fingerprint, migrate, records, report,
    run::{self, Unfinished},
    schema, stress, threshold, validate,
};
use std::{
    process::ExitCode,
    sync::atomic::{AtomicBool, Ordering},
};

#[derive(Parser)]
#[command(version, about, long_about = None, after_help = EXIT)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Run(run::Args),
    Check(check::Args),
    Adapters(adapters::Args),
    Schema(schema::Args),
    Migrate(migrate::Args),
    Threshold(threshold::Args),
    Validate(validate::Args),
    Stress(stress::Args),
    Bench(bench::Args),
    Fingerprint(fingerprint::Args),
    Records(records::Args),
    Report(report::Args),
}

const EXIT: &str = "Exit codes: 0 all went well; 1 a run failed or diverged, or a case did not pass; 2 the input is wrong.";

/// Set by the first Ctrl-C; a run then writes its state and ends.
static STOP: AtomicBool = AtomicBool::new(false);

fn main() -> ExitCode {
    let done = match Cli::parse().command {
        Command::Run(args) => computed(&args),
        Command::Check(args) => check::run(&args).map(|()| ExitCode::SUCCESS),
        Command::Adapters(args) => adapters::run(&args).map(|()| ExitCode::SUCCESS),
        Command::Schema(args) => schema::run(&args).map(|()| ExitCode::SUCCESS),
        Command::Migrate(args) => migrate::run(&args).map(passed),
        Command::Threshold(args) => bisected(&args),
        Command::Validate(args) => validate::run(args).map(passed),
        Command::Stress(args) => stress::run(&args).map(passed),
        Command::Bench(args) => bench::run(args).map(|()| ExitCode::SUCCESS),
        Command::Fingerprint(args) => fingerprinted(&args),
        Command::Records(args) => recorded(&args),
        Command::Report(args) => report::run(&args).map(|()| ExitCode::SUCCESS),
    };
    done.unwrap_or_else(|error| {
        eprintln!("error: {error:#}");
        let ended = matches!(
            error.downcast_ref(),
            Some(
                Error::Diverged { .. }
                    | Error::DeepOverlap { .. }
                    | Error::NotFinite { .. }
                    | Error::Inverted { .. }
                    | Error::DeviceLost(_)
                    | Error::Timeout { .. }
            )
        );
        let running = ended || error.is::<Unfinished>();
        ExitCode::from(if running { 1 } else { 2 })
    })
}

fn passed(all: bool) -> ExitCode {
    ExitCode::from(u8::from(!all))
}

/// Makes the first Ctrl-C stop the run after its batch, and the second one end the process.
fn listen() -> anyhow::Result<()> {
    ctrlc::set_handler(|| {
        if STOP.swap(true, Ordering::Relaxed) {
            // The exit code that shells report for a process killed by SIGINT.
            std::process::exit(130);
        }
        eprintln!("stopping after this batch; Ctrl-C again ends at once");
    })?;
    Ok(())
}

fn bisected(args: &threshold::Args) -> anyhow::Result<ExitCode> {
    listen()?;
    let report = threshold::run(args, &STOP)?;
    if args.json {
        println!("{}", serde_json::to_string_pretty(&report)?);
    } else {
        println!("{report}");
    }
    Ok(ExitCode::SUCCESS)
}

fn fingerprinted(args: &fingerprint::Args) -> anyhow::Result<ExitCode> {
    listen()?;
    fingerprint::run(args, &STOP).map(passed)
}

fn recorded(args: &records::Args) -> anyhow::Result<ExitCode> {
    listen()?;
    records::run(args, &STOP).map(passed)
}

fn computed(args: &run::Args) -> anyhow::Result<ExitCode> {
    listen()?;
    let summary = run::run(args, &STOP)?;
    if args.json {
        println!("{}", serde_json::to_string_pretty(&summary)?);
    } else {
        println!("{summary}");
    }
    if let Some(divergence) = &summary.divergence {
        eprintln!("error: {divergence}; {}", summary.kept());
        return Ok(ExitCode::from(1));
    }
    Ok(ExitCode::SUCCESS)
}
