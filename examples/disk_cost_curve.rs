//! Cost of the exact flow per period against the number of blades, as one measured curve: `disk_cost_curve FOLDER` writes `disk_cost.svg` and
//! `disk_cost.csv` there and prints the table.
//!
//! Measured: one period of the travelling-wave limit cycle of a ring fed by the air, a contact at every foot, all of which slip. The wave is the one
//! nearest to a quarter of the ring whose number shares no factor with N, so that no two blades switch at once. Two blades are an open
//! chain. Times are CPU time of this process (of Linux; elsewhere wall time), the least of several repetitions.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::PathBuf;
use std::time::Instant;
use stickslip::disk::TravellingWave;
use stickslip::dynamics::State;
use stickslip::exact::SparseFlow;
use stickslip::model::{
    Aerodynamics, BladedDisk, ContactPlace, FrictionContacts, InfluenceCoefficient, NodalDiameter, Topology,
};
use stickslip::report::{Figure, Panel, Series, Style, Tint};

const BLADES: [usize; 10] = [2, 4, 8, 16, 32, 64, 125, 250, 500, 1000];
const REPETITIONS: usize = 5;
/// Repeated until this much CPU time is used, so that one measurement is long against the ticks of the clock, some milliseconds.
const LEAST_SECONDS: f64 = 0.2;

type Failure = Box<dyn std::error::Error>;

struct Row {
    blades: usize,
    events: usize,
    seconds: f64,
}

fn disk(sectors: usize) -> BladedDisk {
    let l = |offset, real, imaginary| InfluenceCoefficient { offset, real, imaginary };
    let chain = sectors < 3;
    let coefficients =
        if chain { vec![l(0, 0.0, -0.03)] } else { vec![l(0, 0.0, 0.01), l(1, 0.03, 0.0), l(-1, -0.03, 0.0)] };
    BladedDisk {
        topology: if chain { Topology::Chain } else { Topology::Ring },
        friction: vec![FrictionContacts::everywhere(ContactPlace::Foot, 0.5)],
        aerodynamics: Some(Aerodynamics::Coefficients { coefficients, reference_frequency: 1.0 }),
        ..BladedDisk::ring(sectors, 0.1)
    }
}

/// A state in which every contact slips twice a period, and the period.
fn start(disk: &BladedDisk, flow: &SparseFlow) -> Result<(State, f64), Failure> {
    let n = disk.sectors;
    if n < 3 {
        let first = State { positions: vec![1.5, 0.7], ..State::rest(flow.chain()) };
        return Ok((flow.advance(&first, 100.0 * TAU)?.state, TAU));
    }
    let alone = |k: &usize| (2..=*k).all(|d| k % d != 0 || n % d != 0);
    let quarter = n / 4;
    let number = (0..quarter).flat_map(|k| [quarter - k, quarter + k]).find(alone).unwrap_or(1);
    let wave = TravellingWave::of(disk, NodalDiameter::new(number as i64, n), 32)?;
    // A few periods on, past the harmonics left out.
    Ok((flow.advance(&wave.state(), 5.0 * wave.period())?.state, wave.period()))
}

/// CPU time of this process's main thread in seconds, from the kernel where it tells.
fn cpu_seconds(clock: Instant) -> f64 {
    let told = std::fs::read_to_string("/proc/self/schedstat").ok();
    let nanoseconds = told.and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| clock.elapsed().as_secs_f64(), |ns| 1e-9 * ns)
}

fn measure(blades: usize) -> Result<Row, Failure> {
    let disk = disk(blades);
    let flow = SparseFlow::new(&disk.chain()?);
    let (start, period) = start(&disk, &flow)?;
    let clock = Instant::now();
    let (mut best, mut events) = (f64::INFINITY, 0);
    for _ in 0..REPETITIONS {
        let (from, mut periods) = (cpu_seconds(clock), 0);
        loop {
            events = flow.advance(&start, period)?.switches;
            periods += 1;
            let used = cpu_seconds(clock) - from;
            if used > LEAST_SECONDS {
                best = best.min(used / f64::from(periods));
                break;
            }
        }
    }
    Ok(Row { blades, events, seconds: best })
}

/// Slope of `log y` over `log N` by least squares.
fn slope(rows: &[&Row], of: impl Fn(&Row) -> f64) -> f64 {
    let points: Vec<(f64, f64)> = rows.iter().map(|row| ((row.blades as f64).ln(), of(row).ln())).collect();
    let count = points.len() as f64;
    let (mx, my) = (points.iter().map(|p| p.0).sum::<f64>() / count, points.iter().map(|p| p.1).sum::<f64>() / count);
    let (top, bottom) =
        points.iter().fold((0.0, 0.0), |(t, b), (x, y)| (t + (x - mx) * (y - my), b + (x - mx).powi(2)));
    top / bottom
}

fn per_event(row: &Row) -> f64 {
    1e6 * row.seconds / row.events as f64
}

fn slopes(rows: &[Row], least: usize) -> String {
    let chosen: Vec<&Row> = rows.iter().filter(|row| row.blades >= least).collect();
    format!(
        "slopes from N = {least}: time per period {:.2} = events {:.2} + time per event {:.2}",
        slope(&chosen, |row| row.seconds),
        slope(&chosen, |row| row.events as f64),
        slope(&chosen, per_event)
    )
}

fn figure(rows: &[Row]) -> Figure {
    let series = |label: &str, of: &dyn Fn(&Row) -> f64, tint| {
        Series::new(label, rows.iter().map(|row| (row.blades as f64, of(row))).collect(), Style::Line, tint)
    };
    let panel = Panel::new("blades N", "per period; microseconds")
        .log_x()
        .log_y()
        .series(series("CPU time per period, us", &|row| 1e6 * row.seconds, Tint::Blue))
        .series(series("events per period", &|row| row.events as f64, Tint::Green))
        .series(series("CPU time per event, us", &per_event, Tint::Vermillion));
    Figure::single(panel).titled("Exact flow of a ring: cost of a period in which every contact slips").sized(820, 560)
}

fn main() -> Result<(), Failure> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| ".".to_owned()));
    let rows = BLADES.into_iter().map(measure).collect::<Result<Vec<Row>, Failure>>()?;
    let mut table = "blades,events_per_period,microseconds_per_event,milliseconds_per_period\n".to_owned();
    for row in &rows {
        writeln!(table, "{},{},{:.3},{:.5}", row.blades, row.events, per_event(row), 1e3 * row.seconds)?;
    }
    print!("{table}");
    for least in [2, 16, 125] {
        println!("{}", slopes(&rows, least));
    }
    std::fs::create_dir_all(&folder)?;
    std::fs::write(folder.join("disk_cost.csv"), table)?;
    figure(&rows).write(&folder.join("disk_cost.svg"))?;
    Ok(())
}
