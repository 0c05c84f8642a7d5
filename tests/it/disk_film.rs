//! What the frames of a disk's film say, read off their display lists: bars, carpet, contacts and ledger are those of the motion, and the crest
//! of a forward wave runs to higher blade numbers.

use glam::{Vec2, Vec3};
use std::f64::consts::{PI, TAU};
use stickslip::dynamics::{Flow, Outcome, Sample, Sampling, State, Trajectory};
use stickslip::exact::SparseFlow;
use stickslip::model::{ContactState, Direction, EnergyLedger};
use stickslip::render::{Anchor, Colour, DrawList, OverlayItem};
use stickslip::scene::{BUILT_IN_DISKS, Case, Panel, Scene, Theme};
use stickslip::stage::{DeflectionColours, DiskMotion, DiskStage};

const BLADES: usize = 12;
const INTERVAL: f64 = 0.05;

/// A ring of 12 blades with a contact at every foot.
fn case() -> Case {
    let text = "title = \"x\"\n[disk]\nsectors = 12\ncoupling = 0.1\n[[disk.friction]]\nplace = \"foot\"\nstiffness = 0.5\n\
                [simulation]\nduration = 60.0\n";
    Scene::parse(text, "test").unwrap().1
}

/// Sticking frequency of a wave of the ring, in closed form.
fn frequency(n: i64) -> f64 {
    (1.0 + 4.0 * 0.1 * (PI * n as f64 / BLADES as f64).sin().powi(2)).sqrt()
}

/// Deflections of a sum of waves `(n, amplitude)` by definition: x_j = Re q exp i(w t - j sigma).
fn deflection(waves: &[(i64, f64)], blade: usize, time: f64) -> f64 {
    let phase = |n: i64| frequency(n) * time - TAU * n as f64 * blade as f64 / BLADES as f64;
    waves.iter().map(|&(n, amplitude)| amplitude * phase(n).cos()).sum()
}

fn velocity(waves: &[(i64, f64)], blade: usize, time: f64) -> f64 {
    let phase = |n: i64| frequency(n) * time - TAU * n as f64 * blade as f64 / BLADES as f64;
    waves.iter().map(|&(n, amplitude)| -frequency(n) * amplitude * phase(n).sin()).sum()
}

/// Whether the contact of a blade slips in the made-up motion: every third one, in turn.
fn slips(blade: usize, time: f64) -> bool {
    blade % 3 == (time / 10.0) as usize % 3
}

fn trajectory(waves: &[(i64, f64)]) -> Trajectory {
    let contact = |blade, time| {
        if slips(blade, time) { ContactState::Slip(Direction::Positive) } else { ContactState::Stick }
    };
    let sample = |n: u32| {
        let time = f64::from(n) * INTERVAL;
        let state = State {
            positions: (0..BLADES).map(|j| deflection(waves, j, time)).collect(),
            velocities: (0..BLADES).map(|j| velocity(waves, j, time)).collect(),
            slider_forces: (0..BLADES).map(|j| 0.1 * j as f64 - 0.4).collect(),
        };
        let contacts = (0..BLADES).map(|j| contact(j, time)).collect();
        Sample { time, state, contacts, ledger: EnergyLedger::default() }
    };
    Trajectory { samples: (0..=1200).map(sample).collect(), events: vec![], outcome: Outcome::Completed }
}

fn stage_of(case: Case, trajectory: &Trajectory) -> DiskStage {
    let motion = DiskMotion::new(&case.disk.as_ref().unwrap().disk, trajectory).unwrap().unwrap();
    DiskStage::new(case, motion, None).unwrap()
}

fn stage(waves: &[(i64, f64)]) -> DiskStage {
    stage_of(case(), &trajectory(waves))
}

/// The items of one panel: a panel begins with its box, which has rounded corners of 8 pixels.
fn panel(list: &DrawList, kind: Panel) -> Vec<OverlayItem> {
    let is_frame = |item: &OverlayItem| matches!(item, OverlayItem::Box { corner_radius, .. } if *corner_radius == 8.0);
    let starts: Vec<usize> = (0..list.overlay.len()).filter(|&i| is_frame(&list.overlay[i])).collect();
    let index = Panel::DISK.iter().position(|panel| *panel == kind).unwrap();
    let end = starts.get(index + 1).copied().unwrap_or(list.overlay.len());
    list.overlay[starts[index] + 1..end].to_vec()
}

