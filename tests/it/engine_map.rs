//! Scratch
use stickslip::conformance::hopf::*;
use stickslip::engine::*;
#[test]
fn scratch() {
    for n in [64, 128, 256, 512, 1024, 2048] {
        let t = std::time::Instant::now();
        let p = CycleProblem::symmetric(EngineSettings::default_for(0.1), n, 0.0);
        if n == 256 {
            let o = p.at(-0.06).orbit().unwrap();
            println!("{:?} {} {:?}", o.multipliers(), o.step, o.switches);
        }
        for r in over_phases(&p, 8, -0.0346) {
            match r {
                Ok(h) => println!(
                    "{n} {} {} {:+.4} {:?} {:e}",
                    h.phase,
                    h.xi1,
                    (h.xi1 + 0.0345753708) * (n * n) as f64,
                    h.orbit.switches,
                    h.orbit.residual
                ),
                Err(e) => println!("{e}"),
            }
        }
        println!("{:?}", t.elapsed());
    }
}
