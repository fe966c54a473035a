//! Mechanisms and states recorded with an independent code (`tests/reference/mechanisms`, `tests/reference/moto11`).

use mbody::assembly::{BaseDescription, assemble_urdf};
use mbody::dynamics::System;
use mbody::joint::{Free, Joint, Planar, Prismatic, Revolute, Screw, Spherical, Universal};
use mbody::model::{BodyIndex, Model, ModelBuilder};
use mbody::spatial::{MassProperties, Pose, Vec3};
use nalgebra::DMatrix;
use serde_json::Value;
use std::sync::Arc;
use validation::reference::{Table, json, numbers, repository_text, text};

/// Motion of a link frame in the world: position, rotation by rows, velocity of the origin, angular velocity.
pub struct Link {
    pub name: String,
    pub motion: Vec<f64>,
}

/// A recorded state. Arguments stand in the order of the model, results in the order of the record.
pub struct State {
    pub q: Vec<f64>,
    pub v: Vec<f64>,
    pub vd: Vec<f64>,
    pub tau_in: Vec<f64>,
    pub tau: Option<Vec<f64>>,
    pub vd_out: Vec<f64>,
    pub mass_matrix: Option<Vec<f64>>,
    pub kinetic: f64,
    pub potential: f64,
    pub center: Vec<f64>,
    pub links: Vec<Link>,
    pub derivatives: Option<(Vec<f64>, Vec<f64>)>,
}

/// A mechanism with its recorded states.
pub struct Mechanism {
    pub name: String,
    system: Arc<System>,
    /// For each recorded velocity, the independent velocity of the model.
    order: Vec<usize>,
    pub states: Vec<State>,
}

/// Joint and place within the joint of every recorded entry: entries of one joint follow each other.
fn owners(names: &Value) -> Vec<(String, usize)> {
    let names = names.as_array().expect("names").iter().map(|n| n.as_str().expect("a name"));
    let mut owners: Vec<(String, usize)> = Vec::new();
    for name in names {
        let joint = name.split('.').next().unwrap_or(name);
        let place = owners.last().filter(|(last, _)| last == joint).map_or(0, |(_, place)| place + 1);
        owners.push((joint.to_owned(), place));
    }
    owners
}

/// For each recorded entry, the independent coordinate or velocity of the model.
fn order(model: &Model, owners: &[(String, usize)], independent: &[usize], first: impl Fn(BodyIndex) -> usize) -> Vec<usize> {
    let place = |(joint, place): &(String, usize)| {
        // the free root speaks in the name of its link
        let body = model.joint(joint).unwrap_or_else(|| model.moving().next().expect("a body"));
        let tree = first(body) + place;
        independent.iter().position(|&i| i == tree).unwrap_or_else(|| panic!("`{joint}` is not independent"))
    };
    owners.iter().map(place).collect()
}

fn in_model_order(recorded: &[f64], order: &[usize]) -> Vec<f64> {
    let mut values = vec![0.0; recorded.len()];
    order.iter().zip(recorded).for_each(|(&i, &x)| values[i] = x);
    values
}

fn system_of(model: Model) -> Arc<System> {
    Arc::new(System::new(model, Vec::new()).expect("names are unique"))
}

/// Reads a URDF on a base.
fn read(file: &str, text: &str, base: BaseDescription) -> Arc<System> {
    let (assembled, findings) = assemble_urdf(file, text, base, 9.81, &[]);
    assembled.unwrap_or_else(|| panic!("{file}: {findings}")).system
}

/// Builds the mechanism from `links` and `joints` of the record, with one universal joint in place of `crossed`.
fn build(record: &Value, crossed: Option<[&str; 2]>) -> Arc<System> {
    let three = |value: &Value| -> [f64; 3] { numbers(value).try_into().expect("three numbers") };
    let mass = |link: &str| match &record["links"][link] {
        Value::Null => MassProperties::NONE,
        l => {
            let [xx, xy, xz, yy, yz, zz]: [f64; 6] = numbers(&l["inertia"]).try_into().expect("six entries");
            MassProperties { mass: l["mass"].as_f64().expect("a mass"), center: three(&l["com"]).into(), inertia: [xx, yy, zz, xy, xz, yz] }
        }
    };
    let mut builder = ModelBuilder::new();
    let joints = record["joints"].as_array().expect("joints");
    builder
        .weld(joints[0]["parent"].as_str().expect("a link"), BodyIndex::WORLD, Pose::identity(), MassProperties::NONE)
        .expect("the ground");
    for j in joints {
        let name = |key: &str| j[key].as_str().expect("a name");
        let X = Pose::from_xyz_rpy(three(&j["xyz"]), three(&j["rpy"]));
        let axis = || Vec3::from(three(&j["axis"])).normalized().expect("a direction");
        let mut child = name("child").to_owned();
        let law = match (crossed, name("type")) {
            (Some([first, _]), _) if name("name") == first => {
                // the driven link hangs on the universal joint itself
                let second = joints.iter().find(|k| k["name"] == crossed.expect("two").as_slice()[1]).expect("the second hinge");
                child = second["child"].as_str().expect("a link").to_owned();
                Joint::new(Universal)
            }
            (Some([_, second]), _) if name("name") == second => continue,
            (_, "revolute" | "continuous") => Joint::new(Revolute::new(axis())),
            (_, "prismatic") => Joint::new(Prismatic::new(axis())),
            (_, "screw") => Joint::new(Screw::new(axis(), j["pitch"].as_f64().expect("a pitch"))),
            (_, "spherical") => Joint::new(Spherical),
            (_, "planar") => Joint::new(Planar::new(axis())),
            (_, "floating") => Joint::new(Free),
            (_, other) => panic!("no joint of type {other}"),
        };
        let (parent, X_BP) = builder.find(name("parent")).expect("parents first");
        builder.body(&child, parent, name("name"), law, X_BP * X, mass(&child)).expect("a body");
    }
    system_of(builder.finish().expect("a tree"))
}