/// Pixel and value of the tick labels of an axis, first and last.
fn ticks(panel: &[OverlayItem], wanted: Anchor) -> [(Vec2, f64); 2] {
    let tick = |item: &OverlayItem| match item {
        OverlayItem::Text { position, anchor, text, size, .. } if *anchor == wanted && *size == 11.0 => {
            Some((*position, text.replace('\u{2212}', "-").parse().ok()?))
        }
        _ => None,
    };
    let all: Vec<(Vec2, f64)> = panel.iter().filter_map(tick).collect();
    [all[0], all[all.len() - 1]]
}

fn x_value(panel: &[OverlayItem], pixel: f32) -> f64 {
    let [(a, from), (b, to)] = ticks(panel, Anchor::Centre);
    from + (to - from) * f64::from((pixel - a.x) / (b.x - a.x))
}

/// Labels stand 3.5 pixels below the value they name.
fn y_value(panel: &[OverlayItem], pixel: f32) -> f64 {
    let [(a, from), (b, to)] = ticks(panel, Anchor::Right);
    from + (to - from) * f64::from((pixel + 3.5 - a.y) / (b.y - a.y))
}

/// Nodal diameter and amplitude of every bar.
fn bars(list: &DrawList) -> Vec<(i64, f64)> {
    let panel = panel(list, Panel::Spectrum);
    let bar = |item: &OverlayItem| match item {
        OverlayItem::Box { area, .. } => {
            let middle = x_value(&panel, 0.5 * (area.min.x + area.max.x));
            Some((middle.round() as i64, y_value(&panel, area.min.y)))
        }
        _ => None,
    };
    panel.iter().filter_map(bar).collect()
}

#[test]
fn bars_are_the_amplitudes_of_the_waves_forward_and_backward_apart() {
    let stage = stage(&[(3, 0.8), (-2, 0.3)]);
    for index in [0, 37, 150] {
        let found = bars(&stage.frame(index));
        assert_eq!(found.len(), BLADES);
        for (n, amplitude) in found {
            let expected = [(3, 0.8), (-2, 0.3)].iter().find(|(wave, _)| *wave == n).map_or(0.0, |wave| wave.1);
            // Velocities are interpolated linearly: up to w^2 h^2/8 = 4e-4 of the amplitude, and pixels of 1e-4 of some 150.
            assert!((amplitude - expected).abs() < 6e-4, "frame {index}, n = {n}: {amplitude} for {expected}");
        }
    }
}

/// Phase of the deflections round the ring as drawn: with heights A cos(w t - n theta), theta counter-clockwise seen from above, the sum of
/// `height exp(i n theta)` has the phase w t.
fn drawn_phase(list: &DrawList, n: i64) -> f64 {
    let radius = |place: Vec3| place.x.hypot(place.z);
    // Marks at the tips are the outermost small objects.
    let tips: Vec<Vec3> = list
        .objects
        .iter()
        .map(|object| Vec3::from(object.transform.translation))
        .filter(|place| radius(*place) > 1.9)
        .collect();
    assert_eq!(tips.len(), BLADES);
    let mean: f32 = tips.iter().map(|tip| tip.y).sum::<f32>() / BLADES as f32;
    let angle = |tip: &Vec3| n as f64 * f64::from((-tip.z).atan2(tip.x));
    let sum = |of: fn(f64) -> f64| tips.iter().map(|tip| f64::from(tip.y - mean) * of(angle(tip))).sum::<f64>();
    sum(f64::sin).atan2(sum(f64::cos))
}

