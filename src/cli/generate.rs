//! `schema`, `completions`, `man`: texts made from the declarations they describe.

use super::common::print;
use super::{Cli, Verdict};
use crate::conformance::Report;
use crate::scene::Scene;
use anyhow::Context;
use clap::{Args, CommandFactory, ValueEnum};
use clap_complete::Shell;

#[derive(Debug, Clone, Copy, ValueEnum)]
enum SchemaName {
    Scene,
    /// `report.json` of `conformance`.
    Conformance,
}

#[derive(Debug, Args)]
#[command(after_help = "Example:\n  stickslip schema scene > scene.schema.json")]
pub struct SchemaArgs {
    /// What to describe.
    name: SchemaName,
}

#[derive(Debug, Args)]
#[command(after_help = "Example:\n  stickslip completions bash > /etc/bash_completion.d/stickslip")]
pub struct CompletionsArgs {
    shell: Shell,
}

pub fn schema(args: &SchemaArgs) -> anyhow::Result<Verdict> {
    let schema = match args.name {
        SchemaName::Scene => Scene::json_schema(),
        SchemaName::Conformance => Report::json_schema(),
    };
    print(&serde_json::to_string_pretty(&schema).context("schema")?)?;
    Ok(Verdict::Done)
}

pub fn completions(args: &CompletionsArgs) -> anyhow::Result<Verdict> {
    let mut text = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "stickslip", &mut text);
    print(String::from_utf8(text)?.trim_end())?;
    Ok(Verdict::Done)
}

pub fn man() -> anyhow::Result<Verdict> {
    let mut text = Vec::new();
    clap_mangen::Man::new(Cli::command()).render(&mut text)?;
    for command in Cli::command().get_subcommands() {
        let name = format!("stickslip-{}", command.get_name());
        clap_mangen::Man::new(command.clone().display_name(name.clone()).bin_name(name)).render(&mut text)?;
    }
    print(String::from_utf8(text)?.trim_end())?;
    Ok(Verdict::Done)
}
