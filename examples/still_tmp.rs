use stickslip::{dynamics::*, engine::*, model::*, render::*, scene::*, stage::*};
fn main() {
    let text = std::fs::read_to_string(std::env::args().nth(1).unwrap()).unwrap();
    let t: f64 = std::env::args().nth(2).unwrap().parse().unwrap();
    let out = std::env::args().nth(3).unwrap();
    let (_, case) = Scene::parse(&text, "x").unwrap();
    let rig = TwoMassRig::new(case.parameters).unwrap();
    let st = EngineSettings::default_for(0.01);
    let s = Sampling { interval: 0.04, t_end: case.duration };
    let y0 = State::two_mass([1.22, 0.91, 0.0, -0.53, 1.0]);
    let tr = if let Some(m) = case.prescribed {
        stickslip::engine::PrescribedFlow::new(rig.chain(), m, st)
            .unwrap()
            .trajectory(&State::two_mass([0., 0., 2., 0., 0.]), s)
            .unwrap()
    } else {
        EngineFlow::new(rig.chain(), st).unwrap().trajectory(&y0, s).unwrap()
    };
    let stage = Stage::new(case.clone(), Motion::new(&tr).unwrap());
    let k = (t / case.frame_interval()) as u64;
    let list = stage.frame(k);
    let tri: usize = list.objects.iter().map(|o| o.mesh.triangles.len()).sum();
    let mut r = open(RendererChoice::Cpu).unwrap();
    r.draw(&list).unwrap();
    let t0 = std::time::Instant::now();
    let (img, times) = r.draw(&list).unwrap();
    println!("{tri} triangles {:?} {:?}", t0.elapsed(), times);
    img.save(out).unwrap();
}