#[test]
fn the_crest_of_a_forward_wave_runs_counter_clockwise_and_to_higher_blade_numbers() {
    for n in [3, -3] {
        let stage = stage(&[(n, 1.0)]);
        for index in [10, 11, 12, 100, 101] {
            let step = frequency(n) * (stage.time(index + 1) - stage.time(index));
            let turned =
                (drawn_phase(&stage.frame(index + 1), n) - drawn_phase(&stage.frame(index), n)).rem_euclid(TAU);
            // Tips move inwards when deflected, which tilts heights against angles by nothing: rounding of f32 alone.
            assert!((turned - step).abs() < 1e-3, "n = {n}: {turned} for {step}");
            // Negative control: the opposite wave would turn the other way.
            let other =
                (drawn_phase(&stage.frame(index + 1), -n) - drawn_phase(&stage.frame(index), -n)).rem_euclid(TAU);
            assert!((other - step).abs() > 0.1, "n = {n}: {other}");
        }
    }
    // Numbers of the blades follow each other counter-clockwise in the picture, which looks from above; y is down there.
    let list = stage(&[(3, 0.0001)]).frame(0);
    let number = |blade: usize| {
        let place = list.overlay.iter().find_map(|item| match item {
            OverlayItem::Text { position, text, size, .. } if *text == blade.to_string() && *size == 12.0 => {
                Some(*position)
            }
            _ => None,
        });
        place.unwrap_or_else(|| panic!("blade {blade} has no number"))
    };
    let numbers: Vec<Vec2> = (0..BLADES).map(number).collect();
    let area: f32 = (0..BLADES).map(|j| numbers[j].perp_dot(numbers[(j + 1) % BLADES])).sum();
    assert!(area < -1e4, "{area}");
}

#[test]
fn cells_of_the_carpet_have_the_colour_of_their_blade_and_time() {
    let waves = [(3, 0.8), (-2, 0.3)];
    let stage = stage(&waves);
    let largest =
        trajectory(&waves).samples.iter().flat_map(|s| s.state.positions.clone()).fold(0.0, |a: f64, x| a.max(x.abs()));
    let colours = DeflectionColours::new(Theme::Dark, largest);
    for index in [60, 200] {
        let now = stage.time(index);
        let panel = panel(&stage.frame(index), Panel::Carpet);
        let raster = panel.iter().find_map(|item| match item {
            OverlayItem::Raster { area, columns, cells } if *columns > 1 => Some((*area, *columns, cells.clone())),
            _ => None,
        });
        let (area, columns, cells) = raster.unwrap();
        assert_eq!(cells.len(), BLADES * columns);
        // The axis counts from now backwards.
        let times = [area.min.x, area.max.x].map(|pixel| now + x_value(&panel, pixel));
        let width = (times[1] - times[0]) / columns as f64;
        // The last column ends now, to the rounding of pixels.
        assert!((times[1] - now).abs() < 1e-3, "{times:?} at {now}");
        for (cell, colour) in cells.iter().enumerate() {
            let (row, column) = (cell / columns, cell % columns);
            // Blade 0 is the lowest row.
            let blade = BLADES - 1 - row;
            let time = times[0] + (column as f64 + 0.5) * width;
            let expected = colours.of(deflection(&waves, blade, time));
            let apart = colour.0.iter().zip(expected.0).map(|(a, b)| a.abs_diff(b)).max().unwrap();
            // Times are read off pixels, to 1e-4 of a pixel of some 0.15: a level of 150 at most.
            assert!(apart <= 1, "blade {blade}, t = {time}: {colour:?} for {expected:?}");
        }
        // Negative control: the neighbour's row is another.
        let rows: Vec<&[Colour]> = cells.chunks(columns).collect();
        assert_ne!(rows[0], rows[1]);
    }
}

/// The colour of a word of the key to the contacts.
fn key(list: &DrawList, word: &str) -> Colour {
    let found = list.overlay.iter().find_map(|item| match item {
        OverlayItem::Text { text, colour, size, .. } if text == word && *size == 12.0 => Some(*colour),
        _ => None,
    });
    found.unwrap_or_else(|| panic!("the key has no {word}"))
}

#[test]
fn every_contact_has_the_colour_of_its_state() {
    let stage = stage(&[(3, 0.8)]);
    for index in [5, 60, 100] {
        let (list, time) = (stage.frame(index), stage.time(index));
        let [stick, slip] = ["stick", "slip"].map(|word| key(&list, word));
        let mut seen = 0;
        for object in list.objects.iter().filter(|o| [stick, slip].contains(&o.material.colour)) {
            let place = object.transform.translation;
            let angle = f64::from((-place.z).atan2(place.x)).rem_euclid(TAU);
            let blade = (angle / TAU * BLADES as f64).round() as usize % BLADES;
            let expected = if slips(blade, time) { slip } else { stick };
            assert_eq!(object.material.colour, expected, "blade {blade} at {time}");
            seen += 1;
        }
        assert_eq!(seen, BLADES);
    }
}

