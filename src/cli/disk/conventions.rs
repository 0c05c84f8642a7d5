//! `disk conventions`: the picture of how blades are numbered, what an interblade phase angle is, and which way a wave runs, as SVG.
//!
//! Drawn from the definition `x_j = cos(w t - j sigma)` with the model's own angles.

use super::super::Verdict;
use super::super::common::print;
use crate::model::NodalDiameter;
use crate::render::Colour;
use crate::scene::Theme;
use crate::stage::DeflectionColours;
use clap::Args;
use std::f64::consts::TAU;
use std::fmt::Write;

const BLADES: usize = 12;
/// The wave shown.
const WAVE: i64 = 2;
/// Middle of the ring, its hub, tips, line through the tips, numbers, arrows; pixels.
const MIDDLE: [f64; 2] = [235.0, 262.0];
const HUB: f64 = 70.0;
const TIP: f64 = 150.0;
const LINE: [f64; 2] = [168.0, 12.0];
const NUMBER: f64 = 197.0;
const ARROW: f64 = 218.0;
/// Left, top, width and half height of the diagram of three blades over time, and the periods it shows.
const PLOT: [f64; 4] = [505.0, 150.0, 350.0, 55.0];
const PERIODS: f64 = 1.6;
const BLUE: &str = "#0a4fb3";
const SERIES: [&str; 3] = ["#0072b2", "#b88a00", "#b0437f"];

/// The picture of the conventions as SVG, on standard output.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  stickslip disk conventions > assets/disk_conventions.svg")]
pub struct ConventionsArgs {}

pub fn run(_: &ConventionsArgs) -> anyhow::Result<Verdict> {
    print(picture().trim_end()).map(|()| Verdict::Done)
}

/// Deflection of a blade at a phase `w t`.
fn deflection(blade: f64, phase: f64) -> f64 {
    (phase - blade * NodalDiameter::new(WAVE, BLADES).phase_angle()).cos()
}

/// Pixel at a radius and a place between blades: counter-clockwise from the right, y down.
fn at(radius: f64, blade: f64) -> [f64; 2] {
    let (sine, cosine) = (TAU * blade / BLADES as f64).sin_cos();
    [MIDDLE[0] + radius * cosine, MIDDLE[1] - radius * sine]
}

fn path(points: impl Iterator<Item = [f64; 2]>) -> String {
    points.enumerate().fold(String::new(), |mut text, (n, [x, y])| {
        // Writing to a string cannot fail.
        let _ = write!(text, "{}{x:.1} {y:.1}", if n == 0 { "M" } else { "L" });
        text
    })
}

fn hex(Colour([r, g, b, _]): Colour) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

fn text([x, y]: [f64; 2], size: u32, anchor: &str, colour: &str, words: &str) -> String {
    format!(
        "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{size}\" text-anchor=\"{anchor}\" fill=\"{colour}\">{words}</text>\n"
    )
}

/// The whole picture, without blank lines, so that it can stand in a page of documentation as it is.
fn picture() -> String {
    let mut svg = String::from(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 900 500\" width=\"900\" font-family=\"DejaVu Sans, sans-serif\">\n\
         <rect width=\"900\" height=\"500\" rx=\"8\" fill=\"#ffffff\"/>\n",
    );
    svg.push_str(&ring());
    svg.push_str(&arrows());
    svg.push_str(&diagram());
    svg.push_str(&words());
    svg.push_str("</svg>\n");
    svg
}

fn ring() -> String {
    let colours = DeflectionColours::new(Theme::Light, 1.0);
    let mut svg = String::new();
    for blade in 0..BLADES {
        let place = blade as f64;
        let corners = [(HUB - 4.0, -0.2), (HUB - 4.0, 0.2), (TIP, 0.16), (TIP, -0.16)].map(|(r, b)| at(r, place + b));
        let fill = hex(colours.of(deflection(place, 0.0)));
        let _ = writeln!(svg, "<path d=\"{}Z\" fill=\"{fill}\" stroke=\"#4c5967\"/>", path(corners.into_iter()));
        let [x, y] = at(NUMBER, place);
        svg.push_str(&text([x, y + 5.0], 14, "middle", "#18202a", &blade.to_string()));
    }
    let [x, y] = MIDDLE;
    let _ = writeln!(svg, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{HUB}\" fill=\"#c9d0d7\" stroke=\"#4c5967\"/>");
    let radius = LINE[0];
    let _ = writeln!(
        svg,
        "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" fill=\"none\" stroke=\"#8d98a3\" stroke-dasharray=\"3 4\"/>"
    );
    let line = (0..360).map(|n| f64::from(n) * BLADES as f64 / 360.0);
    let line = path(line.map(|blade| at(LINE[0] + LINE[1] * deflection(blade, 0.0), blade)));
    let _ = writeln!(svg, "<path d=\"{line}Z\" fill=\"none\" stroke=\"#18202a\" stroke-width=\"2.2\"/>");
    svg.push_str(&text([x, y - 14.0], 14, "middle", "#18202a", &format!("N = {BLADES}, n = {WAVE:+}")));
    svg.push_str(&text([x, y + 6.0], 12, "middle", "#4c5967", "seen from above,"));
    svg.push_str(&text([x, y + 22.0], 12, "middle", "#4c5967", "t = 0"));
    svg
}

