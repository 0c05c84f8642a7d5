//! What the frames of a film say, read off their display lists: every panel's numbers are those of the trajectory. Values are recovered
//! from pixels through the tick labels alone, so that a wrong axis is found as well as a wrong point.

use glam::Vec2;
use stickslip::dynamics::{Flow, Sampling, State, Trajectory};
use stickslip::exact::TwoMassFlow;
use stickslip::model::TwoMassRig;
use stickslip::render::{Anchor, DrawList, OverlayItem};
use stickslip::scene::{Case, Initial, Panel, Scene};
use stickslip::stage::{Beside, DampingMap, Motion, Stage};

const INTERVAL: f64 = 0.04;

fn exact(case: &Case) -> Trajectory {
    let Initial::State { state } = case.initial else { panic!("the built-in scene gives its state") };
    let flow = TwoMassFlow::new(&TwoMassRig::new(case.parameters).unwrap());
    flow.trajectory(&State::two_mass(state), Sampling { interval: INTERVAL, t_end: case.duration }).unwrap()
}

/// The built-in scene and its exact motion.
fn torus() -> (Case, Trajectory) {
    let (_, case) = Scene::built_in().unwrap();
    let trajectory = exact(&case);
    (case, trajectory)
}

fn map() -> DampingMap {
    DampingMap { limit_cycles: vec![(-0.02, 1.0, true)], motions: vec![(-0.2, [0.5, 1.5])], divergence: Some(-0.165) }
}

fn stage(case: &Case, trajectory: &Trajectory) -> Stage {
    let beside = Beside { map: Some(map()), ..Beside::default() };
    Stage::new(case.clone(), Motion::new(trajectory).unwrap(), beside)
}

/// The items of each panel: a panel begins with its box, which has rounded corners of 8 pixels.
fn panels(list: &DrawList) -> Vec<Vec<OverlayItem>> {
    let is_frame = |item: &OverlayItem| matches!(item, OverlayItem::Box { corner_radius, .. } if *corner_radius == 8.0);
    let mut found: Vec<Vec<OverlayItem>> = Vec::new();
    for item in &list.overlay {
        if is_frame(item) {
            found.push(Vec::new());
        } else if let Some(panel) = found.last_mut() {
            panel.push(item.clone());
        }
    }
    found
}

fn panel(list: &DrawList, kind: Panel) -> Vec<OverlayItem> {
    let index = Panel::ALL.iter().position(|panel| *panel == kind).unwrap();
    panels(list)[index].clone()
}

/// A number as it is written, with a minus sign and raised powers of ten.
fn number(text: &str) -> Option<f64> {
    let raised = "⁰¹²³⁴⁵⁶⁷⁸⁹⁻";
    let plain = text.replace("·10", "e").replace('\u{2212}', "-");
    let lower = |letter| {
        raised.chars().zip("0123456789-".chars()).find(|(high, _)| *high == letter).map_or(letter, |pair| pair.1)
    };
    plain.chars().map(lower).collect::<String>().parse().ok()
}

/// Value over pixel, from two ticks.
struct Scale {
    pixels: [f64; 2],
    values: [f64; 2],
}

impl Scale {
    fn value(&self, pixel: f32) -> f64 {
        let part = (f64::from(pixel) - self.pixels[0]) / (self.pixels[1] - self.pixels[0]);
        self.values[0] + part * (self.values[1] - self.values[0])
    }
}

fn scales(panel: &[OverlayItem]) -> [Scale; 2] {
    let ticks = |wanted: Anchor| -> Vec<(Vec2, f64)> {
        let tick = |item: &OverlayItem| match item {
            OverlayItem::Text { position, anchor, text, size, .. } if *anchor == wanted && *size == 11.0 => {
                Some((*position, number(text)?))
            }
            _ => None,
        };
        panel.iter().filter_map(tick).collect()
    };
    let (x, y) = (ticks(Anchor::Centre), ticks(Anchor::Right));
    let ends = |found: &[(Vec2, f64)], pixel: fn(Vec2) -> f32| {
        let (first, last) = (found.first().expect("ticks"), found.last().expect("ticks"));
        Scale { pixels: [first, last].map(|end| f64::from(pixel(end.0))), values: [first.1, last.1] }
    };
    // Labels stand 3.5 pixels below the value they name.
    [ends(&x, |place| place.x), ends(&y, |place| place.y - 3.5)]
}