#[test]
fn blades_have_the_colour_of_their_deflection() {
    let waves = [(3, 0.8), (-2, 0.3)];
    let stage = stage(&waves);
    let largest =
        trajectory(&waves).samples.iter().flat_map(|s| s.state.positions.clone()).fold(0.0, |a: f64, x| a.max(x.abs()));
    let colours = DeflectionColours::new(Theme::Dark, largest);
    let (list, time) = (stage.frame(33), stage.time(33));
    for object in list.objects.iter().filter(|o| o.transform.translation.x.hypot(o.transform.translation.z) > 1.9) {
        let place = object.transform.translation;
        let angle = f64::from((-place.z).atan2(place.x)).rem_euclid(TAU);
        let blade = (angle / TAU * BLADES as f64).round() as usize % BLADES;
        assert_eq!(object.material.colour, colours.of(stage.instant(33).positions[blade]));
        // The fourth-order interpolation between samples, far below a level.
        assert!((stage.instant(33).positions[blade] - deflection(&waves, blade, time)).abs() < 1e-6);
    }
}

/// The exact motion of the built-in forward wave, its start.
fn forward_wave() -> (Case, Trajectory) {
    forward_wave_of(1.1)
}

fn forward_wave_of(amplitude: f64) -> (Case, Trajectory) {
    let (name, text) = BUILT_IN_DISKS[0];
    let (mut scene, _) = Scene::parse(text, name).unwrap();
    scene.simulation.duration = 40.0;
    let case = scene.checked(name).unwrap();
    let disk = case.disk.as_ref().unwrap();
    let chain = disk.disk.chain().unwrap();
    let mut start = State::rest(&chain);
    for j in 0..BLADES {
        let angle = TAU * 3.0 * j as f64 / BLADES as f64;
        (start.positions[j], start.velocities[j]) = (amplitude * angle.cos(), amplitude * angle.sin());
    }
    let trajectory = SparseFlow::new(&chain).trajectory(&start, Sampling { interval: INTERVAL, t_end: 40.0 }).unwrap();
    (case, trajectory)
}

#[test]
fn the_ledger_counts_the_work_of_the_air_through_the_antisymmetric_stiffness() {
    let (case, trajectory) = forward_wave();
    let stage = stage_of(case, &trajectory);
    let w = {
        let sum = |of: fn(&State) -> &Vec<f64>| -> f64 {
            trajectory.samples.iter().flat_map(|s| of(&s.state)).map(|x| x * x).sum()
        };
        (sum(|s| &s.velocities) / sum(|s| &s.positions)).sqrt()
    };
    let index = 120;
    let time = stage.time(index);
    let ledger = |time: f64| {
        let k = (time / INTERVAL).round() as usize;
        trajectory.samples[k].ledger
    };
    // To the nearest sample: half an interval of powers below 2.
    let (now, before) = (ledger(time), ledger(time - TAU / w));
    let expected = [
        now.works.self_excitation - before.works.self_excitation,
        now.works.circulatory - before.works.circulatory,
        0.0,
        now.works.friction - before.works.friction,
        now.stored - before.stored,
    ];
    let numbers: Vec<f64> = panel(&stage.frame(index), Panel::Energy)
        .iter()
        .filter_map(|item| match item {
            OverlayItem::Text { anchor: Anchor::Right, text, .. } => text.replace('\u{2212}', "-").parse().ok(),
            _ => None,
        })
        .collect();
    assert!(numbers.len() >= 5, "{numbers:?}");
    for (found, expected) in numbers.iter().zip(expected) {
        assert!((found - expected).abs() < 0.05, "{numbers:?} for {expected}");
    }
    assert!(expected[1] > 0.5, "the antisymmetric stiffness should feed the wave: {expected:?}");
}

