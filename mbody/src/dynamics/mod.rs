//! From tree and elements to the residual `F(t, y, ẏ, u)`, and to the vocabulary of `problem`.

mod evaluation;
mod form;
mod plant;
mod system;

pub use evaluation::{Account, Evaluation};
pub use form::{Form, Formulation};
pub use plant::TreePlant;
pub use system::{Closed, Element, System, SystemError};
