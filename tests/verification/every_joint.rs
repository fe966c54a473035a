//! Every kind of joint: what is written by hand for speed equals what follows from the pose.

use mbody::joint::{Joint, KINDS};
use mbody::scalar::{Lanes, Real};
use mbody::spatial::{Pose, Rotation, Twist, Vec3, Wrench};
use validation::agreement::{Agreement, Tolerance, relative};
use validation::evidence::Row;
use validation::numbers::Numbers;

/// Rows of the table.
pub const EVIDENCE: &[Row] = validation::evidence![
    subspace_and_bias_follow_from_the_pose => (
        "motion subspace, bias and q̇ = N(q) v of every joint follow from its pose",
        "derivatives of the pose along the motion, by dual numbers",
        "relative 1e-13: double precision, a few dozen operations"
    ),
    efforts_and_motions_are_the_columns_of_the_subspace => (
        "the short forms of H v, Hᵀ F and V × H v of every joint are those of its subspace, and so is what joints with six velocities are solved for",
        "definition",
        "relative 1e-14: double precision"
    ),
    a_joint_does_not_see_where_it_is_mounted => (
        "the motion of every joint is independent of the place of its inboard frame; its pose is X_PF X_FM(q)",
        "frame invariance",
        "relative 1e-14: double precision"
    ),
];

const ROUNDING: Tolerance = relative(1e-13).because("double precision, a few dozen operations");
const SHORT: Tolerance = relative(1e-14).because("double precision, a few operations");

fn vector(numbers: &mut Numbers) -> Vec3<f64> {
    Vec3::new(numbers.signed(), numbers.signed(), numbers.signed())
}

fn axis(numbers: &mut Numbers) -> Vec3<f64> {
    loop {
        if let Some(axis) = vector(numbers).normalized() {
            return axis;
        }
    }
}

/// A joint with coordinates on its manifold and velocities.
struct Case {
    name: String,
    joint: Joint,
    q: Vec<f64>,
    v: Vec<f64>,
}

/// Every kind, with the axes of the frame and with axes in general position.
fn cases() -> Vec<Case> {
    let mut numbers = Numbers(2026);
    let mut cases = Vec::new();
    for kind in KINDS {
        for round in 0..8 {
            let axis = match round {
                0 => Vec3::new(1.0, 0.0, 0.0),
                1 => Vec3::new(0.0, 1.0, 0.0),
                2 => Vec3::new(0.0, 0.0, 1.0),
                _ => axis(&mut numbers),
            };
            let joint = (kind.make)(axis, 0.3 * numbers.signed());
            let mut q: Vec<f64> = joint.reference().iter().map(|_| numbers.signed()).collect();
            // a group of coordinates whose reference is (0, 0, 0, 1) is a quaternion
            if let Some(first) = joint.coordinates().iter().position(|c| c.name == "quaternion_x") {
                let quaternion = &mut q[first..first + 4];
                let norm = quaternion.iter().map(|x| x * x).sum::<f64>().sqrt();
                quaternion.iter_mut().for_each(|x| *x /= norm);
            }
            let v = (0..joint.nv()).map(|_| 2.0 * numbers.signed()).collect();
            cases.push(Case { name: format!("{} {round}", kind.name), joint, q, v });
        }
    }
    cases
}

type Dual = Lanes<2>;

fn flat(t: Twist<f64>) -> [f64; 6] {
    [t.w.x, t.w.y, t.w.z, t.v.x, t.v.y, t.v.z]
}

fn entries(X: &Pose<f64>) -> Vec<f64> {
    X.R.columns.iter().chain([&X.p]).flat_map(|c| [c.x, c.y, c.z]).collect()
}

fn part(v: Vec3<Dual>, pick: impl Fn(Dual) -> f64) -> Vec3<f64> {
    Vec3::new(pick(v.x), pick(v.y), pick(v.z))
}

/// Pose, subspace and their rates along `q̇ = N(q) v`.
fn along(case: &Case) -> (Pose<Dual>, Vec<Twist<Dual>>) {
    let mut rates = vec![0.0; case.q.len()];
    case.joint.rates(&case.q, &case.v, &mut rates);
    let q: Vec<Dual> = case
        .q
        .iter()
        .zip(&rates)
        .map(|(&value, &rate)| {
            let mut dual = Dual::from_f64(value);
            dual.set_derivative(0, rate);
            dual
        })
        .collect();
    let mut H = vec![Twist::zero(); case.joint.nv()];
    let X = case.joint.place(&Pose::identity(), &q, &mut H);
    (X, H)
}

fn sum(H: &[Twist<f64>], v: &[f64]) -> Twist<f64> {
    H.iter().zip(v).fold(Twist::zero(), |sum, (column, &x)| sum + column.scaled(x))
}

