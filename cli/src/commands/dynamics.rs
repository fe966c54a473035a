//! `dynamics`: inverse and forward dynamics, mass matrix, energies and poses at given states, for any mechanism.

use super::{Kind, read};
use crate::arguments::{ModelArguments, argument};
use crate::{Context, Exit, Failure, model};
use clap::{ArgMatches, Args, Command};
use mbody::algorithm::{aba::aba, crba::crba, energy, kinematics, rnea::rnea};
use mbody::assembly::BaseDescription;
use mbody::description::finding::{Finding, Findings, suggestion};
use mbody::description::quantity::{Dimensioned, dimension::Acceleration, parse_quantity};
use mbody::model::Model;
use mbody::stage::Workspace;
use serde::Deserialize;
use serde_json::{Map, Value, json};
use std::io::ErrorKind;
use std::path::PathBuf;

/// Row of the table of commands.
pub const KIND: Kind = Kind { name: "dynamics", command, run };

#[derive(Debug, Args)]
struct Arguments {
    #[command(flatten)]
    model: ModelArguments,
    /// JSON file: {"states": [{"q": […], "v": […], "a": […], "tau": […]}], "order": ["joint name", …]}
    #[arg(long, value_name = "FILE")]
    state: PathBuf,
    /// Put a plain URDF on a free base (position, quaternion xyzw; body-frame twist, linear then angular)
    #[arg(long)]
    floating: bool,
    /// Acceleration of free fall, downward, for a plain URDF
    #[arg(long, default_value = "9.81")]
    gravity: String,
}