/// Data of all round marks of a panel, in order.
fn discs(panel: &[OverlayItem]) -> Vec<[f64; 2]> {
    let [x, y] = scales(panel);
    let disc = |item: &OverlayItem| match item {
        OverlayItem::Disc { centre, .. } => Some([x.value(centre.x), y.value(centre.y)]),
        _ => None,
    };
    panel.iter().filter_map(disc).collect()
}

/// Pixels are f32 numbers of size 1000 over panels of a few hundred: 1e-4 pixels of 200, and as much from the ticks, of ranges up to 60.
fn close(found: [f64; 2], expected: [f64; 2]) -> bool {
    found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-4)
}

const FRAMES: [u64; 4] = [0, 100, 333, 600];

#[test]
fn series_hysteresis_and_phase_plane_show_the_state_of_the_moment() {
    let (case, trajectory) = torus();
    let (stage, motion) = (stage(&case, &trajectory), Motion::new(&trajectory).unwrap());
    for index in FRAMES {
        let (list, now) = (stage.frame(index), motion.at(stage.time(index)));
        let ([x1, x2], v1) = (now.positions, now.velocities[0]);
        let series = discs(&panel(&list, Panel::Series));
        assert!(close(series[0], [now.time, x2]) && close(series[1], [now.time, x1]), "{series:?}");
        let hysteresis = discs(&panel(&list, Panel::Hysteresis));
        assert!(close(hysteresis[0], [x1, now.slider_force]), "{hysteresis:?}");
        let phase = discs(&panel(&list, Panel::Phase));
        assert!(close(*phase.last().unwrap(), [x1, v1]), "{phase:?}");
        // Negative control: the frame before is told apart.
        if index > 0 {
            let before = motion.at(stage.time(index - 1));
            assert!(!close(series[1], [before.time, before.positions[0]]));
        }
    }
}

#[test]
fn the_section_accumulates_a_point_at_each_maximum_of_mass_2() {
    let (case, trajectory) = torus();
    let stage = stage(&case, &trajectory);
    for index in FRAMES {
        let now = stage.time(index);
        let past = trajectory.samples.windows(2).filter(|pair| {
            pair[0].state.velocities[1] > 0.0 && pair[1].state.velocities[1] <= 0.0 && pair[1].time <= now + 1e-9
        });
        let found = discs(&panel(&stage.frame(index), Panel::Phase)).len() - 1;
        // A crossing in the sample interval that ends after the frame may count already.
        let expected = past.count();
        assert!(found == expected || found == expected + 1, "{found} points, {expected} maxima");
    }
}

#[test]
fn the_ledger_shows_the_works_of_the_last_period() {
    let (case, trajectory) = torus();
    let (stage, motion) = (stage(&case, &trajectory), Motion::new(&trajectory).unwrap());
    for index in [100, 333, 600] {
        let time = stage.time(index);
        let (now, before) = (motion.at(time).ledger, motion.at(time - std::f64::consts::TAU).ledger);
        let numbers: Vec<f64> = panel(&stage.frame(index), Panel::Energy)
            .iter()
            .filter_map(|item| match item {
                OverlayItem::Text { anchor: Anchor::Right, text, .. } => number(text),
                _ => None,
            })
            .collect();
        let expected = [
            now.works.self_excitation - before.works.self_excitation,
            now.works.damping - before.works.damping,
            now.works.friction - before.works.friction,
            now.stored - before.stored,
        ];
        assert_eq!(numbers.len(), 5);
        for (found, expected) in numbers.iter().zip(expected) {
            // Three digits after the point.
            assert!((found - expected).abs() <= 0.000_51, "{numbers:?}");
        }
        let left_over = expected[3] - expected[0] - expected[1] - expected[2];
        // The exact flow closes its balance to rounding, but the ledger of a period ago is interpolated linearly between samples: the
        // second difference of energies of size 1 over 0.04.
        assert!((numbers[4] - left_over).abs() < 0.04_f64.powi(2) && left_over.abs() < 0.04_f64.powi(2), "{numbers:?}");
    }
}

