//! The tire element on a carrier: exact derivatives, symmetries, balance of power, build-up of side forces, lifting.
#![allow(non_snake_case)]

mod balance;
mod build_up;
mod contact;
mod rig;

use mbody::contact::Profile;
use mbody::force::Force;
use mbody::spatial::Vec3;
use motorcycle::tire::compact_motorcycle::{
    AligningShape, CombinedWeights, CompactMotorcycleParameters, LateralShape, LoadDependence, LongitudinalShape,
};
use motorcycle::tire::linear_normalized::LinearNormalizedParameters;
use motorcycle::tire::rolling_resistance::RollingResistance;
use motorcycle::tire::{
    AnyTireLaw, Carcass, Deformable, EffectiveRadius, Elastic, Relaxation, RelaxationLength, RoadContact, ThinDiscLinear, Tire, Vertical,
    Wheel,
};
use problem::{At, Dae, Limits, Outputs, Seeds};
use rig::{Rig, vehicle};

const RADIUS: f64 = 0.3;

/// A carrier on a vehicle base, and a wheel on it.
const BENCH: &str = r#"<robot name="bench">
  <link name="carrier">
    <inertial><mass value="100"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <joint name="wheel" type="continuous">
    <parent link="carrier"/><child link="rim"/><origin xyz="0 0 0.3"/><axis xyz="0 1 0"/>
  </joint>
  <link name="rim">
    <inertial><mass value="10"/><inertia ixx="0.3" iyy="0.5" izz="0.3" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
</robot>"#;

const RADIAL: Elastic = Elastic { stiffness: 150e3, damping: 300.0 };
const LATERAL: Elastic = Elastic { stiffness: 160e3, damping: 100.0 };
const LONGITUDINAL: Elastic = Elastic { stiffness: 300e3, damping: 120.0 };

/// A law that uses everything a law may.
fn law() -> AnyTireLaw {
    let linear = |value, slope| LoadDependence::Linear { value, slope };
    let parameters = CompactMotorcycleParameters {
        nominal_load: 1300.0,
        longitudinal: LongitudinalShape { stiffness: linear(20.0, -2.0), peak: linear(1.2, -0.05), shape: 1.5, curvature: 0.2 },
        lateral: LateralShape {
            cornering_stiffness: LoadDependence::Saturating { peak: 17.0, saturation_load: 2.2 },
            camber_stiffness: linear(0.9, 0.05),
            peak: linear(1.25, -0.05),
            cornering_shape: 1.1,
            camber_shape: 0.7,
            cornering_curvature: -1.0,
            camber_curvature: -2.0,
        },
        aligning: AligningShape { pneumatic_trail: 0.025, trail_shape: 1.2, trail_slope: 8.0, twisting_moment: 0.015, twisting_slope: 5.0 },
        combined: Some(CombinedWeights { longitudinal_shape: 1.1, longitudinal_slope: 12.0, lateral_shape: 1.05, lateral_slope: 8.0 }),
    };
    AnyTireLaw::new(parameters.law().expect("a law"))
}

/// A law without bends.
fn linear() -> AnyTireLaw {
    let parameters = LinearNormalizedParameters {
        longitudinal_stiffness: 20.0,
        cornering_stiffness: 14.0,
        camber_stiffness: 0.9,
        aligning_stiffness: 0.3,
        twisting_stiffness: 0.015,
    };
    AnyTireLaw::new(parameters.law().expect("a law"))
}

fn deformable(longitudinal: Option<Elastic>) -> Carcass {
    Carcass::Deformable(Deformable { radial: RADIAL, lateral: LATERAL, longitudinal })
}

fn vertical(relaxation: Relaxation) -> Carcass {
    Carcass::Vertical(Vertical { normal: Elastic { stiffness: 150e3, damping: 800.0 }, quadratic: 1e6, relaxation })
}

/// Every carcass, with all its options.
fn carcasses() -> Vec<Carcass> {
    vec![
        deformable(None),
        deformable(Some(LONGITUDINAL)),
        vertical(Relaxation::None),
        vertical(Relaxation::Elastic(LATERAL)),
        vertical(Relaxation::Slip {
            lateral: RelaxationLength::CorneringStiffness([8.6e-6, 3.7e-8, 8.4e-10]),
            longitudinal: Some(RelaxationLength::LoadPolynomial(vec![0.05, 5e-5])),
        }),
        vertical(Relaxation::Force(RelaxationLength::LoadPolynomial(vec![0.1, 1e-4, -3e-8]))),
        vertical(Relaxation::ForceWithoutCamber(RelaxationLength::Constant(0.2))),
    ]
}