#[test]
fn the_contact_panel_marks_elongation_and_force_of_the_moment() {
    let (case, trajectory) = forward_wave();
    let stage = stage_of(case, &trajectory);
    for index in [3, 77, 149] {
        let panel = panel(&stage.frame(index), Panel::Hysteresis);
        let mark = panel.iter().find_map(|item| match item {
            OverlayItem::Disc { centre, .. } => Some([x_value(&panel, centre.x), y_value(&panel, centre.y)]),
            _ => None,
        });
        let now = stage.instant(index);
        let [x, f] = mark.unwrap();
        // The title names the blade; the element at its foot has the elongation x_j. Pixels are f32.
        let blade: usize = panel
            .iter()
            .find_map(|item| match item {
                OverlayItem::Text { text, .. } => text.strip_prefix("Contact at the foot of blade ")?.parse().ok(),
                _ => None,
            })
            .unwrap();
        let off = [now.positions[blade] - x, now.slider_forces[blade] - f];
        assert!(off.iter().all(|off| off.abs() < 1e-3), "{off:?}");
        // Negative control: the next blade is elsewhere.
        assert!((now.positions[(blade + 1) % BLADES] - x).abs() > 1e-2);
    }
}

/// The numbers at the scale of colours end well inside their panel, not at its edge.
#[test]
fn numbers_at_the_scale_of_colours_keep_a_border() {
    let list = stage(&[(2, 1.234)]).frame(70);
    let is_frame = |item: &OverlayItem| matches!(item, OverlayItem::Box { corner_radius, .. } if *corner_radius == 8.0);
    let index = Panel::DISK.iter().position(|panel| *panel == Panel::Carpet).unwrap();
    let Some(OverlayItem::Box { area, .. }) = list.overlay.iter().filter(|item| is_frame(item)).nth(index) else {
        panic!("no carpet")
    };
    let ends = panel(&list, Panel::Carpet).into_iter().filter_map(|item| match item {
        OverlayItem::Text { position, anchor: Anchor::Left, text, size: 10.0, .. } => {
            Some(position.x + stickslip::render::text_width(&text, 10.0, false))
        }
        _ => None,
    });
    let ends: Vec<f32> = ends.collect();
    assert_eq!(ends.len(), 3);
    // As much as a letter is wide.
    assert!(ends.iter().all(|end| area.max.x - end > 6.0), "{ends:?} of {}", area.max.x);
}

/// Numbers of the words "one period: 7 of 12 slip".
fn slipping(list: &DrawList) -> usize {
    let found = list.overlay.iter().find_map(|item| match item {
        OverlayItem::Text { text, .. } => {
            text.strip_prefix("one period: ")?.strip_suffix(&format!(" of {BLADES} slip"))?.parse().ok()
        }
        _ => None,
    });
    found.expect("the contacts that slip are counted")
}

#[test]
fn the_status_counts_the_contacts_that_slipped_in_the_last_period() {
    let (case, trajectory) = forward_wave();
    let stage = stage_of(case, &trajectory);
    let mut found = Vec::new();
    for index in [0, 2, 4, 6, 8, 60, 61, 149] {
        let time = stage.time(index);
        // Contact states of the exact flow, which knows its events; samples are 0.05 apart and slip lasts for 0.6.
        let window = trajectory.samples.iter().filter(|s| s.time <= time && s.time >= time - stage.period());
        let states: Vec<&Vec<ContactState>> = window.map(|sample| &sample.contacts).collect();
        let expected = (0..BLADES).filter(|j| states.iter().any(|contacts| !contacts[*j].is_stick())).count();
        assert_eq!(slipping(&stage.frame(index)), expected, "at {time}");
        found.push(expected);
    }
    // It grows as one contact after the other begins to slip.
    assert!(found[0] == 0 && found.iter().any(|n| (1..BLADES).contains(n)), "{found:?}");
    // Negative control: a wave that never reaches the slip limit.
    let (case, trajectory) = forward_wave_of(0.5);
    assert_eq!(slipping(&stage_of(case, &trajectory).frame(60)), 0);
}

