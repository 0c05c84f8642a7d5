//! The SVG of plotters with fewer bytes and the same picture: attributes that say the default, and a path for successive lines of one look.

/// Attributes that say what holds without them.
const DEFAULTS: [&str; 3] = [" opacity=\"1\"", " stroke=\"none\" stroke-width=\"1\"", " font-family=\"sans-serif\""];
const LINE: &str = "<polyline fill=\"none\"";
const POINTS: &str = " points=\"";

/// The same picture. Letters get their family from the root.
pub(super) fn slim(svg: &str) -> String {
    let mut short = svg.replacen("<svg ", "<svg font-family=\"sans-serif\" ", 1);
    let (root, rest) = short.split_at(short.find('\n').unwrap_or(short.len()));
    let mut rest = rest.to_owned();
    for default in DEFAULTS {
        rest = rest.replace(default, "");
    }
    short = format!("{root}{rest}");
    let mut lines: Vec<String> = Vec::new();
    // Look of the path that the last of `lines` is, without its end.
    let mut open: Option<String> = None;
    for line in short.lines() {
        let polyline = line.strip_prefix(LINE).and_then(|line| line.split_once(POINTS));
        let Some((look, points)) = polyline else {
            close(&mut lines, open.take());
            lines.push(line.to_owned());
            continue;
        };
        let path = format!("M{}", points.trim_end_matches("/>").trim_end_matches('"').trim());
        match lines.last_mut() {
            Some(last) if open.as_deref() == Some(look) => last.push_str(&path),
            _ => {
                close(&mut lines, open.replace(look.to_owned()));
                lines.push(format!("<path fill=\"none\"{look} d=\"{path}"));
            }
        }
    }
    close(&mut lines, open);
    lines.join("\n")
}

fn close(lines: &mut [String], open: Option<String>) {
    if let (Some(last), Some(_)) = (lines.last_mut(), open) {
        last.push_str("\"/>");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_one_look_become_one_path_and_others_stay_apart() {
        let line = |stroke: &str, points: &str| {
            format!("<polyline fill=\"none\" opacity=\"1\" stroke=\"{stroke}\" points=\"{points} \"/>")
        };
        let text = "<text x=\"1\" font-family=\"sans-serif\" opacity=\"1\">\na\n</text>";
        let svg = [
            "<svg width=\"9\">",
            &line("red", "1,2 3,4"),
            &line("red", "5,6 7,8"),
            &line("blue", "1,2 3,4"),
            text,
            &line("blue", "5,5 6,6"),
            "</svg>",
        ];
        let expected = [
            "<svg font-family=\"sans-serif\" width=\"9\">",
            "<path fill=\"none\" stroke=\"red\" d=\"M1,2 3,4M5,6 7,8\"/>",
            "<path fill=\"none\" stroke=\"blue\" d=\"M1,2 3,4\"/>",
            "<text x=\"1\">\na\n</text>",
            "<path fill=\"none\" stroke=\"blue\" d=\"M5,5 6,6\"/>",
            "</svg>",
        ];
        assert_eq!(slim(&svg.join("\n")), expected.join("\n"));
    }
}