/// A bench with a tire of this carcass; `change` adapts the rest.
fn bench(carcass: Carcass, change: impl Fn(&mut Tire)) -> Rig {
    let model = vehicle(BENCH);
    let profile = Profile::torus(RADIUS, 0.06).expect("a torus");
    let wheel = Wheel::new(&model, model.joint("wheel").expect("a wheel"), profile, "road").expect("a wheel joint");
    let mut tire = Tire {
        wheel,
        carcass,
        law: law(),
        contact: RoadContact::Lifting,
        rolling_resistance: RollingResistance::SHARP_1994,
        effective_radius: EffectiveRadius::Fraction(1.0 / 3.0),
        low_speed: 0.1,
    };
    change(&mut tire);
    Rig::new(model, vec![Force::new("tire", tire)])
}

fn disc() -> Rig {
    let model = vehicle(BENCH);
    let profile = Profile::disc(RADIUS).expect("a disc");
    let wheel = Wheel::new(&model, model.joint("wheel").expect("a wheel"), profile, "road").expect("a wheel joint");
    let parameters = LinearNormalizedParameters {
        longitudinal_stiffness: 12.0,
        cornering_stiffness: 12.0,
        camber_stiffness: 1.0,
        aligning_stiffness: 0.0,
        twisting_stiffness: 0.0,
    };
    let normal = Elastic { stiffness: 150e3, damping: 500.0 };
    let disc = ThinDiscLinear { wheel, normal, law: parameters.law().expect("a law"), low_speed: 0.1 };
    Rig::new(model, vec![Force::new("tire", disc)])
}

/// Puts the bench into a general motion, spread by irrational multiples; sinks the tire by some millimeters.
fn general_motion(rig: &mut Rig, i: u32) {
    let spread = |k: f64| 2.0 * (f64::from(i) * k.sqrt()).fract() - 1.0;
    let roll = 0.8 * spread(2.0);
    let sunk = 0.008 + 0.003 * spread(3.0);
    // height of the axle of the undeformed torus, and of the disc within its edge
    let height = 0.24 * roll.cos() + 0.06 - sunk;
    for (name, value) in [
        ("carrier.x", 3.0 * spread(5.0)),
        ("carrier.y", 3.0 * spread(7.0)),
        ("carrier.yaw", 3.0 * spread(11.0)),
        ("carrier.roll", roll),
        ("carrier.pitch", 0.2 * spread(13.0)),
        ("carrier.forward_speed", 20.0 + 8.0 * spread(17.0)),
        ("carrier.lateral_speed", 0.5 * spread(19.0)),
        ("carrier.yaw_rate", 0.5 * spread(23.0)),
        ("carrier.heave_rate", 0.05 * spread(29.0)),
        ("carrier.roll_rate", 0.5 * spread(31.0)),
        ("carrier.pitch_rate", 0.2 * spread(37.0)),
        ("wheel.angle", 2.0 * spread(41.0)),
        ("road.height", 0.02 * spread(43.0)),
        ("road.height_rate", 0.05 * spread(47.0)),
    ] {
        rig.set(name, value);
    }
    let pitch = rig.get("carrier.pitch");
    rig.set("carrier.heave", height + rig.get("road.height") - RADIUS * roll.cos() * pitch.cos());
    let spin = rig.get("carrier.forward_speed") / 0.29 * (1.0 + 0.03 * spread(53.0));
    rig.set("wheel.spin_rate", spin);
    let states: Vec<String> = states(rig);
    for (k, name) in states.iter().enumerate() {
        let (value, rate) = match name.as_str() {
            "tire.lagged_lateral_force" => (600.0, 3000.0),
            "tire.lagged_lateral_slip" | "tire.lagged_longitudinal_slip" => (0.05, 0.3),
            _ => (0.002, 0.02),
        };
        rig.set(name, value * spread(59.0 + f64::from(k as u32)));
        rig.set_rate(name, rate * spread(61.0 + f64::from(k as u32)));
    }
}

/// Names of the states of the tire.
fn states(rig: &Rig) -> Vec<String> {
    rig.plant.unknowns().iter().map(|u| u.signal.name.clone()).filter(|n| n.starts_with("tire.")).collect()
}

/// Solves the rows of the tire for the rates of its states.
fn solve_rates(rig: &mut Rig) {
    let (n, count) = (rig.y.len(), states(rig).len());
    if count == 0 {
        return;
    }
    for _ in 0..20 {
        let (r, _) = rig.evaluate();
        let mut seeds = Seeds::zeros(n, rig.u.len(), count);
        for k in 0..count {
            seeds.yd[(n - count + k, k)] = 1.0;
        }
        let (dr, _) = rig.along(&seeds);
        let rows = r.len() - count;
        let J = nalgebra::DMatrix::from_fn(count, count, |i, k| dr[(rows + i, k)]);
        let step = J.lu().solve(&nalgebra::DVector::from_fn(count, |i, _| r[rows + i])).expect("regular rows");
        for k in 0..count {
            rig.yd[n - count + k] -= step[k];
        }
        if r[rows..].iter().all(|x| x.abs() < 1e-9) {
            return;
        }
    }
    panic!("the rows have no solution");
}
