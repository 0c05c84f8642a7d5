//! Standard error: news, logs and the last word of a run that failed.
//!
//! A line that cannot be written (a full disk, a closed stream, a reader that has gone away) is lost and is no failure:
//! the exit status says how the run ended. Standard output is the result, and is lost only to a reader that has gone
//! away (see `common::print`).

use std::io::Write;

/// Longest message, in bytes. What is quoted from files and arguments may be of any length.
const LONGEST: usize = 900;
/// What is kept of the end of a longer one, where it says what to do.
const END: usize = 250;

/// A line on standard error.
pub fn tell(line: &str) {
    // Nothing is left to say it with.
    let _ = writeln!(std::io::stderr(), "{line}");
}

/// The message on one screen: without its middle if it is long, and without control characters, which would move the
/// cursor.
pub fn legible(message: &str) -> String {
    let plain = |c: char| if c.is_control() && c != '\n' { c.escape_default().to_string() } else { c.to_string() };
    let message: String = message.chars().map(plain).collect();
    if message.len() <= LONGEST {
        return message;
    }
    let (start, end) = (floor(&message, LONGEST - END), floor(&message, message.len() - END));
    format!("{} [... {} bytes left out ...] {}", &message[..start], end - start, &message[end..])
}

/// The largest boundary of characters up to `at`.
fn floor(text: &str, at: usize) -> usize {
    (0..=at).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_message_keeps_its_start_and_its_end() {
        let short = "gamma = 1.5 is not allowed\ntake another";
        assert_eq!(legible(short), short);
        let long = format!("scene.toml: {} ends here", "\u{e4}".repeat(5000));
        let found = legible(&long);
        assert!(found.len() < 1000 && found.starts_with("scene.toml") && found.ends_with("ends here"), "{found}");
        assert_eq!(legible("a\u{1b}[2Jb"), "a\\u{1b}[2Jb");
    }
}