/// The states as written; `a` and `tau` may be left out (zero).
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct States {
    states: Vec<State>,
    order: Option<Vec<String>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct State {
    q: Vec<f64>,
    v: Option<Vec<f64>>,
    a: Option<Vec<f64>>,
    tau: Option<Vec<f64>>,
}

fn command(command: Command) -> Command {
    Arguments::augment_args(command).about("Inverse and forward dynamics, mass matrix, energies and poses of the bare tree at given states")
}

fn run(matches: &ArgMatches, context: &Context) -> Result<Exit, Failure> {
    let arguments: Arguments = read(matches)?;
    let gravity = parse_quantity(&arguments.gravity, Acceleration::DIMENSION)
        .map_err(|e| Failure::from(argument("gravity", &arguments.gravity, e.code(), e.to_string()).with_hint_from(e.hint())))?;
    let base = if arguments.floating { BaseDescription::Free } else { BaseDescription::Fixed };
    let loaded = model::load_on(&arguments.model, context, base, gravity)?;
    let file = arguments.state.display().to_string();
    let text = std::fs::read_to_string(&arguments.state).map_err(|e| {
        let message = match e.kind() {
            ErrorKind::NotFound => format!("file `{file}` was not found"),
            _ => format!("file `{file}` cannot be read: {e}"),
        };
        Failure::from(argument("state", &file, "missing_file", message))
    })?;
    let wrong = |why: String| Finding::error("bad_state", why).in_file(&file);
    let states: States = serde_json::from_str(&text).map_err(|e| {
        let (whole, at) = (e.to_string(), format!(" at line {} column {}", e.line(), e.column()));
        Failure::from(wrong(whole.replace(&at, "")).at_line(&text, e.line(), e.column()))
    })?;
    let tree = loaded.assembled.system.model();
    let order = Order::new(tree, states.order.as_deref(), &file)?;
    let mut results = Vec::new();
    for (k, state) in states.states.iter().enumerate() {
        results.push(evaluate(tree, &order, state).map_err(|why| Failure::from(wrong(why).at_path(format!("states.{k}"))))?);
    }
    let report = json!({
        "fastbike": env!("CARGO_PKG_VERSION"), "command": "dynamics", "model": loaded.name,
        "order": order.names, "states": results, "warnings": [],
    });
    context.console.print(format!("{report:#}\n").as_bytes())?;
    Ok(Exit::Done)
}

/// How the numbers of a state map to the coordinates of the tree.
struct Order {
    /// Names of the joints in the order of the file, the base first where there is one.
    names: Vec<String>,
    /// [nq] independent coordinate of each number of q.
    q: Vec<usize>,
    /// [nv] independent velocity of each number of v, a, tau.
    v: Vec<usize>,
}

impl Order {
    fn new(tree: &Model, wanted: Option<&[String]>, file: &str) -> Result<Self, Findings> {
        let wrong = |message: String| Finding::error("bad_order", message).in_file(file).at_path("order");
        let layout = tree.layout();
        let free = |range: &std::ops::Range<usize>, independent: &[usize]| -> Vec<usize> {
            range.clone().filter_map(|k| independent.iter().position(|&i| i == k)).collect()
        };
        let mut order = Self { names: Vec::new(), q: Vec::new(), v: Vec::new() };
        let mut bodies: Vec<_> = tree.moving().map(|b| tree.body(b)).filter(|b| !free(&b.v, &layout.independent_v).is_empty()).collect();
        if let Some(wanted) = wanted {
            // a base of several coordinates comes first and is not named
            let base = bodies.iter().position(|b| b.joint.nv() == 6 && !wanted.contains(&b.joint_name));
            let mut sorted: Vec<_> = base.map(|i| bodies.remove(i)).into_iter().collect();
            for name in wanted {
                match bodies.iter().position(|b| b.joint_name == *name) {
                    Some(at) => sorted.push(bodies.remove(at)),
                    None => {
                        let known = tree.moving().map(|b| tree.body(b).joint_name.as_str());
                        let twice = order.names.contains(name) || sorted.iter().any(|b| b.joint_name == *name);
                        let message = match twice {
                            true => format!("joint `{name}` stands twice in the order"),
                            false => format!("there is no moving joint `{name}`"),
                        };
                        let hint = suggestion(name, known).filter(|_| !twice);
                        return Err(wrong(message).with_hint_from(hint).into());
                    }
                }
            }
            if let Some(missing) = bodies.first() {
                return Err(wrong(format!("joint `{}` is missing in the order", missing.joint_name)).into());
            }
            bodies = sorted;
        }
        for body in bodies {
            order.names.push(body.joint_name.clone());
            order.q.extend(free(&body.q, &layout.independent_q));
            order.v.extend(free(&body.v, &layout.independent_v));
        }
        Ok(order)
    }

    fn load(map: &[usize], what: &str, given: Option<&[f64]>) -> Result<Vec<f64>, String> {
        let mut values = vec![0.0; map.len()];
        let Some(given) = given else { return Ok(values) };
        if given.len() != map.len() {
            return Err(format!("`{what}` has {} numbers, the model has {}", given.len(), map.len()));
        }
        if let Some(bad) = given.iter().find(|x| !x.is_finite()) {
            return Err(format!("`{what}` holds {bad}"));
        }
        for (&to, &x) in map.iter().zip(given) {
            values[to] = x;
        }
        Ok(values)
    }

    fn in_order(map: &[usize], values: &[f64]) -> Vec<f64> {
        map.iter().map(|&i| values[i]).collect()
    }
}

fn evaluate(tree: &Model, order: &Order, state: &State) -> Result<Value, String> {
    let layout = tree.layout();
    let q = Order::load(&order.q, "q", Some(&state.q))?;
    let v = Order::load(&order.v, "v", state.v.as_deref())?;
    let a = Order::load(&order.v, "a", state.a.as_deref())?;
    let tau = Order::load(&order.v, "tau", state.tau.as_deref())?;
    let mut w = Workspace::<f64>::new(tree);
    layout.expand_q(&q, &mut w.position.q);
    layout.expand_v(&v, &mut w.velocity.v);
    layout.expand_v(&a, &mut w.acceleration.vd);
    kinematics::position(tree, &mut w.position);
    kinematics::world(tree, &w.position, &mut w.world);
    kinematics::velocity(tree, &w.position, &mut w.velocity);
    let inverse = inverse_dynamics(tree, &mut w);
    let mass = mass_matrix(tree, &mut w);
    let forward = if layout.is_identity() {
        w.tau.copy_from_slice(&tau);
        w.applied.fill(Default::default());
        aba(tree, &mut w);
        w.acceleration.vd.clone()
    } else {
        // M v̇ = τ − h, h the inverse dynamics at v̇ = 0
        w.acceleration.vd.fill(0.0);
        let bias = inverse_dynamics(tree, &mut w);
        let n = layout.nv();
        let right = nalgebra::DVector::from_fn(n, |i, _| tau[i] - bias[i]);
        let solved = nalgebra::DMatrix::from_fn(n, n, |i, j| mass[i][j]).cholesky().map(|c| c.solve(&right));
        solved.ok_or("the mass matrix is not positive definite")?.as_slice().to_vec()
    };
    let mut poses = Map::new();
    for frame in tree.frames().iter().skip(1) {
        let pose = w.world.X_WB[frame.body.get()] * frame.X_BF;
        let rows: Vec<[f64; 3]> = (0..3).map(|i| [pose.R.columns[0][i], pose.R.columns[1][i], pose.R.columns[2][i]]).collect();
        poses.insert(frame.name.clone(), json!({ "position": [pose.p.x, pose.p.y, pose.p.z], "rotation": rows }));
    }
    let center = energy::mass_center(tree, &w.world);
    let rows: Vec<Vec<f64>> = order.v.iter().map(|&i| order.v.iter().map(|&j| mass[i][j]).collect()).collect();
    Ok(json!({
        "inverse_dynamics": Order::in_order(&order.v, &inverse),
        "forward_dynamics": Order::in_order(&order.v, &forward),
        "mass_matrix": rows,
        "kinetic_energy": energy::kinetic(tree, &w.velocity),
        "potential_energy": energy::potential(tree, &w.world),
        "center_of_mass": [center.x, center.y, center.z],
        "poses": poses,
    }))
}

/// Independent generalized forces for the accelerations in the workspace.
fn inverse_dynamics(tree: &Model, w: &mut Workspace<f64>) -> Vec<f64> {
    kinematics::acceleration(tree, &w.position, &w.velocity, &mut w.acceleration);
    w.applied.fill(Default::default());
    rnea(tree, &w.position, &w.velocity, &w.acceleration, &w.applied, &mut w.transmitted, &mut w.tau);
    let mut independent = vec![0.0; tree.layout().nv()];
    tree.layout().reduce(&mut w.tau, &mut independent);
    independent
}

/// Mass matrix of the independent velocities, `Zᵀ M Z`, by rows.
fn mass_matrix(tree: &Model, w: &mut Workspace<f64>) -> Vec<Vec<f64>> {
    let layout = tree.layout();
    let (n, nt) = (layout.nv(), layout.tree_nv);
    let mut entries = vec![0.0; nt * nt];
    crba(tree, &w.position, &mut w.composite, &mut entries);
    let mut columns = vec![vec![0.0; n]; n];
    for (j, column) in columns.iter_mut().enumerate() {
        let (mut unit, mut direction) = (vec![0.0; n], vec![0.0; nt]);
        unit[j] = 1.0;
        layout.expand_v(&unit, &mut direction);
        let mut product: Vec<f64> = (0..nt).map(|i| (0..nt).map(|k| entries[i * nt + k] * direction[k]).sum()).collect();
        layout.reduce(&mut product, column);
    }
    columns
}