#[test]
fn subspace_and_bias_follow_from_the_pose() {
    let mut agreement = Agreement::on("joints: subspace and bias against the derivatives of the pose");
    for case in cases() {
        let (X, H) = along(&case);
        let value = |d: Dual| d.value();
        let rate = |d: Dual| d.derivative(0);
        // w = (Rᵀ Ṙ)^∨, v = Rᵀ ṗ
        let (R, Rd) = (X.R.columns.map(|c| part(c, value)), X.R.columns.map(|c| part(c, rate)));
        let R = Rotation::from_columns(R[0], R[1], R[2]);
        let turned = Rd.map(|c| R.inverse_times(c));
        let from_pose = Twist::new(Vec3::new(turned[1].z, turned[2].x, turned[0].y), R.inverse_times(part(X.p, rate)));
        let values: Vec<Twist<f64>> = H.iter().map(|h| Twist::new(part(h.w, value), part(h.v, value))).collect();
        agreement.all_near(&format!("{}: H v", case.name), &flat(sum(&values, &case.v)), &flat(from_pose), &ROUNDING);
        // Rᵀ Ṙ is skew: rates lead along the manifold of rotations
        let symmetric = [turned[0].x, turned[1].y, turned[2].z, turned[0].y + turned[1].x, turned[0].z + turned[2].x];
        agreement.all_near(
            &format!("{}: symmetric part of Rᵀ Ṙ", case.name),
            &symmetric.map(|x| 1.0 + x),
            &[1.0; 5],
            &relative(1e-13).because("double precision at rates of a few rad/s"),
        );
        let rates: Vec<Twist<f64>> = H.iter().map(|h| Twist::new(part(h.w, rate), part(h.v, rate))).collect();
        let bias = case.joint.bias(&case.q, &case.v);
        let size = case.v.iter().map(|v| v * v).sum::<f64>();
        let scaled = |t: Twist<f64>| flat(t).map(|x| size + x);
        agreement.all_near(&format!("{}: Ḣ v", case.name), &scaled(bias), &scaled(sum(&rates, &case.v)), &ROUNDING);
    }
    agreement.assert();
}

#[test]
fn efforts_and_motions_are_the_columns_of_the_subspace() {
    let mut agreement = Agreement::on("joints: motion and effort against the subspace");
    let mut numbers = Numbers(7);
    for case in cases() {
        let mut H = vec![Twist::zero(); case.joint.nv()];
        case.joint.place(&Pose::identity(), &case.q, &mut H);
        agreement.all_near(&case.name, &flat(case.joint.motion(&H, &case.v)), &flat(sum(&H, &case.v)), &SHORT);
        let F = Wrench::new(vector(&mut numbers), vector(&mut numbers));
        let mut tau = vec![0.0; case.joint.nv()];
        case.joint.effort(&H, F, &mut tau);
        let expected: Vec<f64> = H.iter().map(|h| h.dot(F)).collect();
        agreement.all_near(&case.name, &tau, &expected, &SHORT);
        let V_P = Twist::new(vector(&mut numbers), vector(&mut numbers));
        let (V_J, (V, c)) = (sum(&H, &case.v), case.joint.carried(V_P, &case.q, &H, &case.v));
        agreement.all_near(&format!("{}: carried", case.name), &flat(V), &flat(V_P + V_J), &SHORT);
        let (bias, size) = (case.joint.bias(&case.q, &case.v) + (V_P + V_J).cross(V_J), case.v.iter().map(|v| 1.0 + v * v).sum::<f64>());
        agreement.all_near(&format!("{}: bias", case.name), &flat(c).map(|x| size + x), &flat(bias).map(|x| size + x), &SHORT);
        let columns = case.joint.columns(&H);
        let dots: Vec<f64> = (0..H.len()).map(|a| columns.dot(a, &F)).collect();
        agreement.all_near(&format!("{}: columns", case.name), &dots, &expected, &SHORT);
        // what a joint that leaves all motions is solved for
        agreement.holds(&format!("{}: solved where H is square", case.name), case.joint.leaves_all() == (case.joint.nv() == 6));
        if let Some(back) = case.joint.wrench(&H, &tau) {
            let wrench = |F: Wrench<f64>| [F.n.x, F.n.y, F.n.z, F.f.x, F.f.y, F.f.z];
            agreement.all_near(&format!("{}: wrench", case.name), &wrench(back).map(|x| 10.0 + x), &wrench(F).map(|x| 10.0 + x), &ROUNDING);
            let mut v = vec![0.0; H.len()];
            case.joint.velocity(&H, V_P, &mut v);
            agreement.all_near(
                &format!("{}: velocity", case.name),
                &flat(sum(&H, &v)).map(|x| 10.0 + x),
                &flat(V_P).map(|x| 10.0 + x),
                &ROUNDING,
            );
        }
        if let Some(axis) = case.joint.rotation_axis() {
            let along = H.iter().map(|h| h.w.cross(axis).norm()).fold(0.0, f64::max);
            agreement.holds(&format!("{}: turns about its axis", case.name), along < 1e-14);
        }
    }
    agreement.assert();
}

#[test]
fn a_joint_does_not_see_where_it_is_mounted() {
    let mut agreement = Agreement::on("joints: invariance against the inboard frame");
    let mut numbers = Numbers(11);
    for case in cases() {
        let angles = vector(&mut numbers);
        let X_PF = Pose::from_xyz_rpy([numbers.signed(), numbers.signed(), numbers.signed()], [angles.x, angles.y, angles.z]);
        let (mut here, mut there) = (vec![Twist::zero(); case.joint.nv()], vec![Twist::zero(); case.joint.nv()]);
        let X_FM = case.joint.place(&Pose::identity(), &case.q, &mut here);
        let X_PM = case.joint.place(&X_PF, &case.q, &mut there);
        agreement.all_near(&format!("{}: pose", case.name), &entries(&X_PM), &entries(&(X_PF * X_FM)), &SHORT);
        for (a, b) in here.iter().zip(&there) {
            agreement.all_near(&format!("{}: subspace", case.name), &flat(*b), &flat(*a), &SHORT);
        }
        // the reference coordinates are the pose in which both frames coincide
        let mut H = vec![Twist::zero(); case.joint.nv()];
        let X = case.joint.place(&Pose::identity(), case.joint.reference(), &mut H);
        agreement.all_near(&format!("{}: reference", case.name), &entries(&X), &entries(&Pose::identity()), &SHORT);
    }
    agreement.assert();
}