/// Forward to higher numbers at the right, backward at the left.
fn arrows() -> String {
    let mut svg = String::new();
    for (from, to, word, colour) in
        [(-1.1, 1.0, "forward, n &gt; 0", BLUE), (7.1, 5.0, "backward, n &lt; 0", SERIES[2])]
    {
        let arc = path((0..=24).map(|k| at(ARROW, from + (to - from) * f64::from(k) / 24.0)));
        let _ = writeln!(svg, "<path d=\"{arc}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2.5\"/>");
        let ahead = if to > from { 0.14 } else { -0.14 };
        let head = [(ARROW, to + 1.6 * ahead), (ARROW + 6.5, to), (ARROW - 6.5, to)].map(|(r, b)| at(r, b));
        let _ = writeln!(svg, "<path d=\"{}Z\" fill=\"{colour}\"/>", path(head.into_iter()));
        let [x, _] = at(ARROW, 0.5 * (from + to));
        svg.push_str(&text([x.clamp(80.0, 410.0), 40.0], 14, "middle", colour, word));
    }
    svg
}

/// Three neighbours over time.
fn diagram() -> String {
    let [left, middle, width, half] = PLOT;
    let x = |phase: f64| left + width * phase / (PERIODS * TAU);
    let right = left + width;
    let mut svg = format!("<path d=\"M{left} {middle}L{right} {middle}\" stroke=\"#8d98a3\"/>\n");
    for (blade, colour) in SERIES.iter().enumerate().rev() {
        let line = (0..=160).map(|n| f64::from(n) * PERIODS * TAU / 160.0);
        let line = path(line.map(|phase| [x(phase), middle - half * deflection(blade as f64, phase)]));
        let _ = writeln!(svg, "<path d=\"{line}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2.2\"/>");
        // Their names at the second crests.
        let crest = TAU + blade as f64 * NodalDiameter::new(WAVE, BLADES).phase_angle();
        let place = [x(crest), middle - half - 24.0];
        svg.push_str(&text(place, 13, "middle", colour, &format!("x<tspan dy=\"4\" font-size=\"10\">{blade}</tspan>")));
    }
    // The delay between the first two crests after the start.
    let sigma = NodalDiameter::new(WAVE, BLADES).phase_angle();
    let (from, to, height) = (x(TAU), x(TAU + sigma), middle - half - 8.0);
    let _ = writeln!(svg, "<path d=\"M{from:.1} {height}L{to:.1} {height}\" stroke=\"#18202a\" stroke-width=\"1.5\"/>");
    for end in [from, to] {
        let [above, below] = [height - 4.0, height + 4.0];
        let _ =
            writeln!(svg, "<path d=\"M{end:.1} {above}L{end:.1} {below}\" stroke=\"#18202a\" stroke-width=\"1.5\"/>");
    }
    svg.push_str(&text([0.5 * (from + to), height - 30.0], 13, "middle", "#18202a", "σ/ω"));
    svg.push_str(&text([right, middle + half + 22.0], 13, "end", "#4c5967", "time"));
    svg
}

fn words() -> String {
    let lines = [
        (
            16,
            "x<tspan dy=\"4\" font-size=\"11\">j</tspan><tspan dy=\"-4\">(t) = Re q exp i(ωt − jσ),   ω &gt; 0</tspan>",
        ),
        (14, "σ = 2πn/N: interblade phase angle, n: nodal diameter"),
        (14, "blade j + 1 does σ/ω later what blade j does now"),
        (14, "n &gt; 0: forward, to higher blade numbers"),
        (14, "n &lt; 0: backward;   n = 0 and n = N/2: standing"),
        (14, "seen from above, where x points to, numbers run"),
        (14, "counter-clockwise, and so does a forward wave"),
    ];
    let colours = DeflectionColours::new(Theme::Light, 1.0);
    let mut svg = String::new();
    for (row, (size, line)) in lines.iter().enumerate() {
        svg.push_str(&text([PLOT[0], 270.0 + 26.0 * row as f64], *size, "start", "#18202a", line));
    }
    let cells = 40;
    for cell in 0..cells {
        let value = 2.0 * f64::from(cell) / f64::from(cells - 1) - 1.0;
        let x = PLOT[0] + 70.0 + 4.0 * f64::from(cell);
        let fill = hex(colours.of(value));
        let _ = writeln!(svg, "<rect x=\"{x}\" y=\"456\" width=\"4.2\" height=\"12\" fill=\"{fill}\"/>");
    }
    svg.push_str(&text([PLOT[0], 467.0], 13, "start", "#4c5967", "x = −|q|"));
    svg.push_str(&text([PLOT[0] + 240.0, 467.0], 13, "start", "#4c5967", "+|q|"));
    svg
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_committed_picture_is_fresh_and_can_stand_in_a_page() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/disk_conventions.svg");
        let committed = std::fs::read_to_string(path).unwrap();
        assert!(committed == picture(), "renew it: stickslip disk conventions > assets/disk_conventions.svg");
        assert!(!committed.contains("\n\n"));
    }

    #[test]
    fn crests_of_the_forward_wave_move_to_higher_numbers_counter_clockwise() {
        // A little later the crest that stood at blade 0 stands beyond it, above it in the picture.
        let later = 0.3;
        let beyond = later / NodalDiameter::new(WAVE, BLADES).phase_angle();
        assert!((deflection(beyond, later) - 1.0).abs() < 1e-12 && deflection(-beyond, later) < 1.0);
        assert!(at(TIP, beyond)[1] < at(TIP, 0.0)[1]);
    }
}
