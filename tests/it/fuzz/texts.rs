//! Texts that are nearly right: scenes, stories and set-ups changed in places.

use super::dice::Dice;

/// What stands for a piece of a text.
const PIECES: [&str; 16] =
    ["", "\0", "\u{feff}", "[[", "]", "\"", "= ", "\n", "{", "}", "\u{1b}[31m", "é", "\u{1f980}", "'''", "-", "null"];

/// Changes a text in one to four places.
pub fn changed(dice: &mut Dice, text: &str, others: &[String]) -> String {
    let mut text = text.to_owned();
    for _ in 0..=dice.below(4) {
        text = change(dice, &text, others);
    }
    text
}

fn change(dice: &mut Dice, text: &str, others: &[String]) -> String {
    match dice.below(12) {
        0..=4 => number_replaced(dice, text),
        5 => line_by_line(dice, text, |dice, lines| {
            let at = dice.below(lines.len());
            lines.remove(at);
        }),
        6 => line_by_line(dice, text, |dice, lines| {
            let (from, to) = (dice.below(lines.len()), dice.below(lines.len()));
            let line = lines[from].clone();
            lines.insert(to, line);
        }),
        7 => line_by_line(dice, text, |dice, lines| {
            // A line of another text, which may be a table this one does not have.
            let other: Vec<&str> = dice.pick(others).lines().collect();
            let line = (*dice.pick(&other)).to_owned();
            let at = dice.below(lines.len());
            lines.insert(at, line);
        }),
        8 => word_replaced(dice, text, others),
        9 => {
            let (start, end) = (boundary(dice, text), boundary(dice, text));
            let (start, end) = (start.min(end), start.max(end));
            format!(
                "{}{}{}",
                &text[..start],
                dice.pick(&PIECES),
                &text[end.min(start + 40).max(start)..].trim_start_matches('\u{fffd}')
            )
        }
        10 => text[..boundary(dice, text)].to_owned(),
        _ => {
            let long = match dice.below(4) {
                0 => format!("x = {}", "[".repeat(20_000)),
                1 => format!("title = \"{}\"", "y".repeat(20_000)),
                2 => "[a]\n".repeat(2_000),
                _ => format!("{} = 1", "a.".repeat(10_000)),
            };
            format!("{text}\n{long}\n")
        }
    }
}

/// A place between characters.
fn boundary(dice: &mut Dice, text: &str) -> usize {
    let at = dice.below(text.len() + 1);
    (at..=text.len()).find(|at| text.is_char_boundary(*at)).unwrap_or(text.len())
}

fn line_by_line(dice: &mut Dice, text: &str, change: impl FnOnce(&mut Dice, &mut Vec<String>)) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    if lines.is_empty() {
        return text.to_owned();
    }
    change(dice, &mut lines);
    lines.join("\n") + "\n"
}

/// Start and end of the pieces that `belongs` holds together.
fn spans(text: &str, belongs: impl Fn(char) -> bool) -> Vec<(usize, usize)> {
    let mut spans: Vec<(usize, usize)> = Vec::new();
    for (at, c) in text.char_indices().filter(|(_, c)| belongs(*c)) {
        match spans.last_mut() {
            Some((_, end)) if *end == at => *end = at + c.len_utf8(),
            _ => spans.push((at, at + c.len_utf8())),
        }
    }
    spans
}

fn number_replaced(dice: &mut Dice, text: &str) -> String {
    let number = |c: char| c.is_ascii_digit() || ".-+".contains(c);
    let spans: Vec<_> =
        spans(text, number).into_iter().filter(|(a, b)| text[*a..*b].contains(|c: char| c.is_ascii_digit())).collect();
    if spans.is_empty() {
        return text.to_owned();
    }
    let (start, end) = *dice.pick(&spans);
    format!("{}{}{}", &text[..start], dice.number(), &text[end..])
}

fn word_replaced(dice: &mut Dice, text: &str, others: &[String]) -> String {
    let word = |c: char| c.is_alphabetic() || c == '_';
    let from = dice.pick(others);
    let (mine, theirs) = (spans(text, word), spans(from, word));
    if mine.is_empty() || theirs.is_empty() {
        return text.to_owned();
    }
    let ((start, end), (a, b)) = (*dice.pick(&mine), *dice.pick(&theirs));
    format!("{}{}{}", &text[..start], &from[a..b], &text[end..])
}
