//! Everything with a name: unknowns, their rates, inputs and outputs of a plant.

use problem::{Plant, Signal};
use std::collections::HashMap;

/// One scalar of a plant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Variable {
    /// Entry of y.
    Unknown(usize),
    /// Entry of ẏ, written `rate(name)`.
    Rate(usize),
    /// Entry of u.
    Input(usize),
    /// Entry of z.
    Output(usize),
}

/// Unit of the rate of a quantity with this unit: `rad/s` becomes `rad/s²`.
pub(crate) fn rate_unit(unit: &str) -> String {
    match unit.strip_suffix("/s") {
        _ if unit == "-" => "1/s".to_owned(),
        Some(of) => format!("{of}/s²"),
        None => format!("{unit}/s"),
    }
}

/// The names of a plant.
#[derive(Clone, Debug)]
pub struct Variables {
    by_name: HashMap<String, Variable>,
    unknowns: Vec<Signal>,
    inputs: Vec<Signal>,
    outputs: Vec<Signal>,
}

impl Variables {
    /// Collects the names of a plant.
    pub fn of(plant: &dyn Plant) -> Self {
        let unknowns: Vec<Signal> = plant.unknowns().iter().map(|u| u.signal.clone()).collect();
        let inputs: Vec<Signal> = plant.inputs().iter().map(|i| i.signal.clone()).collect();
        let outputs = plant.outputs().to_vec();
        let mut by_name = HashMap::new();
        for (i, s) in unknowns.iter().enumerate() {
            by_name.insert(s.name.clone(), Variable::Unknown(i));
            by_name.insert(format!("rate({})", s.name), Variable::Rate(i));
        }
        by_name.extend(inputs.iter().enumerate().map(|(i, s)| (s.name.clone(), Variable::Input(i))));
        by_name.extend(outputs.iter().enumerate().map(|(i, s)| (s.name.clone(), Variable::Output(i))));
        Self { by_name, unknowns, inputs, outputs }
    }

    /// The variable called `name`; the rate of an unknown is `rate(name)`.
    pub fn find(&self, name: &str) -> Option<Variable> {
        self.by_name.get(name).copied()
    }

    /// The name of a variable.
    pub fn name(&self, variable: Variable) -> String {
        match variable {
            Variable::Unknown(i) => self.unknowns[i].name.clone(),
            Variable::Rate(i) => format!("rate({})", self.unknowns[i].name),
            Variable::Input(i) => self.inputs[i].name.clone(),
            Variable::Output(i) => self.outputs[i].name.clone(),
        }
    }

    /// The unit of a variable.
    pub fn unit(&self, variable: Variable) -> String {
        match variable {
            Variable::Unknown(i) => self.unknowns[i].unit.to_string(),
            Variable::Rate(i) => rate_unit(&self.unknowns[i].unit),
            Variable::Input(i) => self.inputs[i].unit.to_string(),
            Variable::Output(i) => self.outputs[i].unit.to_string(),
        }
    }

    /// Name, unit and meaning of a variable.
    pub fn signal(&self, variable: Variable) -> Signal {
        match variable {
            Variable::Unknown(i) => self.unknowns[i].clone(),
            Variable::Rate(i) => Signal::new(self.name(variable), self.unit(variable), format!("rate of: {}", self.unknowns[i].about)),
            Variable::Input(i) => self.inputs[i].clone(),
            Variable::Output(i) => self.outputs[i].clone(),
        }
    }

    /// Numbers of unknowns, inputs and outputs.
    pub fn counts(&self) -> (usize, usize, usize) {
        (self.unknowns.len(), self.inputs.len(), self.outputs.len())
    }

    /// All names, sorted, without rates.
    pub fn names(&self) -> Vec<&str> {
        let mut names: Vec<&str> = self.by_name.keys().map(String::as_str).filter(|n| !n.starts_with("rate(")).collect();
        names.sort_unstable();
        names
    }
}
