//! Reads the command line, and says what is wrong with it: which option, what was found, what is allowed.

use super::Cli;
use super::streams::{legible, tell};
use clap::Parser;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use std::error::Error;
use std::ffi::OsString;
use std::io::{self, Write};
use std::num::{IntErrorKind, ParseFloatError, ParseIntError};
use std::process::ExitCode;

/// The arguments, or the exit status after help, version or a refusal has been printed.
pub fn read() -> Result<Cli, ExitCode> {
    Cli::try_parse_from(joined(std::env::args_os())).map_err(|error| answer(&error))
}

/// A number after an option is its value, a negative one too: `--count -1` is read as `--count=-1`, so that a refusal
/// names the option.
fn joined(arguments: impl Iterator<Item = OsString>) -> Vec<OsString> {
    let mut joined: Vec<OsString> = Vec::new();
    let mut options = true;
    for argument in arguments {
        options = options && argument != "--";
        match joined.last_mut() {
            Some(before) if options && is_bare_option(before) && is_negative(&argument) => {
                before.push("=");
                before.push(argument);
            }
            _ => joined.push(argument),
        }
    }
    joined
}

/// `--count` or `-o`, without a value.
fn is_bare_option(argument: &OsString) -> bool {
    let name = argument.to_str().and_then(|text| text.strip_prefix("--").or_else(|| text.strip_prefix('-')));
    name.is_some_and(|name| name.starts_with(|c: char| c.is_ascii_alphabetic()) && !name.contains('='))
        && !is_negative(argument)
}

/// `-1`, `-.5`, `-3:5`, `-inf`.
fn is_negative(argument: &OsString) -> bool {
    let Some(value) = argument.to_str().and_then(|text| text.strip_prefix('-')) else { return false };
    value.starts_with(|c: char| c.is_ascii_digit() || c == '.')
        || ["inf", "infinity", "nan"].contains(&value.to_ascii_lowercase().as_str())
}

fn answer(error: &clap::Error) -> ExitCode {
    if !error.use_stderr() {
        return match error.print().and_then(|()| io::stdout().flush()) {
            Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
                tell(&format!("error: standard output: {error}"));
                ExitCode::from(2)
            }
            _ => ExitCode::SUCCESS,
        };
    }
    let whole = error.render().to_string();
    if let Some(expected) = expected(error) {
        tell(&format!("error: {}\n\nFor more information, try '--help'.", legible(&expected)));
    } else if error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand || legible(&whole) == whole {
        // With colours on a terminal. Where it cannot be written, see `tell`.
        let _ = error.print();
    } else {
        tell(legible(&whole).trim_end());
    }
    ExitCode::from(2)
}

/// What is allowed where a number could not be read, which the standard library's errors do not say.
fn expected(error: &clap::Error) -> Option<String> {
    let text = |kind| match error.get(kind) {
        Some(ContextValue::String(text)) => Some(text.as_str()),
        _ => None,
    };
    let (option, value) = (text(ContextKind::InvalidArg)?, text(ContextKind::InvalidValue)?);
    let source = error.source()?;
    let allowed = if let Some(source) = source.downcast_ref::<ParseIntError>() {
        match source.kind() {
            IntErrorKind::PosOverflow | IntErrorKind::NegOverflow => "a whole number of fewer digits",
            _ if value.starts_with('-') => "a whole number that is not negative",
            _ => "a whole number",
        }
    } else if source.is::<ParseFloatError>() {
        "a number, such as 0.05, -6e-2 or 20"
    } else {
        return None;
    };
    Some(format!("invalid value '{value}' for '{option}': expected {allowed}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_as(line: &str) -> Vec<OsString> {
        joined(line.split(' ').map(OsString::from))
    }

    fn words(line: &str) -> Vec<OsString> {
        line.split(' ').map(OsString::from).collect()
    }

    #[test]
    fn negative_numbers_belong_to_the_option_before_them() {
        for (line, expected) in [
            ("s diagram --count -1 --json", "s diagram --count=-1 --json"),
            ("s render --frames -3:5", "s render --frames=-3:5"),
            ("s orbit --xi1 -.5 -o -1", "s orbit --xi1=-.5 -o=-1"),
            ("s orbit --xi1=3 -1 -inf", "s orbit --xi1=3 -1 -inf"),
            ("s run -- --count -1", "s run -- --count -1"),
            ("s orbit --xi1 -NaN --xi2 --kappa", "s orbit --xi1=-NaN --xi2 --kappa"),
        ] {
            assert_eq!(read_as(line), words(expected));
        }
    }
}