#[test]
fn ticks_of_panels_that_run_with_time_stand_still() {
    let stage = stage(&[(3, 0.8)]);
    for kind in [Panel::Carpet, Panel::Series] {
        let labels = |index| {
            let items = panel(&stage.frame(index), kind).into_iter();
            let label = |item| match item {
                OverlayItem::Text { position, text, size: 11.0, .. } => Some((position.to_array(), text)),
                _ => None,
            };
            items.filter_map(label).collect::<Vec<_>>()
        };
        let first = labels(0);
        assert!(first.len() > 6 && first.iter().any(|(_, text)| text == "now"), "{first:?}");
        assert!((1..220).step_by(7).all(|index| labels(index) == first), "{kind:?}");
    }
}

/// Bars are as long as their numbers say on the scale that the marks tell, and the longest can be seen at every time.
#[test]
fn the_bars_of_the_ledger_are_on_the_scale_of_its_marks() {
    let (case, trajectory) = forward_wave();
    let stage = stage_of(case, &trajectory);
    let number = |text: &str| text.replace('\u{2212}', "-").parse::<f64>().ok();
    for index in [30, 90, 149] {
        let items = panel(&stage.frame(index), Panel::Energy);
        let texts = |wanted: Anchor| {
            let text = move |item: &OverlayItem| match item {
                OverlayItem::Text { text, anchor, position, .. } if *anchor == wanted => {
                    Some((number(text)?, position.x))
                }
                _ => None,
            };
            items.iter().filter_map(text).collect::<Vec<_>>()
        };
        let marks = texts(Anchor::Centre);
        let [(low, left), (high, right)] = marks[..] else { panic!("{marks:?}") };
        assert!(low == -high && high > 0.0, "{marks:?}");
        let pixels = (right - left) / (2.0 * high as f32);
        let bars: Vec<f32> = items
            .iter()
            .filter_map(|item| match item {
                OverlayItem::Box { area, corner_radius: 0.0, .. } => Some(area.max.x - area.min.x),
                _ => None,
            })
            .collect();
        let numbers = texts(Anchor::Right);
        assert!(bars.len() == 6 && numbers.len() >= 5, "{bars:?} {numbers:?}");
        for (bar, (value, _)) in bars.iter().zip(&numbers) {
            // Numbers have three digits after the point.
            let rounding = 0.0006 * pixels;
            assert!((bar - pixels * value.abs() as f32).abs() < rounding + 0.01, "frame {index}: {bar} for {value}");
        }
        // A past bar counts 1/e after 100 time units, longer than this film: at least 1/e of the 41 pixels there are.
        assert!(bars.iter().copied().fold(0.0, f32::max) > 14.0, "{bars:?}");
    }
}

/// Colours of the lines of the loop and the colours of stick and slip.
#[test]
fn the_loop_of_a_contact_is_drawn_in_the_colours_of_its_states() {
    let (case, trajectory) = forward_wave();
    let stage = stage_of(case, &trajectory);
    let list = stage.frame(149);
    let [stick, slip] = ["stick", "slip"].map(|word| key(&list, word));
    let panel = panel(&list, Panel::Hysteresis);
    let lines = panel.iter().filter_map(|item| match item {
        // Wider than the lines of the slip limits.
        OverlayItem::Line { points, stroke, .. } if stroke.width > 1.1 => Some((points, stroke.colour)),
        _ => None,
    });
    let mut seen = [0, 0];
    for (points, colour) in lines {
        let solid = Colour([colour.0[0], colour.0[1], colour.0[2], 255]);
        let forces: Vec<f64> = points.iter().map(|point| y_value(&panel, point.y)).collect();
        let is_slip = solid == slip;
        assert!(is_slip || solid == stick, "{solid:?}");
        seen[usize::from(is_slip)] += 1;
        if is_slip {
            // At the slip force, up to pixels.
            assert!(forces.iter().all(|force| (force.abs() - 1.0).abs() < 1e-3), "{forces:?}");
        } else {
            // While a contact sticks the force follows the elongation, 1 for 1, corners included.
            let slopes = points.windows(2).map(|pair| {
                (y_value(&panel, pair[1].y) - y_value(&panel, pair[0].y))
                    - (x_value(&panel, pair[1].x) - x_value(&panel, pair[0].x))
            });
            assert!(slopes.into_iter().all(|off| off.abs() < 2e-3), "{forces:?}");
        }
    }
    assert!(seen[0] > 2 && seen[1] > 2, "{seen:?}");
}