#[test]
fn the_slow_amplitudes_are_between_the_largest_elongations_of_a_period_ago() {
    let (case, trajectory) = torus();
    let stage = stage(&case, &trajectory);
    for index in [100, 333, 600] {
        let [a1, a2] = discs(&panel(&stage.frame(index), Panel::Amplitudes))[0];
        let time = stage.time(index);
        // The mark is drawn at a time a period (6.3) before the frame, between two turning points half a period apart.
        let swing = trajectory.samples.iter().filter(|sample| (time - 10.5..=time - 2.0).contains(&sample.time));
        let extremes = |mass: usize| {
            let tops = swing.clone().collect::<Vec<_>>();
            let tops: Vec<f64> = tops
                .windows(3)
                .map(|w| [0, 1, 2].map(|i: usize| w[i].state.positions[mass].abs()))
                .filter(|x| x[1] >= x[0] && x[1] >= x[2])
                .map(|x| x[1])
                .collect();
            (tops.iter().copied().fold(f64::MAX, f64::min), tops.iter().copied().fold(0.0, f64::max))
        };
        for (found, (low, high)) in [(a1, extremes(0)), (a2, extremes(1))] {
            // A sample misses its maximum by 0.02^2/2 of the amplitude.
            assert!(found > low - 1e-3 && found < high + 1e-3, "{found} is not between {low} and {high}");
        }
    }
}

/// A period after a turning point the panel shows the elongation there.
#[test]
fn the_slow_amplitudes_go_through_the_turning_points() {
    let (case, trajectory) = torus();
    let stage = stage(&case, &trajectory);
    for mass in [0, 1] {
        let turns = trajectory.samples.windows(2).filter_map(|pair| {
            let [v0, v1] = [0, 1].map(|i: usize| pair[i].state.velocities[mass]);
            let time = pair[0].time + (pair[1].time - pair[0].time) * v0 / (v0 - v1);
            (v0 * v1 < 0.0).then(|| (time, pair[0].state.positions[mass].abs()))
        });
        let mut seen = 0;
        for (time, elongation) in turns.filter(|(time, _)| (10.0..150.0).contains(time)) {
            let found = discs(&panel(&stage.frame_at(time + std::f64::consts::TAU), Panel::Amplitudes))[0][mass];
            // A sample is at most 0.04 from the turning point, where the elongation is 0.04^2/2 of an amplitude of 2 smaller; axes are read to 1e-4.
            assert!((found - elongation).abs() < 2e-3, "mass {} at {time}: {found}, {elongation}", mass + 1);
            seen += 1;
        }
        assert!(seen > 40, "{seen}");
    }
}

#[test]
fn the_map_marks_the_damping_of_the_scene() {
    let (case, trajectory) = torus();
    let marks = discs(&panel(&stage(&case, &trajectory).frame(300), Panel::Map));
    // Two dots of the diagram, then the mark.
    assert!((marks[0][0] - 0.2).abs() < 1e-4 && (marks[0][1] - 0.5).abs() < 1e-4 && (marks[1][1] - 1.5).abs() < 1e-4);
    assert!((marks[2][0] - 0.06).abs() < 1e-4 && (0.85..1.56).contains(&marks[2][1]), "{marks:?}");
}

#[test]
fn a_scene_chooses_its_panels() {
    let (mut case, trajectory) = torus();
    case.direction.panels = Some(vec![Panel::Energy, Panel::Phase]);
    let list = stage(&case, &trajectory).frame(10);
    assert_eq!(panels(&list).len(), 2);
    let text = "title = \"x\"\n[direction]\npanels = [\"phase\", \"phase\", \"phase\", \"phase\", \"phase\", \"phase\", \"phase\"]\n";
    let refused = Scene::parse(text, "x").unwrap_err().to_string();
    assert!(refused.contains("at most 6 panels") && refused.contains("line 3"), "{refused}");
}

#[test]
fn the_exact_solution_is_outlined_where_it_differs_and_not_where_it_does_not() {
    let (case, trajectory) = torus();
    let motion = Motion::new(&trajectory).unwrap();
    let mut late = trajectory.clone();
    for sample in &mut late.samples {
        sample.state.positions[0] += 3e-5;
    }
    // As much off at first, but for one part in 30 000 of it the same at the frame looked at, a time of 53.3.
    let mut joining = late.clone();
    for (joining, there) in joining.samples.iter_mut().zip(&trajectory.samples).filter(|(sample, _)| sample.time > 40.0)
    {
        joining.state.positions[0] = there.state.positions[0] + 1e-9;
    }
    // Words about the exact solution, and faces in the outline's colour: white in the dark theme, all but clear.
    let shown = |exact: &Trajectory| {
        let beside = Beside { exact: Motion::new(exact), ..Beside::default() };
        let list = Stage::new(case.clone(), motion.clone(), beside).frame(200);
        let is_face = |item: &&OverlayItem| matches!(item, OverlayItem::Polygon { fill, .. } if fill.0[..3] == [255; 3] && (1..40).contains(&fill.0[3]));
        let words = list.overlay.iter().find_map(|item| match item {
            OverlayItem::Text { text, .. } if text.contains("exact solution") => Some(text.clone()),
            _ => None,
        });
        (list.overlay.iter().filter(is_face).count(), words)
    };
    // Three sides of one carriage are towards the camera.
    let (faces, words) = shown(&late);
    let words = words.unwrap();
    assert!(faces == 3 && words.starts_with("outline") && words.contains("3.0·10⁻⁵ apart"), "{faces} faces, {words}");
    // Negative controls: no outline and no word of one where the difference is too small to be drawn, and nothing where there is none.
    let (faces, words) = shown(&joining);
    let words = words.unwrap();
    let bound = words.strip_prefix("exact solution: difference below ").and_then(number).unwrap();
    assert!(faces == 0 && bound > 1e-9 && bound < 3e-5, "{faces} faces, {words}");
    assert_eq!(shown(&trajectory), (0, None));
}

