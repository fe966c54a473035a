//! From tree and elements to the residual `F(t, y, ẏ, u)`, and to the vocabulary of `problem`.

mod evaluation;
mod plant;
mod system;

pub use evaluation::{Account, Evaluation};
pub use plant::TreePlant;
pub use system::{Element, System, SystemError};