impl Mechanism {
    /// All recorded mechanisms.
    pub fn all() -> Vec<Self> {
        const NAMES: [&str; 11] = [
            "double_pendulum_3d",
            "prismatic_revolute_chain",
            "branched_tree",
            "welded_tree",
            "mimic_chain",
            "universal_joint",
            "planar_joint",
            "free_floating_tree",
            "spherical_joint",
            "screw_joint",
            "tree38",
        ];
        NAMES.into_iter().map(Self::named).chain([Self::moto11()]).collect()
    }

    /// A mechanism of `tests/reference/mechanisms`: from its URDF, where URDF knows its joints.
    pub fn named(name: &str) -> Self {
        let record = json(&format!("mechanisms/{name}.json"));
        let system = match record["urdf"].as_str() {
            None => build(&record, None),
            Some(urdf) => {
                let base = if urdf.ends_with("free root") { BaseDescription::Free } else { BaseDescription::Fixed };
                let file = urdf.split(' ').next().unwrap_or(urdf);
                let text = if file.contains('/') { repository_text(file) } else { text(&format!("mechanisms/{file}")) };
                read(file, &text, base)
            }
        };
        Self::recorded(name, system, &record)
    }

    /// The mechanism with two crossed hinges, built with a universal joint.
    pub fn with_universal_joint() -> Self {
        let mut record = json("mechanisms/universal_joint.json");
        let system = build(&record, Some(["about_x", "about_y"]));
        for names in ["q_names", "v_names"] {
            for name in record[names].as_array_mut().expect("names") {
                if name == "about_y" {
                    *name = "about_x.second".into();
                }
            }
        }
        Self::recorded("universal_joint", system, &record)
    }

    /// The benchmark motorcycle on a free base: arguments in `moto11.csv`, results in `moto11.json`.
    pub fn moto11() -> Self {
        let mut record = json("moto11/moto11.json");
        let mut names: Vec<String> = "x y z qx qy qz qw".split(' ').map(|c| format!("base.{c}")).collect();
        names.extend(joints_behind_the_base(&record["v_names"]));
        record["q_names"] = names.into();
        let table = Table::read("moto11/moto11.csv");
        for state in record["states"].as_array_mut().expect("states") {
            let row = table.numbers(state["row"].as_u64().expect("a row") as usize - 1);
            (state["q"], state["v"]) = (row[..12].into(), row[12..23].into());
            (state["a"], state["tau_rnea"]) = (row[23..34].into(), row[34..45].into());
        }
        let system = read("moto11_free.urdf", &text("moto11/moto11_free.urdf"), BaseDescription::Free);
        Self::recorded("moto11", system, &record)
    }

    fn recorded(name: &str, system: Arc<System>, record: &Value) -> Self {
        let model = system.model();
        let layout = model.layout();
        let of_q = order(model, &owners(&record["q_names"]), &layout.independent_q, |b| model.body(b).q.start);
        let of_v = order(model, &owners(&record["v_names"]), &layout.independent_v, |b| model.body(b).v.start);
        let states = record["states"].as_array().expect("states").iter().map(|s| {
            let list = |key: &str| numbers(&s[key]);
            let optional = |key: &str| s.get(key).map(numbers);
            State {
                q: in_model_order(&list("q"), &of_q),
                v: in_model_order(&list("v"), &of_v),
                vd: in_model_order(&list("a"), &of_v),
                tau_in: in_model_order(&list("tau_in"), &of_v),
                tau: optional("tau_rnea"),
                vd_out: list("a_aba"),
                mass_matrix: optional("mass_matrix"),
                kinetic: s["kinetic_energy"].as_f64().expect("an energy"),
                potential: s["potential_energy"].as_f64().expect("an energy"),
                center: list("com"),
                links: links(s),
                derivatives: optional("dtau_dq").zip(optional("dtau_dv")),
            }
        });
        Self { name: name.to_owned(), states: states.collect(), order: of_v, system: system.clone() }
    }

    /// The tree.
    pub fn model(&self) -> &Model {
        self.system.model()
    }

    /// Values of independent velocities in the order of the record.
    pub fn in_order(&self, values: &[f64]) -> Vec<f64> {
        self.order.iter().map(|&i| values[i]).collect()
    }

    /// A matrix over independent velocities, by rows, in the order of the record.
    pub fn square_in_order(&self, matrix: &DMatrix<f64>) -> Vec<f64> {
        self.order.iter().flat_map(|&i| self.order.iter().map(move |&k| (i, k))).map(|at| matrix[at]).collect()
    }
}

/// Names of the joints behind the six velocities of the base.
fn joints_behind_the_base(v_names: &Value) -> Vec<String> {
    v_names.as_array().expect("names").iter().skip(6).map(|n| n.as_str().expect("a name").to_owned()).collect()
}

fn links(state: &Value) -> Vec<Link> {
    let Some(links) = state.get("links").and_then(Value::as_object) else { return Vec::new() };
    let motion = |l: &Value| ["position", "rotation", "velocity", "angular_velocity"].iter().flat_map(|key| numbers(&l[*key])).collect();
    links.iter().map(|(name, l)| Link { name: name.clone(), motion: motion(l) }).collect()
}