/// The factor written under the scene is that by which carriages are moved, in widths of their bodies.
#[test]
fn the_magnification_of_displacements_is_written() {
    let (case, trajectory) = torus();
    let motion = Motion::new(&trajectory).unwrap();
    for factor in [1.0, 0.5] {
        let mut case = case.clone();
        case.direction.magnification = factor;
        let stage = stage(&case, &trajectory);
        let carriage = |list: &DrawList| {
            let paint = stickslip::render::Colour::rgb(0x56b4e9);
            list.objects.iter().find(|object| object.material.colour == paint).unwrap().clone()
        };
        let (first, second) = (stage.frame(100), stage.frame(110));
        let x = [100, 110].map(|index| motion.at(stage.time(index)).positions[0] as f32);
        let bodies = [carriage(&first), carriage(&second)];
        let moved = (bodies[1].transform.translation.x - bodies[0].transform.translation.x) / (x[1] - x[0]);
        let corners = bodies[0].mesh.positions.iter().map(|corner| bodies[0].transform.transform_point3(*corner).x);
        let width = corners.clone().fold(f32::MIN, f32::max) - corners.fold(f32::MAX, f32::min);
        let written = first.overlay.iter().find_map(|item| match item {
            OverlayItem::Text { text, .. } => {
                text.strip_prefix("displacement 1 drawn as ")?.strip_suffix(" carriage widths").and_then(number)
            }
            _ => None,
        });
        // Two digits after the point.
        assert!((written.unwrap() - f64::from(moved / width)).abs() < 0.0051, "{written:?}, {}", moved / width);
    }
}

/// Every number and name that is drawn lies inside the picture, those of a panel inside their panel, and none over another, whatever the
/// picture's shape.
#[test]
fn no_word_is_cut_off_or_written_over_another() {
    let (case, trajectory) = torus();
    for [wide, high] in [[1280, 720], [1080, 1920], [1080, 1080], [1024, 768]] {
        let mut case = case.clone();
        (case.film.width, case.film.height) = (wide, high);
        let stage = stage(&case, &trajectory);
        // A picture counts as 1280 pixels wide, an upright one as 760, a square one as 1130 high.
        let corner = 8.0
            * (wide as f32 / if high >= wide { 760.0 } else { 1280.0 })
                .min(high as f32 / if high >= wide { 1130.0 } else { 720.0 });
        for index in (0..=600).step_by(60) {
            let [mut min, mut max] = [Vec2::ZERO, Vec2::new(wide as f32, high as f32)];
            let mut panels = 0;
            let mut words: Vec<(Vec2, Vec2, &str)> = vec![];
            let frame = stage.frame(index);
            for item in &frame.overlay {
                if let OverlayItem::Box { area, corner_radius, .. } = item
                    && (corner_radius - corner).abs() < 1e-3
                {
                    (min, max, panels) = (area.min, area.max, panels + 1);
                }
                let OverlayItem::Text { position, anchor, size, bold, text, .. } = item else { continue };
                let width = stickslip::render::text_width(text, *size, *bold);
                let left = match anchor {
                    Anchor::Left => position.x,
                    Anchor::Centre => position.x - width / 2.0,
                    Anchor::Right => position.x - width,
                };
                let inside =
                    left >= min.x && left + width <= max.x && position.y - size >= min.y && position.y <= max.y;
                assert!(inside, "{wide}x{high}, frame {index}: {text:?} at {left}..{}, {}", left + width, position.y);
                // Letters reach some 0.75 of their size above the line.
                words.push((Vec2::new(left, position.y - 0.75 * size), Vec2::new(left + width, position.y), text));
            }
            assert_eq!(panels, 6);
            for (i, (min, max, word)) in words.iter().enumerate() {
                let over = words[..i].iter().find(|other| min.cmplt(other.1).all() && other.0.cmplt(*max).all());
                assert_eq!(over, None, "{wide}x{high}, frame {index}: {word:?} is written over it");
            }
        }
    }
}

