use funicular::catenary::*;
use funicular::math::*;
use funicular::robot::*;
use funicular::statics::*;
fn yuan(mass: f64, set8: bool) -> (Robot, Vec<f64>) {
    let (x, y, h, l) = (5.327, 2.267, 4.193, 3.822);
    let anchors = [[x, -y, h], [x, -y, l], [x, y, h], [x, y, l], [-5.775, 0.01, h], [-5.775, 0.01, l]];
    let att = [
        [-0.025, -0.143, 0.0],
        [0.136, -0.05, 0.0],
        [0.136, 0.05, 0.0],
        [-0.025, 0.143, 0.0],
        [-0.111, 0.093, 0.0],
        [-0.111, -0.093, 0.0],
    ];
    let d: f64 = if set8 { 0.008 } else { 0.004 };
    let material = Material {
        name: "r".into(),
        axial_stiffness: 20e9 * std::f64::consts::PI * d * d / 4.0,
        mass_per_length: if set8 { 0.251 } else { 0.067 },
        damping: Damping::Ratio(0.003),
    };
    let lengths = if set8 {
        vec![4.859, 4.552, 4.83, 4.586, 9.417, 9.284]
    } else {
        vec![6.863, 6.565, 6.756, 6.663, 6.801, 6.604]
    };
    let cables = (0..6)
        .map(|i| Cable {
            name: (i + 1).to_string(),
            material: material.clone(),
            anchor_w: Vec3::from(anchors[i]),
            attachment_p: Vec3::from(att[i]),
        })
        .collect();
    (
        Robot {
            name: "y".into(),
            source: String::new(),
            gravity_w: Vec3::new(0.0, 0.0, -9.81),
            platform: Platform {
                mass,
                inertia_p: Mat3::from_diagonal(&Vec3::new(0.15, 0.15, 0.25)),
                center_of_mass_p: Vec3::zeros(),
                freedoms: Freedoms::Rigid,
            },
            cables,
            state: State::Unknown,
        },
        lengths,
    )
}
fn main() {
    for (dx, dz, l0, ea, w, h, vb) in [
        (100.0, 0.0, 105.0, 1e7, 10.0, 918.634_473_646_241_4, 525.0),
        (100., 0., 100., 1e7, 10., 7463.990429563480585, 500.),
        (100., 50., 120., 5e6, 20., 1368.6500858446605278, 2001.8548514507257675),
        (5.54, 4.025, 6.9, 251327.412287183459, 0.65727, 6.8896475688604366713, 7.3891118132479032829),
        (0.001, 10., 12., 1e6, 5., 0.00020875083314405098793, 54.999250024479704792),
        (1000., 300., 1050., 1e8, 700., 1044436.1913721337819, 692091.28786503851973),
    ] {
        let c = Catenary::between(dx, dz, Rope { unstrained_length: l0, weight_per_length: w, axial_stiffness: ea })
            .unwrap();
        println!("{:e} {:e} {:?}", c.horizontal_force() / h - 1.0, c.vertical_force_at_end() / vb - 1.0, c.tangent());
    }
    for set8 in [false, true] {
        for mass in [10.55, 20.0, 30.0, 86.35] {
            let (robot, lengths) = yuan(mass, set8);
            for model in [StaticModel::Ideal, StaticModel::Spring, StaticModel::Catenary] {
                match forward(&robot, &lengths, model, None) {
                    Ok(e) => {
                        let k = tangent_stiffness(&robot, &e);
                        println!(
                            "{set8} {mass} {model:?} {:?} {:?} it {} res {:e} {:?} asym {:?}",
                            e.pose.position_w.as_slice(),
                            e.cables.iter().map(|c| (c.tension_platform * 100.0).round() / 100.0).collect::<Vec<_>>(),
                            e.iterations,
                            e.residual,
                            e.stability,
                            k.map(|k| (k - k.transpose()).amax() / k.amax())
                        );
                        if !matches!(model, StaticModel::Ideal) {
                            match inverse(&robot, &e.pose, model) {
                                Ok(b) => println!(
                                    "   inverse it {} res {:e} dl {:e}",
                                    b.iterations,
                                    b.residual,
                                    b.cables
                                        .iter()
                                        .zip(&lengths)
                                        .map(|(c, l)| (c.unstrained_length - l).abs())
                                        .fold(0.0, f64::max)
                                ),
                                Err(e) => println!("   {e}"),
                            }
                        }
                    }
                    Err(e) => println!("{set8} {mass} {model:?} {e}"),
                }
            }
        }
    }
    let (robot, lengths) = yuan(10.55, false);
    let t = std::time::Instant::now();
    let mut s = 0.0;
    for _ in 0..10000 {
        s += forward(&robot, std::hint::black_box(&lengths), StaticModel::Catenary, None).unwrap().residual;
    }
    println!("forward {:?} {s:e}", t.elapsed() / 10000);
    let t = std::time::Instant::now();
    for i in 0..1_000_000 {
        let c = Catenary::between(
            5.3 + 1e-8 * f64::from(i),
            4.0,
            Rope { unstrained_length: 6.8, weight_per_length: 0.65727, axial_stiffness: 251327.4 },
        )
        .unwrap();
        s += c.horizontal_force();
    }
    println!("catenary {:?} {s:e}", t.elapsed() / 1_000_000);
}
