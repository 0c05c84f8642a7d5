//! The command line: one file per command. The only place that prints.

mod analysis;
mod arguments;
mod branch;
mod case_args;
mod common;
mod conformance;
mod damping_map;
mod diagram;
mod disk;
mod draw_args;
mod exchange;
mod film;
mod gallery;
mod generate;
mod hopf;
mod licences;
mod lyapunov;
mod modes;
mod motions;
mod orbit;
mod paper;
mod pictures;
mod plot;
mod poincare;
mod progress;
mod render;
mod run;
mod shown;
mod simulate;
mod slow_flow;
mod story;
mod streams;
mod sweep;
mod trajectory_table;

use clap::{Parser, Subcommand};
use std::process::ExitCode;
use streams::{legible, tell};
use tracing_subscriber::EnvFilter;

/// Self-excited, friction-damped oscillators: exact solution, Rapier simulation, cross-check and film.
#[derive(Debug, Parser)]
#[command(
    name = "stickslip",
    version,
    max_term_width = 110,
    arg_required_else_help = true,
    args_conflicts_with_subcommands = true,
    after_help = "Exit status: 0 done; 1 done, but a check or comparison failed; 2 bad input, or it could not run. A \
                  reader of the output that has gone away changes nothing. Output that cannot be written for another \
                  reason is exit status 2. News and messages that cannot be written are lost.\n\n\
                  Example:\n  stickslip run        the main job with the built-in scene, into renders/limit_torus"
)]
struct Cli {
    /// Print the licences of what is in this program.
    #[arg(long)]
    licences: bool,
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Debug, Subcommand)]
enum Command {
    Run(run::RunArgs),
    Simulate(simulate::SimulateArgs),
    Render(render::RenderArgs),
    ContactSheet(pictures::ContactSheetArgs),
    Animate(pictures::AnimateArgs),
    Gallery(gallery::GalleryArgs),
    Orbit(orbit::OrbitArgs),
    Branch(branch::BranchArgs),
    Hopf(hopf::HopfArgs),
    Lyapunov(lyapunov::LyapunovArgs),
    Poincare(poincare::PoincareArgs),
    Diagram(diagram::DiagramArgs),
    Conformance(conformance::ConformanceArgs),
    SlowFlow(slow_flow::SlowFlowArgs),
    Paper(paper::PaperArgs),
    Modes(modes::ModesArgs),
    Disk(disk::DiskArgs),
    /// Print the JSON Schema of scene files.
    Schema(generate::SchemaArgs),
    /// Print shell completions.
    Completions(generate::CompletionsArgs),
    /// Print the manual page.
    #[command(after_help = "Example:\n  stickslip man > stickslip.1")]
    Man,
}

/// How a command that could run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Verdict {
    Done,
    /// A check or comparison failed.
    Failed,
}

/// The error and its causes, each said once: messages of the library often name their cause already.
fn message(error: &anyhow::Error) -> String {
    error.chain().map(ToString::to_string).fold(String::new(), |said, cause| match said.as_str() {
        "" => cause,
        _ if said.contains(&cause) => said,
        _ => format!("{said}: {cause}"),
    })
}

/// Parses the command line, runs the command and returns its exit status: 0 done, 1 a check failed, 2 bad input or could not run.
#[must_use]
pub fn main() -> ExitCode {
    let cli = match arguments::read() {
        Ok(cli) => cli,
        Err(status) => return status,
    };
    // wgpu's back ends log what they try and do not find; the choice of adapter is reported by ourselves.
    let filter = EnvFilter::try_from_default_env()
        .unwrap_or_else(|_| EnvFilter::new("warn,wgpu_core=off,wgpu_hal=off,wgpu=off,naga=off"));
    // A log that cannot be written is lost: the subscriber would say so on standard error, and panic.
    let logs = tracing_subscriber::fmt().log_internal_errors(false);
    logs.with_env_filter(filter).with_writer(std::io::stderr).init();
    match cli.command.as_ref().map_or_else(licences::run, run) {
        Ok(Verdict::Done) => ExitCode::SUCCESS,
        Ok(Verdict::Failed) => ExitCode::from(1),
        Err(error) => {
            tell(&format!("error: {}", legible(&message(&error))));
            ExitCode::from(2)
        }
    }
}

fn run(command: &Command) -> anyhow::Result<Verdict> {
    match command {
        Command::Run(args) => run::run(args),
        Command::Simulate(args) => simulate::run(args),
        Command::Render(args) => render::run(args),
        Command::ContactSheet(args) => pictures::sheet(args),
        Command::Animate(args) => pictures::animate(args),
        Command::Gallery(args) => gallery::run(args),
        Command::Orbit(args) => orbit::run(args),
        Command::Branch(args) => branch::run(args),
        Command::Hopf(args) => hopf::run(args),
        Command::Lyapunov(args) => lyapunov::run(args),
        Command::Poincare(args) => poincare::run(args),
        Command::Diagram(args) => diagram::run(args),
        Command::Conformance(args) => conformance::run(args),
        Command::SlowFlow(args) => slow_flow::run(args),
        Command::Paper(args) => paper::run(args),
        Command::Modes(args) => modes::run(args),
        Command::Disk(args) => disk::run(args),
        Command::Schema(args) => generate::schema(args),
        Command::Completions(args) => generate::completions(args),
        Command::Man => generate::man(),
    }
}