/// What is put in, taken out and stored adds up to the residual in every row of the ledger, also where the motion is prescribed: the drive
/// has a row of its own there.
#[test]
fn the_rows_of_the_ledger_add_up() {
    // The rig of the scene has neither self-excitation nor damping; with xi1 alone it has both, the coupling damper being (xi2 - xi1)/2.
    for (xi1, rows) in [(0.0, 4), (0.05, 6)] {
        let (_, text) = stickslip::scene::BUILT_IN.iter().find(|(name, _)| *name == "hysteresis").unwrap();
        let (_, mut case) = Scene::parse(text, "hysteresis").unwrap();
        case.parameters.xi1 = xi1;
        let rig = TwoMassRig::new(case.parameters).unwrap();
        let motion = case.prescribed.unwrap();
        let flow = stickslip::exact::PrescribedFlow::new(rig.chain(), motion).unwrap();
        let start = State::two_mass([0.0, 0.0, motion.velocity(0.0), 0.0, 0.0]);
        let trajectory = flow.trajectory(&start, Sampling { interval: INTERVAL, t_end: case.duration }).unwrap();
        let stage = Stage::new(case.clone(), Motion::new(&trajectory).unwrap(), Beside::default());
        let list = stage.frame(stage.frame_count() - 1);
        let place = case.panels().iter().position(|panel| *panel == Panel::Energy).unwrap();
        let numbers: Vec<f64> = panels(&list)[place]
            .iter()
            .filter_map(|item| match item {
                OverlayItem::Text { anchor: Anchor::Right, text, .. } => number(text),
                _ => None,
            })
            .collect();
        assert_eq!(numbers.len(), rows, "{numbers:?}");
        let [works @ .., stored, residual] = &numbers[..] else { panic!("{numbers:?}") };
        // Five roundings to three digits at most.
        assert!((stored - works.iter().sum::<f64>() - residual).abs() < 0.0026, "{numbers:?}");
        // The area of the loop times gamma: 4 (a - 1) gamma = 2 for a = 2, gamma = 0.5.
        assert!((works.last().unwrap() + 2.0).abs() < 0.002, "{numbers:?}");
    }
}

#[test]
fn slow_motion_shows_its_stretch_slower_and_makes_the_film_longer() {
    let (mut case, trajectory) = torus();
    let plain = stage(&case, &trajectory);
    case.direction.slow_motion = vec![stickslip::scene::SlowMotion { from: 2.0, to: 4.0, factor: 0.25 }];
    let slowed = stage(&case, &trajectory);
    // 30 frames and 8 time units a second.
    assert_eq!(slowed.time(60), plain.time(60));
    assert!((slowed.time(120) - slowed.time(60) - 0.25 * 16.0).abs() < 1e-12);
    assert!((slowed.time(150) - slowed.time(120) - 8.0).abs() < 1e-12);
    // Two seconds took the place of half a second: 1.5 s longer.
    assert_eq!(slowed.frame_count(), plain.frame_count() + 45);
}

#[test]
fn captions_and_camera_follow_the_direction() {
    let (mut case, trajectory) = torus();
    let caption = stickslip::scene::Caption { from: 1.0, to: 3.0, text: "look here".to_owned() };
    case.direction.captions = vec![caption];
    let view = |azimuth| stickslip::scene::View { azimuth, ..stickslip::scene::View::default() };
    case.direction.camera = stickslip::scene::CameraMove::Dolly {
        from: view(-20.0),
        to: view(20.0),
        easing: stickslip::scene::Easing::Linear,
    };
    let stage = stage(&case, &trajectory);
    let says = |index, words: &str| {
        let list = stage.frame(index);
        list.overlay.iter().any(|item| matches!(item, OverlayItem::Text { text, .. } if text.contains(words)))
    };
    assert!(
        says(45, "look here") && !says(10, "look here") && says(10, "trade amplitude") && !says(45, "trade amplitude")
    );
    let eye = |index| stage.frame(index).camera.eye - stage.frame(index).camera.target;
    let (first, middle, last) = (eye(0), eye(300), eye(600));
    // From the left, from the front, from the right; mirror images of each other.
    assert!(first.x < -1.0 && middle.x.abs() < 1e-4 && (last.x + first.x).abs() < 1e-4);
}
