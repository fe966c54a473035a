//! Everything with a name: unknowns, their rates, inputs and outputs of a plant.

use problem::{Plant, Signal};

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
    unknowns: Vec<Signal>,
    inputs: Vec<Signal>,
    outputs: Vec<Signal>,
}

impl Variables {
    /// Collects the names of a plant.
    pub fn of(plant: &dyn Plant) -> Self {
        let unknowns = plant.unknowns().iter().map(|u| u.signal.clone()).collect();
        let inputs = plant.inputs().iter().map(|i| i.signal.clone()).collect();
        Self { unknowns, inputs, outputs: plant.outputs().to_vec() }
    }

    /// The variable called `name`; the rate of an unknown is `rate(name)`.
    pub fn find(&self, name: &str) -> Option<Variable> {
        let among = |signals: &[Signal], name: &str| signals.iter().position(|s| s.name == name);
        if let Some(of) = name.strip_prefix("rate(").and_then(|rest| rest.strip_suffix(')')) {
            return among(&self.unknowns, of).map(Variable::Rate);
        }
        among(&self.outputs, name)
            .map(Variable::Output)
            .or_else(|| among(&self.inputs, name).map(Variable::Input))
            .or_else(|| among(&self.unknowns, name).map(Variable::Unknown))
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
        let all = self.unknowns.iter().chain(&self.inputs).chain(&self.outputs);
        let mut names: Vec<&str> = all.map(|s| s.name.as_str()).collect();
        names.sort_unstable();
        names
    }
}
